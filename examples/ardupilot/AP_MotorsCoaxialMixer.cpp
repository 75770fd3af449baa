#include "AP_MotorsCoaxialMixer.h"

#include <AP_Vehicle/AP_Vehicle_Type.h>

// Copter alone: the other vehicles do not link the library.
#if AP_MOTORS_COAXIAL_MIXER_ENABLED && APM_BUILD_TYPE(APM_BUILD_ArduCopter)

#include <AP_Baro/AP_Baro.h>
#include <AP_BattMonitor/AP_BattMonitor.h>
#include <AP_HAL/AP_HAL.h>
#include <GCS_MAVLink/GCS.h>

extern const AP_HAL::HAL &hal;

static_assert(ISAE_X8_CHANNELS <= AP_MOTORS_MAX_NUM_MOTORS, "more rotors than ArduPilot has motors");

// The rotors of the airframe, whatever FRAME_TYPE says; the motor test takes them in the order of their numbers.
void AP_MotorsCoaxialMixer::setup_motors(motor_frame_class frame_class, motor_frame_type)
{
    static const float factors[ISAE_X8_CHANNELS][3] = ISAE_X8_ARDUPILOT_FACTORS;
    set_initialised_ok(false);
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        add_motor_raw(i, factors[i][0], factors[i][1], factors[i][2], i + 1);
    }
    constexpr uint8_t n = ISAE_X8_CHANNELS;
    _mav_type = n == 6 ? MAV_TYPE_HEXAROTOR : n == 8 ? MAV_TYPE_OCTOROTOR : n == 12 ? MAV_TYPE_DODECAROTOR : MAV_TYPE_GENERIC;
    // Another class needs another object, which the next start makes.
    set_initialised_ok(frame_class == MOTOR_FRAME_COAXIAL_MIXER);
}

void AP_MotorsCoaxialMixer::output_armed_stabilizing()
{
    // By a clock of its own: ArduPilot's time of a step has other names in other versions.
    const uint32_t now_us = AP_HAL::micros();
    _step_s = 1e-6f * (now_us - _last_us);
    _last_us = now_us;
    update_conditions();

    // Stopped motors give nothing, whatever is asked.
    if (_spool_state == SpoolState::SHUT_DOWN) {
        stopped();
        return;
    }

    // The spool logic raises the limit while the motors start and lowers it while they stop.
    float throttle = get_throttle();
    if (throttle <= 0.0f) {
        limit.throttle_lower = true;
    }
    if (throttle >= _throttle_thrust_max) {
        throttle = _throttle_thrust_max;
        limit.throttle_upper = true;
    }

    // No compensation gain: voltage, density and curve are the mixer's. The units are those of ArduPilot's own mixer, so that the
    // attitude controller's gains keep their meaning.
    const mixer_wrench_t setpoint {
        (_roll_in + _roll_in_ff) * ISAE_X8_ARDUPILOT_ROLL_NM,
        (_pitch_in + _pitch_in_ff) * ISAE_X8_ARDUPILOT_PITCH_NM,
        (_yaw_in + _yaw_in_ff) * ISAE_X8_ARDUPILOT_YAW_NM,
        throttle * ISAE_X8_ARDUPILOT_THRUST_N,
    };
    isae_x8_mix_t mix;
    if (mix_in_flight(setpoint, mix) == MIXER_OK) {
        mixed(mix, throttle);
    } else {
        refused();
    }
}

// The throttles that go out: where the airframe file has the rotors' lag, those of rotors that are under way.
int AP_MotorsCoaxialMixer::mix_in_flight(const mixer_wrench_t &setpoint, isae_x8_mix_t &mix)
{
#ifdef ISAE_X8_ROTOR_LAG_S
    // On the ground ArduPilot turns the rotors itself; what they did in a pause nobody knows.
    if (_spool_state == SpoolState::GROUND_IDLE || _step_s > PATIENCE_S) {
        _rotors = {};
    }
    return isae_x8_mix_dynamic(&_rotors, &setpoint, &_conditions, _step_s, &mix);
#else
    return isae_x8_mix_in(&setpoint, &_conditions, &mix);
#endif
}

