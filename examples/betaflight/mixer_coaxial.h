// The coaxial mixer in place of Betaflight's: see README.md. Nothing of it is compiled without USE_COAXIAL_MIXER.

#pragma once

#include <stdbool.h>

// Why the vehicle must not arm, for `status`, the OSD and the configurator; NULL where it may.
const char *coaxialMixerRefusal(void);

// Whether the battery's voltage is outside `range_v` of the airframe.
bool coaxialMixerIsVoltageClamped(void);

// Puts out the motors of `count`: PID sums over 1000 in the signs of mixTable(), yaw after its own negation, and the throttle,
// 0 to 1. Returns what motorMixRange becomes: 1, which holds the integrals, where a torque is short, else 0.
float coaxialMixerApply(float roll, float pitch, float yaw, float throttle, bool isAirmode);
