// ArduCopter's motors by a compiled coaxial mixer: channel 0 of the airframe is Motor1.
#pragma once

#include <AP_Motors/AP_MotorsMatrix.h>

#include "isae_x8.h"

class AP_MotorsCoaxialMixer : public AP_MotorsMatrix {
public:
    using AP_MotorsMatrix::AP_MotorsMatrix;

    void output_to_motors() override;

protected:
    void output_armed_stabilizing() override;

private:
    void update_voltage();
    void mixed(const isae_x8_mix_t &mix);
    void refused();

    // Without a usable setpoint for so long, the motors stop.
    static constexpr float PATIENCE_S = 0.1f;

    float _throttle[ISAE_X8_CHANNELS] {};
    // The last voltage that was measured.
    float _voltage_v = ISAE_X8_REFERENCE_V;
    float _refused_s = 0.0f;
};
