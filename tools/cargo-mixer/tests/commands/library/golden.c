/* Golden vectors through the C interface. `rows.h` is written by the test: the airframes' headers, their rows, and
 * AIRFRAMES(X), which lists them. */
#include "golden.h"

#include <string.h>

#include "rows.h"

/* Mixes every row of an airframe, counts what differs and what it takes. */
#define GOLDEN(module, prefix)                                                       \
    static unsigned module##_golden(void)                                            \
    {                                                                                \
        struct counts counts = {0, 0, 0, 0};                                         \
        size_t i;                                                                    \
        for (i = 0; i < sizeof module##_rows / sizeof module##_rows[0]; ++i) {       \
            const size_t cells = sizeof module##_rows[0] / sizeof(uint32_t);         \
            const size_t inputs = cells - prefix##_CHANNELS - 5;                     \
            float in[6] = {0};                                                       \
            mixer_wrench_t setpoint;                                                 \
            mixer_conditions_t conditions;                                           \
            module##_mix_t out;                                                      \
            uint32_t start, instructions;                                            \
            int status;                                                              \
            memcpy(in, module##_rows[i], inputs * sizeof in[0]);                     \
            setpoint.roll_nm = in[0];                                                \
            setpoint.pitch_nm = in[1];                                               \
            setpoint.yaw_nm = in[2];                                                 \
            setpoint.thrust_n = in[3];                                               \
            conditions.voltage_v = in[4];                                            \
            conditions.density_kg_m3 = in[5];                                        \
            memset(&out, 0, sizeof out);                                             \
            start = board_ticks();                                                   \
            status = inputs > 5 ? module##_mix_in(&setpoint, &conditions, &out)      \
                                : module##_mix(&setpoint, in[4], &out);              \
            instructions = board_instructions(start, board_ticks());                 \
            counts.rows += 1;                                                        \
            counts.different += status != MIXER_OK                                   \
                                || memcmp(&out, &module##_rows[i][inputs], sizeof out);\
            counts.sum += instructions;                                              \
            counts.worst = instructions > counts.worst ? instructions : counts.worst;\
        }                                                                            \
        board_report(#module, &counts);                                              \
        return counts.different + module##_selftest();                               \
    }

AIRFRAMES(GOLDEN)

#define ADD(module, prefix) different += module##_golden();

int main(void)
{
    unsigned different = 0;
    board_start();
    AIRFRAMES(ADD)
    return different != 0;
}
