/* Single-precision arithmetic over 200,000 pairs of numbers, as one digest: on this machine, and with -DBOARD on a
 * Cortex-M whose compiler's run-time library computes it. */
#include <stdint.h>
#include <string.h>

#ifdef BOARD
#include "cortex_m.h"
#else
#include <stdio.h>
static int program(char *text);
#endif

enum { PAIRS = 200000, SPECIAL = 20 };

/* Magnitudes where rounding, underflow and overflow happen: zero, subnormal numbers, halves between neighbours, the
 * largest number, infinity, NaN. */
static const uint32_t special[SPECIAL] = {
    0u,          1u,          2u,          0x7fffffu,   0x800000u,   0x800001u,   0xffffffu,
    0x33000000u, 0x337fffffu, 0x33800000u, 0x33800001u, 0x3eaaaaabu, 0x3f7fffffu, 0x3f800000u,
    0x3f800001u, 0x4b7fffffu, 0x4b800000u, 0x7f7fffffu, 0x7f800000u, 0x7fc00000u,
};

static uint32_t random32(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static float number(uint32_t bits)
{
    union {
        uint32_t bits;
        float value;
    } as = {bits};
    return as.value;
}

static void word(uint32_t *digest, uint32_t value)
{
    *digest = (*digest ^ value) * 16777619u;
    *digest ^= *digest >> 15;
}

/* Which NaN it is, is left to the processor. */
static void result(uint32_t *digest, volatile float value)
{
    union {
        float value;
        uint32_t bits;
    } as;
    as.value = value;
    word(digest, as.value != as.value ? 0x7fc00000u : as.bits);
}

static void pair(uint32_t *digest, uint32_t bits_a, uint32_t bits_b)
{
    volatile float a = number(bits_a), b = number(bits_b);
    result(digest, a + b);
    result(digest, a - b);
    result(digest, a * b);
    result(digest, a / b);
    word(digest, (uint32_t)(a == b) | (uint32_t)(a < b) << 1 | (uint32_t)(a <= b) << 2
         | (uint32_t)(a > b) << 3 | (uint32_t)(a >= b) << 4);
    if (a > -2147483648.0f && a < 2147483648.0f)
        word(digest, (uint32_t)(int32_t)a);
    if (b >= 0.0f && b < 4294967296.0f)
        word(digest, (uint32_t)b);
    result(digest, (float)(int32_t)bits_a);
    result(digest, (float)bits_b);
}

static int program(char *text)
{
    uint32_t count = 0, state = 1u, digest = 2166136261u;
    for (uint32_t i = 0; i < 2 * SPECIAL; ++i)
        for (uint32_t k = 0; k < 2 * SPECIAL; ++k, ++count)
            pair(&digest, special[i / 2] | i << 31, special[k / 2] | k << 31);
    for (; count < PAIRS; ++count) {
        uint32_t a = random32(&state), b = random32(&state);
        /* Half of them of like size, where addition cancels. */
        if (count & 1u)
            b = (b & 0x81ffffffu) | (a & 0x7e000000u);
        pair(&digest, a, b);
    }
    strcpy(text, "200000 pairs: ########\n");
    for (int digit = 0; digit < 8; ++digit)
        text[15 + digit] = "0123456789abcdef"[digest >> (28 - 4 * digit) & 15u];
    return 0;
}

#ifndef BOARD
int main(void)
{
    char text[32];
    int failed = program(text);
    fputs(text, stdout);
    return failed;
}
#endif