// Voltage of the battery that ArduPilot's own compensation has (MOT_BAT_IDX), 0 where it has none. It is that under load, as on
// the bench: the resting estimate does not know the sag that takes thrust away.
float AP_MotorsCoaxialMixer::measured_voltage() const
{
    const AP_BattMonitor &battery = AP::battery();
    const uint8_t index = thr_lin.get_battery_index();
    const float voltage_v = battery.voltage(index);
    return battery.healthy(index) && isfinite(voltage_v) ? voltage_v : 0.0f;
}

// Density by the barometer's pressure, kg/m^3, 0 where it has none. The temperature is that of the ground (BARO_GND_TEMP), less
// that of the standard atmosphere for the height above it: the barometer's own is the board's.
static float measured_density()
{
    constexpr float ZERO_C = 273.15f;
    constexpr float LAPSE_K_M = 0.0065f;
    constexpr float GAS_CONSTANT = 287.05f;
    const AP_Baro &baro = AP::baro();
    const float temperature_k = baro.get_ground_temperature() + ZERO_C - LAPSE_K_M * baro.get_altitude();
    const float density_kg_m3 = baro.get_pressure() / (GAS_CONSTANT * temperature_k);
    return baro.healthy() && isfinite(density_kg_m3) ? density_kg_m3 : 0.0f;
}

void AP_MotorsCoaxialMixer::update_conditions()
{
    const float voltage_v = measured_voltage();
    if (voltage_v > 0.0f) {
        _conditions.voltage_v = _voltage_filter.apply(voltage_v, _step_s);
        tell_voltage();
    }
    const float density_kg_m3 = measured_density();
    if (density_kg_m3 > 0.0f) {
        _conditions.density_kg_m3 = density_kg_m3;
    }
}

// How far a voltage is outside the airframe's range_v, V; below 0 inside.
static float beyond_range(float voltage_v)
{
    return MAX(ISAE_X8_MIN_V - voltage_v, voltage_v - ISAE_X8_MAX_V);
}

// Outside its range the model is that of the range's end. That is told once, and again after the voltage was inside.
void AP_MotorsCoaxialMixer::tell_voltage()
{
    const float voltage_v = _conditions.voltage_v;
    if (!NEEDS_VOLTAGE || !armed() || beyond_range(voltage_v) <= 0.0f) {
        _told_voltage = false;
    } else if (!_told_voltage && beyond_range(voltage_v) > VOLTAGE_ERROR * voltage_v) {
        _told_voltage = true;
        GCS_SEND_TEXT(MAV_SEVERITY_WARNING, "%.2f V, %s has %.2f to %.2f V", double(voltage_v), ISAE_X8_AIRFRAME,
                      double(ISAE_X8_MIN_V), double(ISAE_X8_MAX_V));
    }
}

void AP_MotorsCoaxialMixer::mixed(const isae_x8_mix_t &mix, float throttle)
{
    _refused_s = 0.0f;
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        _throttle[i] = mix.throttle[i];
        // What logs, notch filter and the check for a failed motor read: a share of the range from MOT_SPIN_MIN to _MAX.
        _thrust_rpyt_out[i] = thr_lin.actuator_to_thrust(mix.throttle[i]);
    }
    // Idle gives thrust where none is asked for: landed, ArduPilot expects 0.
    _throttle_out = MIN(throttle, mix.achieved.thrust_n / ISAE_X8_ARDUPILOT_THRUST_N);

    // The spool logic has cleared or set the limits; the mixer adds its own.
    const uint32_t flags = mix.saturation;
    limit.roll = limit.roll || (flags & (MIXER_ROLL_SHORT | MIXER_ROLL_OVER)) != 0;
    limit.pitch = limit.pitch || (flags & (MIXER_PITCH_SHORT | MIXER_PITCH_OVER)) != 0;
    limit.yaw = limit.yaw || (flags & (MIXER_YAW_SHORT | MIXER_YAW_OVER)) != 0;
    limit.throttle_upper = limit.throttle_upper || (flags & MIXER_THRUST_SHORT) != 0;
    limit.throttle_lower = limit.throttle_lower || (flags & MIXER_THRUST_OVER) != 0;

    check_for_failed_motor(_throttle_out);
}

