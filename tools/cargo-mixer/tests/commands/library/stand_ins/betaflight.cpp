// Drives examples/betaflight: what it refuses, and that the motors get what the library mixes.

#include "betaflight.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

mixerRuntime_t mixerRuntime;
static pidProfile_t profile = { 100, 0, 0 };
pidProfile_t *currentPidProfile = &profile;
float motor[MAX_SUPPORTED_MOTORS];
float motor_disarmed[MAX_SUPPORTED_MOTORS];
uint8_t armingFlags;
bool useDshotTelemetry;
baro_t baro = { 101325 };

static mixerConfig_t mixer;
static motorConfig_t motors = { 1000 };
static batteryConfig_t battery = { 2 };
static uint16_t voltage = 1480;
static float rpm[MAX_SUPPORTED_MOTORS];
static int faults;

float pt1FilterGain(float frequency, float dt) { const float w = 6.2831853f * frequency * dt; return w / (w + 1.0f); }
float pt1FilterApply(pt1Filter_t *filter, float input) { return filter->state += filter->k * (input - filter->state); }
const mixerConfig_t *mixerConfig(void) { return &mixer; }
const motorConfig_t *motorConfig(void) { return &motors; }
const batteryConfig_t *batteryConfig(void) { return &battery; }
uint16_t getBatteryVoltageLatest(void) { return voltage; }
float pidGetDT(void) { return 0.01f; }
bool sensors(uint32_t mask) { return mask == SENSOR_BARO; }
bool isDshotMotorTelemetryActive(uint8_t) { return true; }
float getDshotRpm(uint8_t index) { return rpm[index]; }

static void check(bool holds, const char *what)
{
    if (!holds) {
        printf("fault: %s\n", what);
        faults++;
    }
}

static void refuses(const char *name)
{
    const char *refusal = coaxialMixerRefusal();
    check(name ? refusal && !strcmp(refusal, name) : !refusal, name ? name : refusal);
}

// Whether the motors are those of a setpoint, with motors out.
static bool mixes(mixer_wrench_t setpoint, uint64_t out)
{
    const mixer_conditions_t conditions = { 14.8f, 1.225f };
    isae_x8_mix_t mix;
    isae_x8_mix_in_with_health(&setpoint, &conditions, out, &mix);
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        const float wanted = mix.throttle[i] > 0.0f ? 1000.0f + 1000.0f * mix.throttle[i] : 1000.0f;
        if (fabsf(motor[i] - wanted) > 0.05f) {
            printf("motor %d: %f, not %f\n", i, motor[i], wanted);
            return false;
        }
    }
    return true;
}

int main()
{
    static const float factors[ISAE_X8_CHANNELS][3] = ISAE_X8_BETAFLIGHT_FACTORS;
    mixerRuntime.motorCount = ISAE_X8_CHANNELS;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        mixerRuntime.currentMixer[i] = { 1.0f, factors[i][0], factors[i][1], factors[i][2] };
        motor_disarmed[i] = 900.0f;
        rpm[i] = 5000.0f;
    }
    mixerRuntime.motorOutputLow = 1100.0f;
    mixerRuntime.motorOutputHigh = 2000.0f;
    mixerRuntime.disarmMotorOutput = 1000.0f;

    refuses(NULL);
    mixerRuntime.motorCount = 4;
    refuses("MIXER_FRAME");
    mixerRuntime.motorCount = ISAE_X8_CHANNELS;
    mixerRuntime.currentMixer[0].yaw *= -1.0f;
    refuses("MIXER_FRAME");
    mixerRuntime.currentMixer[0].yaw *= -1.0f;
    mixer.yaw_motors_reversed = true;
    refuses("MIXER_FRAME");
    mixer.yaw_motors_reversed = false;
    motors.motorIdle = 550;
    refuses("MOTOR_IDLE");
    motors.motorIdle = 1000;
    profile.motor_output_limit = 90;
    refuses("MOTOR_OUTPUT_LIMIT");
    profile = { 100, 20, 0 };
    refuses("THRUST_LINEAR");
    profile = { 100, 0, 100 };
    refuses("VBAT_SAG_COMP");
    profile = { 100, 0, 0 };
    mixerRuntime.dynIdleMinRps = 30.0f;
    refuses("DYN_IDLE");
    mixerRuntime.dynIdleMinRps = 0.0f;
    mixer.rpm_limit = true;
    refuses("RPM_LIMIT");
    mixer.rpm_limit = false;
    mixerRuntime.feature3dEnabled = true;
    refuses("3D");
    mixerRuntime.feature3dEnabled = false;
    voltage = 1100;
    refuses("VBAT_RANGE");
    voltage = 1480;
    refuses(NULL);

    const float roll = ISAE_X8_BETAFLIGHT_ROLL_NM, pitch = ISAE_X8_BETAFLIGHT_PITCH_NM, yaw = ISAE_X8_BETAFLIGHT_YAW_NM;
    const float e = ISAE_X8_BETAFLIGHT_THRUST_EXPO;
    const float half = (0.5f * (1.0f - e) + 0.25f * e) * ISAE_X8_BETAFLIGHT_THRUST_N;
    coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.0f, true);
    armingFlags = ARMED;
    // A profile that is chosen in flight.
    mixerRuntime.motorOutputLow = 1048.0f;
    mixerRuntime.motorOutputHigh = 1900.0f;
    check(coaxialMixerApply(0.05f, 0.04f, 0.1f, 0.5f, true) == 0.0f, "nothing is short");
    check(mixes({ 0.05f * roll, -0.04f * pitch, 0.1f * yaw, half }, 0), "a setpoint");
    mixer.yaw_motors_reversed = true;
    coaxialMixerApply(0.0f, 0.0f, -0.1f, 0.5f, true);
    check(mixes({ 0.0f, 0.0f, 0.1f * yaw, half }, 0), "motors reversed");
    mixer.yaw_motors_reversed = false;
    check(coaxialMixerApply(0.0f, 0.0f, 20.0f, 0.5f, true) == 1.0f, "yaw is short");
    coaxialMixerApply(0.5f, 0.0f, 0.0f, 0.0f, false);
    check(mixes({ 0.25f * roll, 0.0f, 0.0f, 0.0f }, 0), "half of the authority without airmode");
    const float before = motor[0];
    coaxialMixerApply(NAN, 0.0f, 0.0f, 0.9f, true);
    check(motor[0] == before, "a setpoint that is not finite holds the motors");

    voltage = 1200;
    for (int i = 0; i < 2000; i++) {
        coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
    }
    check(coaxialMixerIsVoltageClamped(), "a voltage outside the range is told");
    voltage = 1480;
    for (int i = 0; i < 2000; i++) {
        coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
    }
    check(!coaxialMixerIsVoltageClamped(), "and no longer");

    rpm[2] = 0.0f;
    for (int i = 0; i < 20; i++) {
        coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
    }
    check(mixes({ 0.0f, 0.0f, 0.0f, half }, 0), "without telemetry no motor stands");
    useDshotTelemetry = true;
    for (int i = 0; i < 20; i++) {
        coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
    }
    check(mixes({ 0.0f, 0.0f, 0.0f, half }, 4), "a motor that stands is out");

    armingFlags = 0;
    coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
    check(motor[0] == 900.0f, "disarmed");
    printf("%d faults\n", faults);
}
