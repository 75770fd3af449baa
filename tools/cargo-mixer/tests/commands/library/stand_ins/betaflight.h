// What examples/betaflight uses of Betaflight, declared by hand.

#pragma once

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "isae_x8.h"
#include "mixer_coaxial.h"

#define USE_COAXIAL_MIXER
#define FC_VERSION_YEAR 2026
#define USE_BARO
#define USE_DYN_IDLE
#define USE_DSHOT_TELEMETRY
#define COAXIAL_MIXER_HEALTH

#define MAX_SUPPORTED_MOTORS 8
#define STATIC_ASSERT(condition, name) static_assert(condition, #name)
#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))
#define sq(x) ((x) * (x))
#define GET_BATTERY_LPF_FREQUENCY(period) (1.0f / ((period) / 10.0f))
#define RPM_LIMIT_ACTIVE (mixerConfig()->rpm_limit)
#define ARMED 1
#define WAS_EVER_ARMED 2
#define ARMING_FLAG(mask) (armingFlags & (mask))
#define ARMING_DISABLED_COAXIAL_MIXER (1 << 29)
#define LOG2(v) (31 - __builtin_clz(v))
#define DSHOT_MIN_THROTTLE 48
#define BOXCRASHFLIP 3

typedef struct { float state, k; } pt1Filter_t;
typedef struct { float throttle, roll, pitch, yaw; } motorMixer_t;
typedef struct { bool yaw_motors_reversed, rpm_limit; } mixerConfig_t;
typedef struct { uint8_t vbatSagLpfPeriod; } batteryConfig_t;
typedef struct { uint8_t motor_output_limit, thrustLinearization, vbat_sag_compensation; } pidProfile_t;
typedef struct { int32_t pressure; } baro_t;
typedef struct {
    uint8_t motorCount;
    motorMixer_t currentMixer[MAX_SUPPORTED_MOTORS];
    bool feature3dEnabled;
    float motorOutputLow, motorOutputHigh, disarmMotorOutput, dynIdleMinRps;
} mixerRuntime_t;
enum { SENSOR_BARO = 4 };

extern mixerRuntime_t mixerRuntime;
extern pidProfile_t *currentPidProfile;
extern float motor[MAX_SUPPORTED_MOTORS];
extern float motor_disarmed[MAX_SUPPORTED_MOTORS];
extern uint8_t armingFlags;
extern const char *armingDisableFlagNames[];
extern baro_t baro;

float pt1FilterGain(float frequency, float dt);
void pt1FilterInit(pt1Filter_t *filter, float k);
float pt1FilterApply(pt1Filter_t *filter, float input);
const mixerConfig_t *mixerConfig(void);
const batteryConfig_t *batteryConfig(void);
uint16_t getBatteryVoltageLatest(void);
float pidGetDT(void);
bool sensors(uint32_t mask);
bool isMotorProtocolDshot(void);
bool IS_RC_MODE_ACTIVE(int box);
void setArmingDisabled(uint32_t flag);
void unsetArmingDisabled(uint32_t flag);
float getDshotRpm(uint8_t index);
