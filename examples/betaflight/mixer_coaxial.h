// SPDX-License-Identifier: MIT OR Apache-2.0
// The coaxial mixer in place of Betaflight's: see README.md. Nothing of it is compiled without USE_COAXIAL_MIXER.

#pragma once

#include <stdbool.h>

// Name of the airframe and SHA-256 of its file.
extern const char *const coaxialMixerAirframe;

// Sets or clears the flag that keeps the vehicle from arming, and names it for the OSD and `status`.
void coaxialMixerUpdateArming(void);

// Whether the battery's voltage is outside `range_v` of the airframe.
bool coaxialMixerIsBatteryOutside(void);

// The first motor that is out, from 1; 0 where all turn.
int coaxialMixerMotorOut(void);

// Puts out the motors: PID sums over 1000 in the signs of mixTable(), yaw after its own negation, and the throttle, 0 to 1.
void coaxialMixerApply(float roll, float pitch, float yaw, float throttle, bool isAirmode);
