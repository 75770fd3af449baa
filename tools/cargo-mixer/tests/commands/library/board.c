/* A Cortex-M4F in QEMU (mps2-an386): start-up, output by semihosting, instructions by timer 0.
 *
 * With `-icount shift=10` an instruction takes 1024 ns of virtual time and the timer ticks every 40 ns; see
 * tests/firmware/src/probe/instructions.rs. */
#include "golden.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER 0x40000000u

extern uint32_t stack_top;
int main(void);
void reset(void);
static void fault(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    void (*handlers[6])(void);
} vectors = {&stack_top, {reset, fault, fault, fault, fault, fault}};

static uint32_t overhead;

static int semihosting(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void leave(int failed)
{
    /* ADP_Stopped_ApplicationExit, or ADP_Stopped_RunTimeErrorUnknown. */
    semihosting(0x18, (const void *)(failed ? 0x20023u : 0x20026u));
    for (;;) {
    }
}

static void fault(void)
{
    semihosting(0x04, "fault\n");
    leave(1);
}

void reset(void)
{
    /* The floating-point unit: full access to coprocessors 10 and 11. */
    REGISTER(0xe000ed88u) |= 0xfu << 20;
    __asm__ volatile("dsb\n isb");
    leave(main());
}

void board_start(void)
{
    uint32_t start;
    REGISTER(TIMER + 8) = 0xffffffffu;
    REGISTER(TIMER + 4) = 0xffffffffu;
    REGISTER(TIMER) = 1;
    start = board_ticks();
    overhead = 0;
    overhead = board_instructions(start, board_ticks());
}

uint32_t board_ticks(void)
{
    return REGISTER(TIMER + 4);
}

uint32_t board_instructions(uint32_t start, uint32_t end)
{
    return (uint32_t)(((uint64_t)(start - end) * 40u + 512u) / 1024u) - overhead;
}

/* Writes a number and what follows it. */
static void number(uint32_t value, char after)
{
    char text[12];
    char *digit = text + sizeof text - 2;
    digit[0] = after;
    digit[1] = 0;
    do {
        *--digit = (char)('0' + value % 10u);
        value /= 10u;
    } while (value != 0u);
    semihosting(0x04, digit);
}

void board_report(const char *name, const struct counts *counts)
{
    semihosting(0x04, name);
    semihosting(0x04, " ");
    number(counts->rows, ' ');
    number(counts->different, ' ');
    number(counts->sum, ' ');
    number(counts->worst, '\n');
}
