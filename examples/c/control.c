#include "control.h"

#include <math.h>

/* Gains of normalised setpoints, as a flight stack has them: the scales in isae_x8.h make N m of them. */
static const float PROPORTIONAL[3] = {0.15f, 0.15f, 0.2f};
static const float INTEGRAL_PER_S[3] = {0.2f, 0.2f, 0.1f};

/* Cycles without a mix after which the rotors stop: 100 ms. */
static const unsigned MOST_REFUSED = 40;

static const uint32_t SHORT[3] = {MIXER_ROLL_SHORT, MIXER_PITCH_SHORT, MIXER_YAW_SHORT};
static const uint32_t OVER[3] = {MIXER_ROLL_OVER, MIXER_PITCH_OVER, MIXER_YAW_OVER};

static void set_all(control_t *control, float throttle)
{
    for (int channel = 0; channel < ISAE_X8_CHANNELS; ++channel)
        control->throttle[channel] = throttle;
}

void control_start(control_t *control, float battery_v)
{
    *control = (control_t){.battery_v = battery_v};
}

void control_arm(control_t *control)
{
    control->armed = true;
    control->refused = 0;
    set_all(control, ISAE_X8_THROTTLE_MIN);
}

/* PI torque about one axis. The integral stops where the mixer could not follow it. */
static float torque(control_t *control, const control_input_t *input, int axis)
{
    float error = input->rate_setpoint_rad_s[axis] - input->rate_rad_s[axis];
    bool saturated = (error > 0.0f && (control->saturation & SHORT[axis]) != 0u)
                     || (error < 0.0f && (control->saturation & OVER[axis]) != 0u);
    if (!saturated && isfinite(error))
        control->integral[axis] += INTEGRAL_PER_S[axis] * error * CONTROL_PERIOD_S;
    return PROPORTIONAL[axis] * error + control->integral[axis];
}

void control_step(control_t *control, const control_input_t *input)
{
    if (!control->armed)
        return;
    /* A voltage that was not measured is the last one that was. */
    if (isfinite(input->battery_v))
        control->battery_v = input->battery_v;

    const mixer_wrench_t setpoint = {
        .roll_nm = torque(control, input, 0) * ISAE_X8_ROLL_NM,
        .pitch_nm = torque(control, input, 1) * ISAE_X8_PITCH_NM,
        .yaw_nm = torque(control, input, 2) * ISAE_X8_YAW_NM,
        .thrust_n = input->thrust * ISAE_X8_THRUST_N,
    };
    isae_x8_mix_t mix;
    if (isae_x8_mix(&setpoint, control->battery_v, &mix) == MIXER_OK) {
        control->refused = 0;
        control->achieved = mix.achieved;
        control->saturation = mix.saturation;
        for (int channel = 0; channel < ISAE_X8_CHANNELS; ++channel)
            control->throttle[channel] = mix.throttle[channel];
    } else if (++control->refused > MOST_REFUSED) {
        /* The throttles were held; now they stop. */
        control->armed = false;
        set_all(control, 0.0f);
    }
}
