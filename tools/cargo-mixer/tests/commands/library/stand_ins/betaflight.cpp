// Drives examples/betaflight: what it refuses, that the motors get what the library mixes, and motors that start, stop and report
// wrongly.

#include "betaflight.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <initializer_list>

mixerRuntime_t mixerRuntime;
static pidProfile_t profile = { 100, 0, 0 };
pidProfile_t *currentPidProfile = &profile;
float motor[MAX_SUPPORTED_MOTORS];
float motor_disarmed[MAX_SUPPORTED_MOTORS];
uint8_t armingFlags;
const char *armingDisableFlagNames[32];
baro_t baro = { 101325 };

static mixerConfig_t mixer;
static batteryConfig_t battery = { 2 };
static uint16_t voltage = 1480;
static uint32_t disabled;
static bool isFlipping;
static float rpm[MAX_SUPPORTED_MOTORS];
static int faults;

static const float DT = 0.001f;
float pt1FilterGain(float frequency, float dt) { const float w = 6.2831853f * frequency * dt; return w / (w + 1.0f); }
void pt1FilterInit(pt1Filter_t *filter, float k) { *filter = { 0.0f, k }; }
float pt1FilterApply(pt1Filter_t *filter, float input) { return filter->state += filter->k * (input - filter->state); }
const mixerConfig_t *mixerConfig(void) { return &mixer; }
const batteryConfig_t *batteryConfig(void) { return &battery; }
uint16_t getBatteryVoltageLatest(void) { return voltage; }
float pidGetDT(void) { return DT; }
bool sensors(uint32_t mask) { return mask == SENSOR_BARO; }
bool isMotorProtocolDshot(void) { return true; }
bool IS_RC_MODE_ACTIVE(int box) { return box == BOXCRASHFLIP && isFlipping; }
void setArmingDisabled(uint32_t flag) { disabled |= flag; }
void unsetArmingDisabled(uint32_t flag) { disabled &= ~flag; }
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
    coaxialMixerUpdateArming();
    const char *refusal = disabled ? armingDisableFlagNames[29] : NULL;
    check(name ? refusal && !strcmp(refusal, name) && strlen(name) <= 12 : !refusal, name ? name : refusal);
}

// Whether the motors are those of a setpoint, with motors out.
static bool mixes(mixer_wrench_t setpoint, uint64_t out)
{
    const mixer_conditions_t conditions = { 14.8f, 1.225f };
    isae_x8_mix_t mix;
    isae_x8_mix_in_with_health(&setpoint, &conditions, out, &mix);
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        const float wanted = 48.0f + 1999.0f * MAX(mix.throttle[i], ISAE_X8_THROTTLE_MIN);
        if (fabsf(motor[i] - wanted) > 0.1f) {
            printf("motor %d: %f, not %f\n", i, motor[i], wanted);
            return false;
        }
    }
    return true;
}

static mixer_wrench_t level(float throttle)
{
    const float e = ISAE_X8_BETAFLIGHT_THRUST_EXPO;
    const float share = e <= 1.0f ? (1.0f - e) * throttle + e * throttle * throttle
                                  : (2.0f - e) * throttle * throttle + (e - 1.0f) * throttle * throttle * throttle;
    return { 0.0f, 0.0f, 0.0f, share * ISAE_X8_BETAFLIGHT_THRUST_N };
}

// Motors that turn once they have been driven for a time, as their telemetry has it, s; what it shows of one may be wrong.
static float driven[MAX_SUPPORTED_MOTORS];
static void fly(float seconds, float throttle, float spinUp, int wrong = -1, float shown = 0.0f)
{
    for (int step = 0; step < lrintf(seconds / DT); step++) {
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            driven[i] = motor[i] > mixerRuntime.disarmMotorOutput ? driven[i] + DT : 0.0f;
            rpm[i] = i == wrong ? shown : driven[i] > spinUp ? 5000.0f : 0.0f;
        }
        coaxialMixerApply(0.0f, 0.0f, 0.0f, throttle, true);
    }
}

