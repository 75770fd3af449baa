// ArduCopter's motors by a compiled coaxial mixer: channel 0 of the airframe is Motor1.
#pragma once

#include <cmath>

#include <AP_Motors/AP_MotorsMatrix.h>

#include "isae_x8.h"

// Pulse widths of throttle 0 and 1 on the bench, microseconds: those of the pair's bench file. Digital outputs have 1000 and 2000.
#ifndef COAXIAL_MIXER_PWM_MIN
#define COAXIAL_MIXER_PWM_MIN 1000
#endif
#ifndef COAXIAL_MIXER_PWM_MAX
#define COAXIAL_MIXER_PWM_MAX 2000
#endif

class AP_MotorsCoaxialMixer : public AP_MotorsMatrix {
public:
    using AP_MotorsMatrix::AP_MotorsMatrix;

    void output_to_motors() override;

    // Refuses a frame, numbering or parameters that are not those of the airframe file, and a battery without a voltage.
    bool arming_checks(size_t buflen, char *buffer) const override;

protected:
    void output_armed_stabilizing() override;

private:
    void update_conditions();
    void mixed(const isae_x8_mix_t &mix, float throttle);
    void refused();
    void stopped();
    bool check_frame(size_t buflen, char *buffer) const;
    bool check_parameters(size_t buflen, char *buffer) const;
    bool check_battery(size_t buflen, char *buffer) const;

    // Without a usable setpoint for so long, the motors stop.
    static constexpr float PATIENCE_S = 0.1f;
    // Factors that differ by less are one: a motor that is a few degrees off.
    static constexpr float SAME_FACTOR = 0.05f;
    // Throttles that differ by less are one.
    static constexpr float SAME_THROTTLE = 0.005f;
    // ArduPilot does not arm with a larger MOT_SPIN_MIN.
    static constexpr float MOST_SPIN_MIN = 0.3f;

    float _throttle[ISAE_X8_CHANNELS] {};
    // The last voltage and density that were measured: until then those of the bench, which NAN stands for.
    mixer_conditions_t _conditions {ISAE_X8_REFERENCE_V, NAN};
    float _refused_s = 0.0f;
};
