#include "AP_MotorsCoaxialMixer.h"

#include <AP_BattMonitor/AP_BattMonitor.h>

static_assert(ISAE_X8_CHANNELS <= AP_MOTORS_MAX_NUM_MOTORS, "more rotors than ArduPilot has motors");

void AP_MotorsCoaxialMixer::output_armed_stabilizing()
{
    update_voltage();

    // Stopped motors give nothing, whatever is asked.
    if (_spool_state == SpoolState::SHUT_DOWN) {
        _throttle_out = 0.0f;
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

    // No compensation gain: voltage and curve are the mixer's. The units are those of ArduPilot's own mixer, so that the
    // attitude controller's gains keep their meaning.
    const mixer_wrench_t setpoint {
        (_roll_in + _roll_in_ff) * ISAE_X8_ARDUPILOT_ROLL_NM,
        (_pitch_in + _pitch_in_ff) * ISAE_X8_ARDUPILOT_PITCH_NM,
        (_yaw_in + _yaw_in_ff) * ISAE_X8_ARDUPILOT_YAW_NM,
        throttle * ISAE_X8_ARDUPILOT_THRUST_N,
    };
    isae_x8_mix_t mix;
    if (isae_x8_mix(&setpoint, _voltage_v, &mix) == MIXER_OK) {
        mixed(mix);
    } else {
        refused();
    }
}

void AP_MotorsCoaxialMixer::update_voltage()
{
    const AP_BattMonitor &battery = AP::battery();
    // Of the first monitor; `healthy()` would speak for all of them.
    const float voltage_v = battery.voltage(AP_BATT_PRIMARY_INSTANCE);
    if (battery.healthy(AP_BATT_PRIMARY_INSTANCE) && isfinite(voltage_v) && voltage_v > 0.0f) {
        _voltage_v = voltage_v;
    }
}

void AP_MotorsCoaxialMixer::mixed(const isae_x8_mix_t &mix)
{
    _refused_s = 0.0f;
    for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
        _throttle[i] = mix.throttle[i];
        // What logs, notch filter and the check for a failed motor read.
        _thrust_rpyt_out[i] = mix.throttle[i];
    }
    _throttle_out = mix.achieved.thrust_n / ISAE_X8_ARDUPILOT_THRUST_N;

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
        for (float &throttle : _throttle) {
            throttle = 0.0f;
        }
    }
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
