#include "AP_MotorsCoaxialMixer.h"

#include <AP_Baro/AP_Baro.h>
#include <AP_BattMonitor/AP_BattMonitor.h>
#include <AP_HAL/AP_HAL.h>

#if CONFIG_HAL_BOARD == HAL_BOARD_SITL
#include <fenv.h>
#endif

extern const AP_HAL::HAL &hal;

static_assert(ISAE_X8_CHANNELS <= AP_MOTORS_MAX_NUM_MOTORS, "more rotors than ArduPilot has motors");

namespace {

// ArduPilot's simulator traps floating-point exceptions; boards do not. The library raises none that it traps: this guard keeps
// an older library from ending the simulation.
class NoTraps {
public:
#if CONFIG_HAL_BOARD == HAL_BOARD_SITL
    NoTraps() { feholdexcept(&_before); }
    ~NoTraps() { fesetenv(&_before); }

private:
    fenv_t _before;
#endif
};

int mix_without_traps(const mixer_wrench_t &setpoint, const mixer_conditions_t &conditions, isae_x8_mix_t &mix)
{
    const NoTraps guard {};
    (void)guard;
    return isae_x8_mix_in(&setpoint, &conditions, &mix);
}

} // namespace

void AP_MotorsCoaxialMixer::output_armed_stabilizing()
{
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
    if (mix_without_traps(setpoint, _conditions, mix) == MIXER_OK) {
        mixed(mix, throttle);
    } else {
        refused();
    }
}

// Voltage of the first battery monitor, 0 where it has none; `healthy()` would speak for all of them.
static float measured_voltage()
{
    const AP_BattMonitor &battery = AP::battery();
    const float voltage_v = battery.voltage(AP_BATT_PRIMARY_INSTANCE);
    return battery.healthy(AP_BATT_PRIMARY_INSTANCE) && isfinite(voltage_v) ? voltage_v : 0.0f;
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
        _conditions.voltage_v = voltage_v;
    }
    const float density_kg_m3 = measured_density();
    if (density_kg_m3 > 0.0f) {
        _conditions.density_kg_m3 = density_kg_m3;
    }
}

void AP_MotorsCoaxialMixer::mixed(const isae_x8_mix_t &mix, float throttle)
{
    _refused_s = 0.0f;
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        _throttle[i] = mix.throttle[i];
        // What logs, notch filter and the check for a failed motor read.
        _thrust_rpyt_out[i] = mix.throttle[i];
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
    _refused_s += _dt_s;
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
    return AP_MotorsMatrix::arming_checks(buflen, buffer) && check_frame(buflen, buffer) && check_parameters(buflen, buffer)
           && check_battery(buflen, buffer);
}

// Whether ArduPilot's motors are the airframe's rotors, by what each does to an axis.
bool AP_MotorsCoaxialMixer::check_frame(size_t buflen, char *buffer) const
{
    static const float factors[ISAE_X8_CHANNELS][3] = ISAE_X8_ARDUPILOT_FACTORS;
    for (uint8_t i = 0; i < AP_MOTORS_MAX_NUM_MOTORS; i++) {
        if (motor_enabled[i] != (i < ISAE_X8_CHANNELS)) {
            hal.util->snprintf(buffer, buflen, "%s has %u rotors: Motor%u differs, set FRAME_CLASS", ISAE_X8_AIRFRAME,
                               unsigned(ISAE_X8_CHANNELS), unsigned(i + 1));
            return false;
        }
    }
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        const float own[3] {_roll_factor[i], _pitch_factor[i], _yaw_factor[i]};
        const char *const axes[3] {"roll", "pitch", "yaw"};
        for (uint8_t axis = 0; axis < 3; axis++) {
            // Of yaw the sign counts: V frames weight it by the arm.
            const bool same = axis == 2 ? own[axis] * factors[i][axis] > 0.0f || fabsf(factors[i][axis]) < SAME_FACTOR
                                        : fabsf(own[axis] - factors[i][axis]) < SAME_FACTOR;
            if (!same) {
                hal.util->snprintf(buffer, buflen, "Motor%u %s %.2f, %s %.2f: set FRAME_TYPE or channels", unsigned(i + 1),
                                   axes[axis], double(own[axis]), ISAE_X8_AIRFRAME, double(factors[i][axis]));
                return false;
            }
        }
    }
    return true;
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
        {"SPIN_MIN", thr_lin.get_spin_min(), MIN(ISAE_X8_THROTTLE_MIN, MOST_SPIN_MIN), SAME_THROTTLE},
        {"SPIN_MAX", thr_lin.get_spin_max(), ISAE_X8_THROTTLE_MAX, SAME_THROTTLE},
        {"PWM_MIN", float(get_pwm_output_min()), float(COAXIAL_MIXER_PWM_MIN), 0.5f},
        {"PWM_MAX", float(get_pwm_output_max()), float(COAXIAL_MIXER_PWM_MAX), 0.5f},
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

// Whether the voltage is measured: without it the mixer would keep that of the bench, whatever the pack has.
bool AP_MotorsCoaxialMixer::check_battery(size_t buflen, char *buffer) const
{
    // 0 in an airframe without a voltage law.
    const bool needs_voltage = ISAE_X8_REFERENCE_V > 0.0f;
    if (needs_voltage && measured_voltage() <= 0.0f) {
        hal.util->snprintf(buffer, buflen, "battery 1 has no voltage: set BATT_MONITOR");
        return false;
    }
    return true;
}
