// ArduCopter's motors by a compiled coaxial mixer: channel 0 of the airframe is Motor1.
#pragma once

// Since early 2026.
#if __has_include("AP_Motors_config.h")
#include "AP_Motors_config.h"
#endif

// 0 leaves the class out.
#ifndef AP_MOTORS_COAXIAL_MIXER_ENABLED
#define AP_MOTORS_COAXIAL_MIXER_ENABLED 1
#endif

#if AP_MOTORS_COAXIAL_MIXER_ENABLED

#include <AP_Motors/AP_MotorsMatrix.h>
#include <Filter/LowPassFilter.h>

#include "isae_x8.h"

class AP_MotorsCoaxialMixer : public AP_MotorsMatrix {
public:
    using AP_MotorsMatrix::AP_MotorsMatrix;

    void output_to_motors() override;

    // Refuses parameters that are not those of the airframe file, and a voltage that its range_v does not have.
    bool arming_checks(size_t buflen, char *buffer) const override;

protected:
    void output_armed_stabilizing() override;
    void setup_motors(motor_frame_class frame_class, motor_frame_type frame_type) override;
    const char *_get_frame_string() const override { return ISAE_X8_AIRFRAME; }

private:
    float measured_voltage() const;
    void update_conditions();
    void tell_voltage();
    int mix_in_flight(const mixer_wrench_t &setpoint, isae_x8_mix_t &mix);
    void mixed(const isae_x8_mix_t &mix, float throttle);
    void refused();
    void stopped();
    bool check_parameters(size_t buflen, char *buffer) const;
    bool check_battery(size_t buflen, char *buffer) const;

    // Without a usable setpoint for so long, the motors stop.
    static constexpr float PATIENCE_S = 0.1f;
    // Throttles that differ by less are one.
    static constexpr float SAME_THROTTLE = 0.005f;
    // ArduPilot does not arm with a larger MOT_SPIN_MIN.
    static constexpr float MOST_SPIN_MIN = 0.3f;
    // Share of a voltage that a sensor may be off: a full pack may read more than range_v has.
    static constexpr float VOLTAGE_ERROR = 0.01f;
    // 0 in an airframe without a voltage law.
    static constexpr bool NEEDS_VOLTAGE = ISAE_X8_MAX_V > 0.0f;

    float _throttle[ISAE_X8_CHANNELS] {};
#ifdef ISAE_X8_ROTOR_LAG_S
    // How fast the rotors turn, by what they were given.
    isae_x8_state_t _rotors {};
#endif
    // The last voltage and density that were measured: until then those of the bench, which NAN stands for.
    mixer_conditions_t _conditions {ISAE_X8_REFERENCE_V, NAN};
    // Hz: that of ArduPilot's own compensation (AP_MOTORS_BATT_VOLT_FILT_HZ).
    LowPassFilterFloat _voltage_filter {0.5f};
    bool _told_voltage = false;
    float _refused_s = 0.0f;
    uint32_t _last_us = 0;
    float _step_s = 0.0f;
};

#endif // AP_MOTORS_COAXIAL_MIXER_ENABLED
