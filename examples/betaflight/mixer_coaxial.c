// SPDX-License-Identifier: MIT OR Apache-2.0
// The coaxial mixer in place of Betaflight's: see README.md.

#include "platform.h"

#ifdef USE_COAXIAL_MIXER

#include <math.h>
#include <stddef.h>

#include "build/version.h"
#include "common/filter.h"
#include "common/maths.h"
#include "common/utils.h"
#include "config/config.h"
#include "drivers/dshot.h"
#include "drivers/motor.h"
#include "fc/rc_modes.h"
#include "fc/runtime_config.h"
#include "flight/mixer.h"
#include "flight/mixer_init.h"
#include "flight/pid.h"
#include "pg/motor.h"
#include "sensors/barometer.h"
#include "sensors/battery.h"
#include "sensors/sensors.h"

#include "flight/isae_x8.h"
#include "flight/mixer_coaxial.h"

STATIC_ASSERT(ISAE_X8_CHANNELS <= MAX_SUPPORTED_MOTORS, more_rotors_than_Betaflight_has_motors);

// Least cosine of the motors' factors and the airframe's, per axis: one wrong sign of eight has 0.75, a centre of gravity that is
// off by a third of the arm 0.95.
#define SAME_FRAME 0.9f
// What they may differ by in size: the loop gain of the axis differs by as much.
#define SAME_SIZE 0.25f
// What a full pack may be above range_v by a sensor that is a little off.
#define SAME_VOLTAGE 1.01f
// Calls between two looks at the barometer: its power function takes longer than all else here.
#define DENSITY_EVERY 400
// Time without a turn after which a motor that has turned is out, s; most motors that are believed to be: telemetry that fails
// for all of them looks the same.
#define OUT_AFTER_S 0.1f
#define MOST_OUT 2
// Longest time for which a setpoint that is not finite leaves the motors as they are, s.
#define HOLD_S 0.1f

#ifndef FC_VERSION_YEAR // 4.5
#define BOXCRASHFLIP BOXFLIPOVERAFTERCRASH
#endif

static mixer_conditions_t conditions = { ISAE_X8_REFERENCE_V, ISAE_X8_REFERENCE_DENSITY_KG_M3 };
static uint32_t motorsOut;

const char *const coaxialMixerAirframe = ISAE_X8_AIRFRAME " " ISAE_X8_SHA256;

// Whether one axis' factors of all motors are the airframe's.
static bool isSame(const size_t axis, const float *factors)
{
    static const float own[ISAE_X8_CHANNELS][3] = ISAE_X8_BETAFLIGHT_FACTORS;
    float product = 0.0f, a = 0.0f, b = 0.0f;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        product += factors[i] * own[i][axis];
        a += sq(factors[i]);
        b += sq(own[i][axis]);
    }
    // An axis that neither has is the same.
    return product >= SAME_FRAME * sqrtf(a * b) && fabsf(product - b) <= SAME_SIZE * b && (b > 0.0f || a <= 0.0f);
}

// Whether `mixer` or `mmix` is the airframe's frame, with its motors in its order.
static bool isFrame(void)
{
    if (mixerRuntime.motorCount != ISAE_X8_CHANNELS) {
        return false;
    }
    float factors[3][ISAE_X8_CHANNELS];
    const float yawSign = mixerConfig()->yaw_motors_reversed ? -1.0f : 1.0f;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        const motorMixer_t *motorFactors = &mixerRuntime.currentMixer[i];
        factors[0][i] = motorFactors->roll;
        factors[1][i] = motorFactors->pitch;
        factors[2][i] = motorFactors->yaw * yawSign;
    }
    return isSame(0, factors[0]) && isSame(1, factors[1]) && isSame(2, factors[2]);
}

static bool isOutside(const float voltage)
{
    return ISAE_X8_MAX_V > 0.0f && (voltage * SAME_VOLTAGE < ISAE_X8_MIN_V || voltage > ISAE_X8_MAX_V * SAME_VOLTAGE);
}

// At most 12 characters, for the OSD.
static const char *refusal(void)
{
    if (!isFrame()) {
        return "MIXER_FRAME";
    }
    if (currentPidProfile->motor_output_limit < 100) {
        return "OUTPUT_LIMIT";
    }
    // Corrections of the motors' curve and of the battery that the mixer has itself.
    if (currentPidProfile->thrustLinearization > 0) {
        return "THRUST_LIN";
    }
    if (currentPidProfile->vbat_sag_compensation > 0) {
        return "VBAT_SAG";
    }
#ifdef USE_DYN_IDLE
    if (mixerRuntime.dynIdleMinRps > 0.0f) {
        return "DYN_IDLE";
    }
#endif
    if (RPM_LIMIT_ACTIVE) {
        return "RPM_LIMIT";
    }
    if (mixerRuntime.feature3dEnabled) {
        return "3D";
    }
#if !defined(SIMULATOR_BUILD) // has no battery
    // Who has flown takes off again with a worn pack; crash flip is not mixed here.
    const bool isFirst = !ARMING_FLAG(WAS_EVER_ARMED) && !IS_RC_MODE_ACTIVE(BOXCRASHFLIP);
    if (isFirst && isOutside(0.01f * getBatteryVoltageLatest())) {
        return "VBAT_RANGE";
    }
#endif
    return NULL;
}

void coaxialMixerUpdateArming(void)
{
    const int flag = ARMING_DISABLED_COAXIAL_MIXER;
    const char *name = refusal();
    if (name) {
        armingDisableFlagNames[LOG2(flag)] = name;
        setArmingDisabled(flag);
    } else {
        unsetArmingDisabled(flag);
    }
}

bool coaxialMixerIsBatteryOutside(void)
{
    return isOutside(conditions.voltage_v);
}

