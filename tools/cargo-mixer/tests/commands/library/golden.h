/* What the golden program needs of the machine it runs on. */
#ifndef GOLDEN_H
#define GOLDEN_H

#include <stdint.h>

struct counts {
    uint32_t rows;
    uint32_t different;
    uint32_t sum;   /* instructions of all rows */
    uint32_t worst; /* instructions of the dearest row */
};

void board_start(void);
uint32_t board_ticks(void);
/* Instructions between two readings, the readings left out; 0 where they cannot be counted. */
uint32_t board_instructions(uint32_t start, uint32_t end);
/* Prints a line: name, rows, different, sum, worst. */
void board_report(const char *name, const struct counts *counts);

#endif
