// Stand-ins for what examples/ardupilot uses of ArduPilot: our own declarations, not ArduPilot's, enough to compile the class
// and to drive it once. Every header of ArduPilot that it includes is this file.
#pragma once

#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>

using std::isfinite;

#define AP_MOTORS_MAX_NUM_MOTORS 32
#define MIN(a, b) ((a) < (b) ? (a) : (b))
#define MAX(a, b) ((a) > (b) ? (a) : (b))

#define APM_BUILD_ArduCopter 2
#define APM_BUILD_TYPE(type) ((type) == APM_BUILD_DIRECTORY)

enum MAV_TYPE { MAV_TYPE_GENERIC = 0, MAV_TYPE_HEXAROTOR = 13, MAV_TYPE_OCTOROTOR = 14, MAV_TYPE_DODECAROTOR = 29 };
enum MAV_SEVERITY { MAV_SEVERITY_WARNING = 4 };

// What the ground station was told, and how often.
struct Told {
    char text[100];
    unsigned times;
};
extern Told told;
#define GCS_SEND_TEXT(severity, ...) (void(severity), ++told.times, snprintf(told.text, sizeof(told.text), __VA_ARGS__))

namespace AP_HAL {
inline uint32_t &now_us()
{
    static uint32_t now = 0;
    return now;
}

inline uint32_t micros() { return now_us(); }

class Util {
public:
    int snprintf(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 4, 5)))
    {
        va_list arguments;
        va_start(arguments, format);
        const int length = vsnprintf(text, size, format, arguments);
        va_end(arguments);
        return length;
    }
};

class HAL {
public:
    Util *util;
};
}

// A parameter.
class AP_Float {
public:
    float get() const { return value; }

    float value = 0.0f;
};

class Thrust_Linearization {
public:
    float get_spin_min() const { return spin_min; }
    float get_spin_max() const { return spin_max; }
    int8_t get_battery_index() const { return battery; }
    float actuator_to_thrust(float actuator) const { return (actuator - spin_min) / (spin_max - spin_min); }

    // Protected there, with the class above for a friend.
    float spin_min = 0.15f;
    float spin_max = 0.95f;
    int8_t battery = 0;
};

// It takes the first sample as it is.
class LowPassFilterFloat {
public:
    explicit LowPassFilterFloat(const float &cutoff_hz) : _rc(1.0f / (6.2831853f * cutoff_hz)) {}
    LowPassFilterFloat(const LowPassFilterFloat &) = delete;
    LowPassFilterFloat &operator=(const LowPassFilterFloat &) = delete;

    float apply(const float &sample, const float &dt)
    {
        _output += (_begun ? dt / (dt + _rc) : 1.0f) * (sample - _output);
        _begun = true;
        return _output;
    }

private:
    float _rc;
    float _output = 0.0f;
    bool _begun = false;
};

// Of one monitor, whose index is 0 if not said otherwise.
class AP_BattMonitor {
public:
    float voltage(uint8_t index) const { return index == battery ? volts : 0.0f; }
    bool healthy(uint8_t index) const { return index == battery && good; }

    float volts = 0.0f;
    bool good = false;
    uint8_t battery = 0;
};

class AP_Baro {
public:
    // Pa, degrees C, and m above the ground.
    float get_pressure() const { return pressure; }
    float get_ground_temperature() const { return ground_temperature; }
    float get_altitude() const { return altitude; }
    bool healthy() const { return good; }

    float pressure = 0.0f;
    float ground_temperature = 0.0f;
    float altitude = 0.0f;
    bool good = false;
};

namespace AP {
inline AP_Baro &baro()
{
    static AP_Baro sensor;
    return sensor;
}

inline AP_BattMonitor &battery()
{
    static AP_BattMonitor monitor;
    return monitor;
}
}

// AP_Motors, AP_MotorsMulticopter and AP_MotorsMatrix in one.
class AP_MotorsMatrix {
public:
    explicit AP_MotorsMatrix(uint16_t speed_hz = 490) : _speed_hz(speed_hz) {}
    virtual ~AP_MotorsMatrix() = default;

