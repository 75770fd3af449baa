/* A rate loop in front of the mixer: what flies, without a board. */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdbool.h>

#include "isae_x8.h"

/* One cycle's measurements and requests, FRD, SI units. */
typedef struct {
    float rate_rad_s[3];          /* roll, pitch, yaw */
    float rate_setpoint_rad_s[3]; /* the same, wanted */
    float thrust;                 /* of the pilot or of the height controller, 0 to 1 */
    float battery_v;
} control_input_t;

typedef struct {
    float integral[3];               /* of the rates' errors, normalised torque */
    float battery_v;                 /* the last good measurement */
    unsigned refused;                /* cycles in a row that were not mixed */
    bool armed;
    mixer_wrench_t achieved;         /* by the last mix */
    uint32_t saturation;             /* of the last mix */
    float throttle[ISAE_X8_CHANNELS];
} control_t;

/* Disarmed, with the battery's voltage as it is expected to be. */
void control_start(control_t *control, float battery_v);

/* Idles, ready to fly. */
void control_arm(control_t *control);

/* One cycle of CONTROL_PERIOD_S. The throttles to send are in `control->throttle`: 0 where it is disarmed. */
void control_step(control_t *control, const control_input_t *input);

#define CONTROL_PERIOD_S 0.0025f

#endif
