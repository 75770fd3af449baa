/* A Cortex-M without a floating-point unit in QEMU: start-up, and a text by semihosting. */
#include <stdint.h>

/* Writes the program's text, 32 bytes at most; whether it failed. It has no variables but its own: on some boards all
 * memory but the stack is flash. */
static int program(char *text);

extern uint32_t stack_top;
void reset(void);
static void fault(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[6])(void);
} vectors = {&stack_top, {reset, fault, fault, fault, fault, fault}};

static void semihosting(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void leave(const char *text, int failed)
{
    semihosting(0x04, text);
    /* ADP_Stopped_ApplicationExit, or ADP_Stopped_RunTimeErrorUnknown. */
    semihosting(0x18, (const void *)(failed ? 0x20023u : 0x20026u));
    for (;;) {
    }
}

static void fault(void)
{
    leave("fault\n", 1);
}

void reset(void)
{
    char text[32];
    int failed = program(text);
    leave(text, failed);
}