void AP_MotorsCoaxialMixer::refused()
{
    // The motors hold the last throttles, then they stop.
    limit.roll = limit.pitch = limit.yaw = limit.throttle_lower = limit.throttle_upper = true;
    _refused_s += _step_s;
    if (_refused_s > PATIENCE_S) {
        stopped();
    }
}

void AP_MotorsCoaxialMixer::stopped()
{
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        _throttle[i] = 0.0f;
        _thrust_rpyt_out[i] = 0.0f;
    }
    _throttle_out = 0.0f;
#ifdef ISAE_X8_ROTOR_LAG_S
    _rotors = {};
#endif
}

void AP_MotorsCoaxialMixer::output_to_motors()
{
    if (_spool_state == SpoolState::SHUT_DOWN || _spool_state == SpoolState::GROUND_IDLE) {
        AP_MotorsMatrix::output_to_motors();
        return;
    }
    // Throttles go out as they are: thr_lin would bend them a second time.
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        if (motor_enabled[i]) {
            set_actuator_with_slew(_actuator[i], _throttle[i]);
            rc_write(i, output_to_pwm(_actuator[i]));
        }
    }
}

bool AP_MotorsCoaxialMixer::arming_checks(size_t buflen, char *buffer) const
{
    return AP_MotorsMatrix::arming_checks(buflen, buffer) && check_parameters(buflen, buffer) && check_battery(buflen, buffer);
}

// Whether the parameters are those that the airframe file was measured with.
bool AP_MotorsCoaxialMixer::check_parameters(size_t buflen, char *buffer) const
{
    const struct {
        const char *name;
        float value;
        float expected;
        float tolerance;
    } parameters[] {
        {"SPIN_MIN", thr_lin.get_spin_min(), fminf(ISAE_X8_THROTTLE_MIN, MOST_SPIN_MIN), SAME_THROTTLE},
        {"SPIN_MAX", thr_lin.get_spin_max(), ISAE_X8_THROTTLE_MAX, SAME_THROTTLE},
        {"SLEW_UP_TIME", _slew_up_time.get(), 0.0f, SAME_THROTTLE},
        {"SLEW_DN_TIME", _slew_dn_time.get(), 0.0f, SAME_THROTTLE},
    };
    for (const auto &parameter : parameters) {
        if (fabsf(parameter.value - parameter.expected) >= parameter.tolerance) {
            hal.util->snprintf(buffer, buflen, "MOT_%s is %.5g, %s has %.5g: set it", parameter.name, double(parameter.value),
                               ISAE_X8_AIRFRAME, double(parameter.expected));
            return false;
        }
    }
    return true;
}

// Whether the voltage is one of the airframe's: otherwise the mixer would keep another, and the thrust would be off.
bool AP_MotorsCoaxialMixer::check_battery(size_t buflen, char *buffer) const
{
    const unsigned number = thr_lin.get_battery_index() + 1;
    const float voltage_v = measured_voltage();
    if (NEEDS_VOLTAGE && voltage_v <= 0.0f) {
        hal.util->snprintf(buffer, buflen, "battery %u has no voltage: set BATT_MONITOR", number);
        return false;
    }
    if (NEEDS_VOLTAGE && beyond_range(voltage_v) > VOLTAGE_ERROR * voltage_v) {
        hal.util->snprintf(buffer, buflen, "battery %u has %.2f V, %s %.2f to %.2f V: change it, or range_v", number,
                           double(voltage_v), ISAE_X8_AIRFRAME, double(ISAE_X8_MIN_V), double(ISAE_X8_MAX_V));
        return false;
    }
    return true;
}

#endif // AP_MOTORS_COAXIAL_MIXER_ENABLED