static void arm(bool isArmed)
{
    armingFlags = isArmed ? ARMED | WAS_EVER_ARMED : WAS_EVER_ARMED;
    fly(0.01f, 0.0f, 1.0f);
}

static void refusals()
{
    refuses(NULL);
    mixerRuntime.motorCount = 4;
    refuses("MIXER_FRAME");
    mixerRuntime.motorCount = ISAE_X8_CHANNELS;
    motorMixer_t *factors = mixerRuntime.currentMixer;
    factors[0].yaw *= -1.0f;
    refuses("MIXER_FRAME");
    factors[0].yaw *= -1.0f;
    mixer.yaw_motors_reversed = true;
    refuses("MIXER_FRAME");
    mixer.yaw_motors_reversed = false;
    // Of the airframe's size within a quarter.
    for (const float size : { 0.3f, 0.8f, 1.2f, 2.0f }) {
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            factors[i].yaw *= size;
        }
        refuses(fabsf(size - 1.0f) < 0.25f ? NULL : "MIXER_FRAME");
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            factors[i].yaw /= size;
        }
    }
    profile.motor_output_limit = 90;
    refuses("OUTPUT_LIMIT");
    profile = { 100, 20, 0 };
    refuses("THRUST_LIN");
    profile = { 100, 0, 100 };
    refuses("VBAT_SAG");
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
    for (const uint16_t outside : { 1100, 1700 }) {
        voltage = outside;
        refuses("VBAT_RANGE");
    }
    isFlipping = true;
    refuses(NULL);
    isFlipping = false;
    armingFlags = WAS_EVER_ARMED;
    refuses(NULL);
    armingFlags = 0;
    voltage = 1695; // within 1 %
    refuses(NULL);
    voltage = 1480;
    refuses(NULL);
}

static void setpoints()
{
    const float roll = ISAE_X8_BETAFLIGHT_ROLL_NM, pitch = ISAE_X8_BETAFLIGHT_PITCH_NM, yaw = ISAE_X8_BETAFLIGHT_YAW_NM;
    const float half = level(0.5f).thrust_n;
    arm(true);
    // A profile that is chosen in flight.
    mixerRuntime.motorOutputHigh = 1900.0f;
    coaxialMixerApply(0.05f, 0.04f, 0.1f, 0.5f, true);
    check(mixes({ 0.05f * roll, -0.04f * pitch, 0.1f * yaw, half }, 0), "a setpoint");
    mixerRuntime.motorOutputHigh = 2047.0f;
    mixer.yaw_motors_reversed = true;
    coaxialMixerApply(0.0f, 0.0f, -0.1f, 0.5f, true);
    check(mixes({ 0.0f, 0.0f, 0.1f * yaw, half }, 0), "motors reversed");
    mixer.yaw_motors_reversed = false;
    coaxialMixerApply(0.5f, 0.0f, 0.0f, 0.0f, false);
    check(mixes({ 0.25f * roll, 0.0f, 0.0f, 0.0f }, 0), "half of the authority without airmode");
    const float before = motor[0];
    for (int i = 0; i < 200; i++) {
        coaxialMixerApply(NAN, 0.0f, 0.0f, 0.9f, true);
        const bool holds = motor[0] == before, stands = motor[0] == mixerRuntime.disarmMotorOutput;
        check(i < 99 ? holds : i > 101 ? stands : holds || stands, "not finite: holds for 0.1 s, then stops");
    }
    fly(0.5f, 0.5f, 0.0f);
    check(mixes(level(0.5f), 0), "finite again");

    for (const uint16_t outside : { 1270, 1100 }) {
        voltage = outside;
        fly(2.0f, 0.5f, 0.0f);
        check(coaxialMixerIsBatteryOutside() == (outside == 1100), "a voltage beyond 1 % of the range is told");
    }
    voltage = 1480;
    fly(2.0f, 0.5f, 0.0f);
    check(!coaxialMixerIsBatteryOutside(), "and no longer");
    arm(false);
    check(motor[0] == -1.0f, "disarmed");
}

