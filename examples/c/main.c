/* The loop on a bench: four seconds of a yaw step beyond what the rotors can give, a lost measurement, and its end. */
#include <math.h>
#include <stdio.h>

#include "control.h"

#define MASS_KG 3.2f
#define YAW_INERTIA_KG_M2 0.12f
#define HOVER (MASS_KG * 9.80665f / ISAE_X8_THRUST_N)

int main(void)
{
    control_t control;
    control_input_t input = {.thrust = HOVER, .battery_v = 14.8f};
    unsigned saturated = 0, held = 0, disarmed = 0;
    float most = 0.0f, rate = 0.0f;

    control_start(&control, 14.8f);
    control_arm(&control);
    for (int cycle = 0; cycle < 1600; ++cycle) {
        bool lost = (cycle >= 800 && cycle < 803) || cycle >= 1500;
        input.rate_setpoint_rad_s[2] = cycle < 40 ? 0.0f : 4.0f;
        input.rate_rad_s[2] = lost ? NAN : rate;
        input.battery_v = cycle % 10 == 0 ? 14.8f - 0.0005f * (float)cycle : NAN;
        control_step(&control, &input);
        /* The plant is the mixer's own model: what it says that the throttles achieve. */
        if (control.armed)
            rate += control.achieved.yaw_nm / YAW_INERTIA_KG_M2 * CONTROL_PERIOD_S;
        saturated += (control.saturation & MIXER_YAW_SHORT) != 0u;
        held += control.armed && control.refused > 0u;
        disarmed += !control.armed;
        most = fmaxf(most, rate);
    }
    printf("yaw %.2f rad/s of 4, at most %.2f; saturated %u, held %u, disarmed %u cycles\n", (double)rate, (double)most,
           saturated, held, disarmed);
    return !(fabsf(rate - 4.0f) < 0.2f && most < 4.8f && held == 43 && disarmed == 60);
}