    enum motor_frame_class { MOTOR_FRAME_OCTAQUAD = 4, MOTOR_FRAME_COAXIAL_MIXER = 100 };
    enum motor_frame_type { MOTOR_FRAME_TYPE_PLUS = 0 };

    virtual void init(motor_frame_class frame_class, motor_frame_type frame_type) { setup_motors(frame_class, frame_type); }

    virtual bool arming_checks(size_t buflen, char *buffer) const
    {
        if (!_ready) {
            snprintf(buffer, buflen, "Check frame class and type");
        }
        return _ready;
    }

    bool armed() const { return _armed; }
    void set_initialised_ok(bool ready) { _ready = ready; }

    // Nothing where the motors are set up.
    void add_motor_raw(int8_t motor, float roll, float pitch, float yaw, uint8_t order, float = 1.0f)
    {
        if (!_ready) {
            motor_enabled[motor] = true;
            _roll_factor[motor] = roll;
            _pitch_factor[motor] = pitch;
            _yaw_factor[motor] = yaw;
            _test_order[motor] = order;
        }
    }

    Thrust_Linearization thr_lin {};

    enum class SpoolState : uint8_t {
        SHUT_DOWN = 0,
        GROUND_IDLE = 1,
        SPOOLING_UP = 2,
        THROTTLE_UNLIMITED = 3,
        SPOOLING_DOWN = 4,
    };

    struct AP_Motors_limit {
        bool roll;
        bool pitch;
        bool yaw;
        bool throttle_lower;
        bool throttle_upper;
    } limit {};

    float get_throttle() const { return _throttle_in; }

    virtual void output_to_motors()
    {
        for (uint8_t i = 0; i < AP_MOTORS_MAX_NUM_MOTORS; i++) {
            if (motor_enabled[i]) {
                _actuator[i] = _spool_state == SpoolState::SHUT_DOWN ? 0.0f : 0.05f;
                rc_write(i, output_to_pwm(_actuator[i]));
            }
        }
    }

protected:
    virtual void output_armed_stabilizing() {}
    virtual void setup_motors(motor_frame_class, motor_frame_type) {}
    virtual const char *_get_frame_string() const { return ""; }

    virtual void rc_write(uint8_t channel, uint16_t pwm) { _written[channel] = pwm; }

    int16_t output_to_pwm(float actuator) { return static_cast<int16_t>(_pwm_min + (_pwm_max - _pwm_min) * actuator); }

    void set_actuator_with_slew(float &actuator, float input) { actuator = input; }

    void check_for_failed_motor(float throttle) { _checked_throttle = throttle; }

    uint16_t _speed_hz;
    float _roll_in = 0.0f;
    float _roll_in_ff = 0.0f;
    float _pitch_in = 0.0f;
    float _pitch_in_ff = 0.0f;
    float _yaw_in = 0.0f;
    float _yaw_in_ff = 0.0f;
    float _throttle_in = 0.0f;
    float _throttle_out = 0.0f;
    float _throttle_thrust_max = 1.0f;
    SpoolState _spool_state = SpoolState::SHUT_DOWN;
    bool motor_enabled[AP_MOTORS_MAX_NUM_MOTORS] {};
    float _roll_factor[AP_MOTORS_MAX_NUM_MOTORS] {};
    float _pitch_factor[AP_MOTORS_MAX_NUM_MOTORS] {};
    float _yaw_factor[AP_MOTORS_MAX_NUM_MOTORS] {};
    uint8_t _test_order[AP_MOTORS_MAX_NUM_MOTORS] {};
    MAV_TYPE _mav_type = MAV_TYPE_GENERIC;
    bool _armed = false;
    AP_Float _slew_up_time {};
    AP_Float _slew_dn_time {};
    int16_t _pwm_min = 1000;
    int16_t _pwm_max = 2000;
    float _thrust_rpyt_out[AP_MOTORS_MAX_NUM_MOTORS] {};
    float _actuator[AP_MOTORS_MAX_NUM_MOTORS] {};

    // Of the stand-in: what was written and checked last.
    uint16_t _written[AP_MOTORS_MAX_NUM_MOTORS] {};
    float _checked_throttle = -1.0f;
    bool _ready = false;
};