// Runs for `seconds`; whether no motor was ever out.
static bool allTurn(float seconds, float throttle, float spinUp, int wrong = -1, float shown = 0.0f)
{
    bool holds = true;
    for (int i = 0; i < lrintf(seconds / DT); i++) {
        fly(DT, throttle, spinUp, wrong, shown);
        holds = holds && !coaxialMixerMotorOut() && mixes(level(throttle), 0);
    }
    return holds;
}

static void motorsThatStop()
{
    for (const float spinUp : { 0.05f, 0.15f, 0.3f, 0.6f }) {
        arm(true);
        check(allTurn(1.0f, 0.0f, spinUp) && allTurn(0.5f, 0.5f, spinUp), "motors start from rest");
        // Betaflight's motor stop, and again from rest.
        for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
            motor[i] = mixerRuntime.disarmMotorOutput;
        }
        check(allTurn(1.0f, 0.5f, spinUp), "motors start again");
        arm(false);
    }

    arm(true);
    fly(1.0f, 0.5f, 0.1f);
    for (const float lost : { 0.05f, 0.1f, 0.2f, 0.35f, 0.5f }) {
        // Lost packets leave the last speed.
        check(allTurn(lost, 0.5f, 0.1f, 2, 5000.0f), "lost telemetry is no stopped motor");
        fly(lost, 0.5f, 0.1f, 2);
        const bool isOut = lost > 0.11f, isIn = lost < 0.09f;
        check(coaxialMixerMotorOut() == 3 ? !isIn : !isOut, "0 rpm for 0.1 s is a motor that is out");
        check(mixes(level(0.5f), coaxialMixerMotorOut() ? 4 : 0), "the others carry the vehicle, it idles");
        check(allTurn(0.5f, 0.5f, 0.1f), "it comes back with its first turn");
    }
    uint32_t draw = 1;
    bool holds = true;
    for (int i = 0; i < 20000; i++) {
        draw = draw * 1664525u + 1013904223u;
        const bool isWrong = draw >> 31;
        holds = allTurn(DT, 0.5f, 0.1f, isWrong ? int(draw >> 28) & 7 : -1) && holds;
    }
    check(holds, "0 at random is no stopped motor");

    // Telemetry of several: two are believed, three are not.
    for (const int count : { 2, 3, 8 }) {
        for (int i = 0; i < 200; i++) {
            for (int k = 0; k < ISAE_X8_CHANNELS; k++) {
                rpm[k] = k < count ? 0.0f : 5000.0f;
            }
            coaxialMixerApply(0.0f, 0.0f, 0.0f, 0.5f, true);
        }
        check(mixes(level(0.5f), count == 2 ? 3 : 0) && coaxialMixerMotorOut() == (count == 2), "more than two are not believed");
        fly(0.1f, 0.5f, 0.0f);
    }
    arm(false);

    // One that never turns is driven like the others, whatever it reports.
    arm(true);
    check(allTurn(2.0f, 0.5f, 0.1f, 4, 0.0f), "a motor counts only after it has turned");
    arm(false);
}

int main()
{
    static const float factors[ISAE_X8_CHANNELS][3] = ISAE_X8_BETAFLIGHT_FACTORS;
    mixerRuntime.motorCount = ISAE_X8_CHANNELS;
    for (int i = 0; i < ISAE_X8_CHANNELS; i++) {
        mixerRuntime.currentMixer[i] = { 1.0f, factors[i][0], factors[i][1], factors[i][2] };
        motor_disarmed[i] = -1.0f;
    }
    // An idle of Betaflight's that is not the airframe's.
    mixerRuntime.motorOutputLow = 158.0f;
    mixerRuntime.motorOutputHigh = 2047.0f;
    mixerRuntime.disarmMotorOutput = 0.0f;
    check(!strncmp(coaxialMixerAirframe, "isae-x8 ", 8) && strlen(coaxialMixerAirframe) == 8 + 64, "name and hash");
    refusals();
    arm(false);
    setpoints();
    motorsThatStop();
    printf("%d faults\n", faults);
}
