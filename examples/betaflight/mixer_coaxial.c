// The coaxial mixer in place of Betaflight's: see README.md.

#include "platform.h"

#ifdef USE_COAXIAL_MIXER

#include <math.h>
#include <stddef.h>

#include "common/filter.h"
#include "common/maths.h"
#include "config/config.h"
#include "drivers/dshot.h"
#include "drivers/motor.h"
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

// Idle is the airframe's to this share of the throttle; motor_idle has steps of 0.0001.
#define SAME_IDLE 0.002f
// Least cosine of the motors' factors and the airframe's, per axis: one wrong sign of eight has 0.75, a centre of gravity that is
// off by a third of the arm 0.95.
#define SAME_FRAME 0.9f
// What a full pack may be above range_v by a sensor that is a little off.
#define SAME_VOLTAGE 1.01f
// Calls between two looks at the barometer: its power function takes longer than all else here.
#define DENSITY_EVERY 400
// Time without a turn after which a driven motor is out, s. Telemetry that is lost is no motor that stands.
#define OUT_AFTER_S 0.1f

static mixer_conditions_t conditions = { ISAE_X8_REFERENCE_V, ISAE_X8_REFERENCE_DENSITY_KG_M3 };
static pt1Filter_t voltageFilter;
static uint32_t saturation;

// Cosine of one axis' factors of all motors and those of the airframe.
static float likeness(const size_t axis, const float *factors)
{
    static const float own[ISAE_X8_CHANNELS][3] = ISAE_X8_BETAFLIGHT_FACTORS;
    float product = 0.0f, a = 0.0f, b = 0.0f;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        product += factors[i] * own[i][axis];
        a += sq(factors[i]);
        b += sq(own[i][axis]);
    }
    // An axis that neither has is the same.
    return a * b > 0.0f ? product / sqrtf(a * b) : a == b;
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
    for (size_t axis = 0; axis < 3; axis++) {
        if (likeness(axis, factors[axis]) < SAME_FRAME) {
            return false;
        }
    }
    return true;
}

const char *coaxialMixerRefusal(void)
{
    if (!isFrame()) {
        return "MIXER_FRAME";
    }
    if (fabsf(motorConfig()->motorIdle * 0.0001f - ISAE_X8_THROTTLE_MIN) > SAME_IDLE) {
        return "MOTOR_IDLE";
    }
    if (currentPidProfile->motor_output_limit < 100) {
        return "MOTOR_OUTPUT_LIMIT";
    }
    // Corrections of the motors' curve and of the battery that the mixer has itself.
    if (currentPidProfile->thrustLinearization > 0) {
        return "THRUST_LINEAR";
    }
    if (currentPidProfile->vbat_sag_compensation > 0) {
        return "VBAT_SAG_COMP";
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
    const float voltage = 0.01f * getBatteryVoltageLatest();
    if (ISAE_X8_MAX_V > 0.0f && (voltage * SAME_VOLTAGE < ISAE_X8_MIN_V || voltage > ISAE_X8_MAX_V * SAME_VOLTAGE)) {
        return "VBAT_RANGE";
    }
#endif
    return NULL;
}

bool coaxialMixerIsVoltageClamped(void)
{
    return saturation & MIXER_VOLTAGE_CLAMPED;
}

// Each is the last one where it is not measured.
static void updateConditions(void)
{
    const float voltage = 0.01f * getBatteryVoltageLatest();
    if (voltage > 0.0f) {
        // As vbat_sag_compensation has it.
        if (voltageFilter.state <= 0.0f) {
            voltageFilter.state = voltage;
        }
        voltageFilter.k = pt1FilterGain(GET_BATTERY_LPF_FREQUENCY(batteryConfig()->vbatSagLpfPeriod), pidGetDT());
        conditions.voltage_v = pt1FilterApply(&voltageFilter, voltage);
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
// Motors that stand though they are driven, a bit each.
static uint64_t stoppedMotors(void)
{
    static float stands[ISAE_X8_CHANNELS];
    uint64_t stopped = 0;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        const bool isStanding = useDshotTelemetry && ARMING_FLAG(ARMED) && isDshotMotorTelemetryActive(i) && getDshotRpm(i) <= 0.0f;
        stands[i] = isStanding ? stands[i] + pidGetDT() : 0.0f;
        if (stands[i] > OUT_AFTER_S) {
            stopped |= 1ULL << i;
        }
    }
    return stopped;
}
#endif

float coaxialMixerApply(float roll, float pitch, float yaw, float throttle, bool isAirmode)
{
    // What the mixer's least throttle, which is motor_idle, and throttle 1 are as DShot or in microseconds. They hold for a flight: a
    // profile that is chosen in it may have another limit.
    static float low, high;
    if (!ARMING_FLAG(ARMED)) {
        low = mixerRuntime.motorOutputLow;
        high = mixerRuntime.motorOutputHigh;
    }
    updateConditions();
    // Without airmode Betaflight leaves half of the authority at throttle 0, all of it from half throttle on.
    const float authority = isAirmode ? 1.0f : MIN(0.5f + throttle, 1.0f);
    // Clockwise seen from above, whichever way the motors turn. Betaflight's pitch is positive nose down.
    const float clockwise = mixerConfig()->yaw_motors_reversed ? -yaw : yaw;
    const float expo = ISAE_X8_BETAFLIGHT_THRUST_EXPO;
    const mixer_wrench_t setpoint = {
        authority * roll * ISAE_X8_BETAFLIGHT_ROLL_NM,
        -authority * pitch * ISAE_X8_BETAFLIGHT_PITCH_NM,
        authority * clockwise * ISAE_X8_BETAFLIGHT_YAW_NM,
        ((1.0f - expo) + expo * throttle) * throttle * ISAE_X8_BETAFLIGHT_THRUST_N,
    };
    isae_x8_mix_t mix;
#if defined(COAXIAL_MIXER_HEALTH) && defined(USE_DSHOT_TELEMETRY)
    const int status = isae_x8_mix_in_with_health(&setpoint, &conditions, stoppedMotors(), &mix);
#else
    const int status = isae_x8_mix_in(&setpoint, &conditions, &mix);
#endif
    // A setpoint that is not finite leaves the motors as they are.
    if (status == MIXER_OK) {
        const float perThrottle = (high - low) / (1.0f - ISAE_X8_THROTTLE_MIN);
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            const float driven = low + (mix.throttle[i] - ISAE_X8_THROTTLE_MIN) * perThrottle;
            motor[i] = mix.throttle[i] > 0.0f ? driven : mixerRuntime.disarmMotorOutput;
        }
        saturation = mix.saturation;
    }
    if (!ARMING_FLAG(ARMED)) {
        for (int i = 0; i < mixerRuntime.motorCount; i++) {
            motor[i] = motor_disarmed[i];
        }
    }
    return saturation & (MIXER_ROLL_SHORT | MIXER_PITCH_SHORT | MIXER_YAW_SHORT) ? 1.0f : 0.0f;
}

#endif // USE_COAXIAL_MIXER