int coaxialMixerMotorOut(void)
{
    return __builtin_ffs(motorsOut);
}

// Each is the last one where it is not measured.
static void updateConditions(void)
{
    static pt1Filter_t filter;
    const float voltage = 0.01f * getBatteryVoltageLatest();
    if (voltage > 0.0f) {
        // As vbat_sag_compensation has it, from the first one on.
        if (filter.k <= 0.0f) {
            pt1FilterInit(&filter, pt1FilterGain(GET_BATTERY_LPF_FREQUENCY(batteryConfig()->vbatSagLpfPeriod), pidGetDT()));
            filter.state = voltage;
        }
        conditions.voltage_v = pt1FilterApply(&filter, voltage);
    }
#ifdef USE_BARO
    // Of the standard atmosphere at this pressure: the barometer's temperature is the board's.
    static unsigned calls;
    if (calls++ % DENSITY_EVERY == 0 && sensors(SENSOR_BARO) && baro.pressure > 0) {
        conditions.density_kg_m3 = 1.225f * powf(baro.pressure / 101325.0f, 0.80974f);
    }
#endif
}

#if defined(COAXIAL_MIXER_HEALTH) && defined(USE_DSHOT_TELEMETRY)
// Motors that stand though they are driven and have turned since they were, a bit each. Where telemetry is lost, Betaflight keeps
// the last speed; where there is none, 0.
static uint32_t standingMotors(void)
{
    static bool hasTurned[ISAE_X8_CHANNELS];
    static float stands[ISAE_X8_CHANNELS];
    uint32_t standing = 0;
    int count = 0;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        const bool turns = getDshotRpm(i) > 0.0f;
        hasTurned[i] = motor[i] > mixerRuntime.disarmMotorOutput && (turns || hasTurned[i]);
        stands[i] = turns || !hasTurned[i] ? 0.0f : stands[i] + pidGetDT();
        if (stands[i] > OUT_AFTER_S) {
            standing |= 1U << i;
            count++;
        }
    }
    return count > MOST_OUT ? 0 : standing;
}
#endif

// Share of the full thrust.
static float thrustOfStick(const float stick)
{
    const float expo = ISAE_X8_BETAFLIGHT_THRUST_EXPO;
    return expo <= 1.0f ? ((1.0f - expo) + expo * stick) * stick : ((2.0f - expo) + (expo - 1.0f) * stick) * stick * stick;
}

// The throttles that go out: where the airframe file has the rotors' lag, those of rotors that are under way.
static int mixInFlight(const mixer_wrench_t *setpoint, isae_x8_mix_t *mix)
{
#ifdef ISAE_X8_ROTOR_LAG_S
    // At rest until the vehicle is armed.
    static const isae_x8_state_t rest = { { 0.0f } };
    static isae_x8_state_t rotors;
    if (!ARMING_FLAG(ARMED)) {
        rotors = rest;
    }
#endif
#if defined(COAXIAL_MIXER_HEALTH) && defined(USE_DSHOT_TELEMETRY)
    motorsOut = standingMotors();
#ifdef ISAE_X8_ROTOR_LAG_S
    return isae_x8_mix_dynamic_with_health(&rotors, setpoint, &conditions, motorsOut, pidGetDT(), mix);
#else
    return isae_x8_mix_in_with_health(setpoint, &conditions, motorsOut, mix);
#endif
#elif defined(ISAE_X8_ROTOR_LAG_S)
    return isae_x8_mix_dynamic(&rotors, setpoint, &conditions, pidGetDT(), mix);
#else
    return isae_x8_mix_in(setpoint, &conditions, mix);
#endif
}

void coaxialMixerApply(float roll, float pitch, float yaw, float throttle, bool isAirmode)
{
    // Throttle 0 and 1 of the airframe as DShot or in microseconds. They hold for a flight: a profile that is chosen in it may have
    // another limit.
    static float zero, range, held;
    if (!ARMING_FLAG(ARMED)) {
        zero = isMotorProtocolDshot() ? DSHOT_MIN_THROTTLE : mixerRuntime.disarmMotorOutput;
        range = mixerRuntime.motorOutputHigh - zero;
    }
    updateConditions();
    // Without airmode Betaflight leaves half of the authority at throttle 0, all of it from half throttle on.
    const float authority = isAirmode ? 1.0f : MIN(0.5f + throttle, 1.0f);
    // Clockwise seen from above, whichever way the motors turn. Betaflight's pitch is positive nose down.
    const float clockwise = mixerConfig()->yaw_motors_reversed ? -yaw : yaw;
    const mixer_wrench_t setpoint = {
        authority * roll * ISAE_X8_BETAFLIGHT_ROLL_NM,
        -authority * pitch * ISAE_X8_BETAFLIGHT_PITCH_NM,
        authority * clockwise * ISAE_X8_BETAFLIGHT_YAW_NM,
        thrustOfStick(throttle) * ISAE_X8_BETAFLIGHT_THRUST_N,
    };
    isae_x8_mix_t mix;
    const int status = mixInFlight(&setpoint, &mix);
    if (status == MIXER_OK) {
        held = 0.0f;
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            // A motor that is out idles, so that it can come back.
            motor[i] = zero + MAX(mix.throttle[i], ISAE_X8_THROTTLE_MIN) * range;
        }
    } else if ((held += pidGetDT()) > HOLD_S) {
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            motor[i] = mixerRuntime.disarmMotorOutput;
        }
    }
    if (!ARMING_FLAG(ARMED)) {
        for (int i = 0; i < mixerRuntime.motorCount; i++) {
            motor[i] = motor_disarmed[i];
        }
    }
}

#endif // USE_COAXIAL_MIXER
