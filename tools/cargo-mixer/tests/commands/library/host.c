/* The host: nothing is counted. */
#include "golden.h"

#include <stdio.h>

void board_start(void) {}

uint32_t board_ticks(void)
{
    return 0;
}

uint32_t board_instructions(uint32_t start, uint32_t end)
{
    return end - start;
}

void board_report(const char *name, const struct counts *counts)
{
    printf("%s %u %u %u %u\n", name, (unsigned)counts->rows, (unsigned)counts->different, (unsigned)counts->sum,
           (unsigned)counts->worst);
}
