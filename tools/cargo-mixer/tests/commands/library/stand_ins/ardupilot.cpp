// Drives examples/ardupilot once: what it writes is what the library mixes.
#include "AP_MotorsCoaxialMixer.h"

#include <cfenv>
#include <cstdio>
#include <cstring>

static AP_HAL::Util util;
static const AP_HAL::HAL here {&util};
extern const AP_HAL::HAL &hal;
const AP_HAL::HAL &hal = here;

Told told;

static unsigned faults;

static const uint32_t STEP_US = 2500;

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            ++faults; \
            printf("line %d: %s\n", __LINE__, #condition); \
        } \
    } while (0)

// Half of every motor's thrust, in N m.
static const float ROLL_NM = ISAE_X8_ARDUPILOT_ROLL_NM;
static const float PITCH_NM = ISAE_X8_ARDUPILOT_PITCH_NM;
static const float YAW_NM = ISAE_X8_ARDUPILOT_YAW_NM;

static const float FACTORS[ISAE_X8_CHANNELS][3] = ISAE_X8_ARDUPILOT_FACTORS;

class Bench : public AP_MotorsCoaxialMixer {
public:
    // The frame and the parameters of the airframe file.
    Bench() : AP_MotorsCoaxialMixer(400)
    {
        init(MOTOR_FRAME_COAXIAL_MIXER, MOTOR_FRAME_TYPE_PLUS);
        thr_lin.spin_min = ISAE_X8_THROTTLE_MIN;
        thr_lin.spin_max = ISAE_X8_THROTTLE_MAX;
    }

    // Whether arming is refused in words that have this part.
    bool refuses(const char *part) const
    {
        char said[100] {};
        const bool armed = arming_checks(sizeof(said), said);
        printf("%s\n", armed ? "arms" : said);
        return !armed && strstr(said, part) != nullptr && strlen(said) < sizeof(said) - 1;
    }

    bool arms() const
    {
        char said[100] {};
        return arming_checks(sizeof(said), said);
    }

    void cycle(SpoolState state, float roll, float pitch, float yaw, float throttle)
    {
        AP_HAL::now_us() += STEP_US;
        limit = {};
        _spool_state = state;
        // A part of each arrives as the feed-forward.
        _roll_in = 0.75f * roll;
        _roll_in_ff = 0.25f * roll;
        _pitch_in = 0.75f * pitch;
        _pitch_in_ff = 0.25f * pitch;
        _yaw_in = 0.75f * yaw;
        _yaw_in_ff = 0.25f * yaw;
        _throttle_in = throttle;
        output_armed_stabilizing();
        output_to_motors();
    }

    // The motors are the rotors of the airframe, and no others.
    bool has_the_rotors() const
    {
        for (uint8_t i = 0; i < AP_MOTORS_MAX_NUM_MOTORS; i++) {
            const bool rotor = i < ISAE_X8_CHANNELS;
            const float *const factors = FACTORS[rotor ? i : 0];
            const bool same = std::fabs(_roll_factor[i] - factors[0]) + std::fabs(_pitch_factor[i] - factors[1])
                                      + std::fabs(_yaw_factor[i] - factors[2])
                              <= 0.0f;
            if (motor_enabled[i] != rotor || (rotor && (!same || _test_order[i] != i + 1))) {
                return false;
            }
        }
        return _mav_type == MAV_TYPE_OCTOROTOR && strcmp(_get_frame_string(), "isae-x8") == 0;
    }

    // Hovers so long at a voltage.
    void hover(float volts, float seconds)
    {
        AP::battery().volts = volts;
        for (int i = 0; i < int(1e6f * seconds / STEP_US); i++) {
            cycle(SpoolState::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
        }
    }

    void set_armed(bool armed) { _armed = armed; }

    bool all_written(float throttle) const
    {
        for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
            if (std::fabs(float(_written[i]) - (1000.0f + 1000.0f * throttle)) > 1.0f) {
                return false;
            }
        }
        return _written[ISAE_X8_CHANNELS] == 0;
    }

    // Whether the actuators are those of the library, as they come.
    bool same(float roll, float pitch, float yaw, float throttle, float voltage_v, float density_kg_m3 = NAN,
              float error = 1e-5f) const
    {
        const mixer_wrench_t setpoint {roll * ROLL_NM, pitch * PITCH_NM, yaw * YAW_NM, throttle * ISAE_X8_ARDUPILOT_THRUST_N};
        isae_x8_mix_t mix;
        const mixer_conditions_t conditions {voltage_v, density_kg_m3};
        if (isae_x8_mix_in(&setpoint, &conditions, &mix) != MIXER_OK) {
            return false;
        }
        for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
            const bool close = std::fabs(_actuator[i] - mix.throttle[i]) < error && std::fabs(_thrust_rpyt_out[i] - thr_lin.actuator_to_thrust(mix.throttle[i])) < 2.0f * error;
            if (!close || _written[i] != static_cast<uint16_t>(_pwm_min + (_pwm_max - _pwm_min) * _actuator[i])) {
                return false;
            }
        }
        const float achieved = mix.achieved.thrust_n / ISAE_X8_ARDUPILOT_THRUST_N;
        return std::fabs(_throttle_out - (achieved < throttle ? achieved : throttle)) < 1e-5f;
    }

    float throttle_out() const { return _throttle_out; }

    // Parameters that are not the airframe's.
    friend void arming();

    void spool_limit(float throttle) { _throttle_thrust_max = throttle; }

    float checked() const { return _checked_throttle; }

    float actuator(uint8_t motor) const { return _actuator[motor]; }

    float output(uint8_t motor) const { return _thrust_rpyt_out[motor]; }

    void set_pulses(int16_t least, int16_t most) { _pwm_min = least; _pwm_max = most; }
};

// What differs from the airframe is named, and where it is set.
void arming()
{
    CHECK(Bench().refuses("battery 1 has no voltage: set BATT_MONITOR"));
    AP::battery().volts = 15.5f;
    CHECK(Bench().refuses("BATT_MONITOR"));
    AP::battery().good = true;
    CHECK(Bench().arms() && Bench().has_the_rotors());
    AP::battery().volts = 12.6f;
    CHECK(Bench().refuses("battery 1 has 12.60 V, isae-x8 12.80 to 16.80 V: change it, or range_v"));
    AP::battery().volts = 17.0f;
    CHECK(Bench().refuses("17.00 V"));
    // A full pack by a sensor that is half a percent off.
    AP::battery().volts = 16.88f;
    CHECK(Bench().arms());
    {
        Bench motors;
        motors.thr_lin.battery = 1;
        CHECK(motors.refuses("battery 2 has no voltage"));
        AP::battery().battery = 1;
        CHECK(motors.arms());
        AP::battery().battery = 0;
    }
    {
        // FRAME_CLASS was changed, and ArduPilot not started anew; then back.
        Bench motors;
        motors.init(Bench::MOTOR_FRAME_OCTAQUAD, Bench::MOTOR_FRAME_TYPE_PLUS);
        CHECK(motors.refuses("Check frame class and type"));
        motors.init(Bench::MOTOR_FRAME_COAXIAL_MIXER, Bench::MOTOR_FRAME_TYPE_PLUS);
        CHECK(motors.arms() && motors.has_the_rotors());
    }
    const struct {
        void (*change)(Bench &motors);
        const char *said;
    } parameters[] {
        {[](Bench &motors) { motors.thr_lin.spin_min = 0.15f; }, "MOT_SPIN_MIN is 0.15, isae-x8 has 0.1"},
        {[](Bench &motors) { motors.thr_lin.spin_max = 0.95f; }, "MOT_SPIN_MAX"},
        {[](Bench &motors) { motors._slew_up_time.value = 0.05f; }, "MOT_SLEW_UP_TIME"},
        {[](Bench &motors) { motors._slew_dn_time.value = 0.05f; }, "MOT_SLEW_DN_TIME"},
    };
    for (const auto &parameter : parameters) {
        Bench motors;
        parameter.change(motors);
        CHECK(motors.refuses(parameter.said));
    }
    AP::battery() = AP_BattMonitor();
}

// In flight the voltage is filtered, and that it leaves the range is told once.
void voltage()
{
    Bench motors;
    AP::battery().good = true;
    motors.hover(12.0f, 1.0f);
    // Not armed, nothing is told.
    CHECK(told.times == 0);
    motors.hover(16.0f, 6.0f);
    motors.set_armed(true);
    CHECK(motors.same(0.0f, 0.0f, 0.0f, 0.3f, 16.0f));
    // A step: 63 % of it after 0.32 s.
    motors.hover(14.0f, 0.3183f);
    CHECK(motors.same(0.0f, 0.0f, 0.0f, 0.3f, 14.0f + 2.0f / std::exp(1.0f), NAN, 1e-3f));
    CHECK(told.times == 0);
    motors.hover(12.6f, 5.0f);
    CHECK(told.times == 1 && strstr(told.text, "V, isae-x8 has 12.80 to 16.80 V") != nullptr);
    // To and fro at the end of the range, never inside.
    for (int i = 0; i < 5; i++) {
        motors.hover(12.6f, 3.0f);
        motors.hover(12.75f, 3.0f);
    }
    CHECK(told.times == 1);
    motors.hover(13.5f, 5.0f);
    motors.hover(12.0f, 5.0f);
    CHECK(told.times == 2);
    AP::battery() = AP_BattMonitor();
}

int main()
{
    // What ArduPilot's simulator traps.
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    using State = AP_MotorsMatrix::SpoolState;
    arming();
    voltage();
    Bench motors;

    motors.cycle(State::SHUT_DOWN, 0.0f, 0.0f, 0.0f, 0.0f);
    CHECK(motors.all_written(0.0f) && motors.throttle_out() <= 0.0f);
    motors.cycle(State::GROUND_IDLE, 0.0f, 0.0f, 0.0f, 0.0f);
    CHECK(motors.all_written(0.05f));

    // Before a voltage is measured it is the reference voltage, and while it is not it is the last one that was.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.05f, -0.02f, 0.1f, 0.3f);
    CHECK(motors.same(0.05f, -0.02f, 0.1f, 0.3f, ISAE_X8_REFERENCE_V));
    // Within the pulse range of the parameters.
    motors.set_pulses(1100, 1940);
    motors.cycle(State::THROTTLE_UNLIMITED, 0.05f, -0.02f, 0.1f, 0.3f);
    CHECK(motors.same(0.05f, -0.02f, 0.1f, 0.3f, ISAE_X8_REFERENCE_V));
    motors.set_pulses(1000, 2000);
    CHECK(!motors.limit.roll && !motors.limit.pitch && !motors.limit.yaw && !motors.limit.throttle_upper && !motors.limit.throttle_lower);
    CHECK(std::fabs(motors.checked() - 0.3f) < 0.001f);
    AP::battery().volts = 15.5f;
    AP::battery().good = true;
    motors.cycle(State::THROTTLE_UNLIMITED, 0.05f, -0.02f, 0.1f, 0.3f);
    CHECK(motors.same(0.05f, -0.02f, 0.1f, 0.3f, 15.5f));
    AP::battery().volts = 3.0f;
    AP::battery().good = false;
    motors.cycle(State::THROTTLE_UNLIMITED, 0.05f, -0.02f, 0.1f, 0.3f);
    CHECK(motors.same(0.05f, -0.02f, 0.1f, 0.3f, 15.5f));

    // Limits: yaw beyond the authority; all of the thrust; none of it; the spool logic's.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 4.0f, 0.3f);
    CHECK(motors.limit.yaw && !motors.limit.roll && !motors.limit.pitch);
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 1.0f);
    CHECK(motors.limit.throttle_upper && !motors.limit.throttle_lower);
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.0f);
    CHECK(motors.limit.throttle_lower && !motors.limit.throttle_upper && motors.all_written(ISAE_X8_THROTTLE_MIN));
    // Landed, the idle's thrust is not asked for.
    CHECK(motors.throttle_out() <= 0.0f);
    motors.spool_limit(0.2f);
    motors.cycle(State::SPOOLING_UP, 0.0f, 0.0f, 0.0f, 0.3f);
    CHECK(motors.same(0.0f, 0.0f, 0.0f, 0.2f, 15.5f) && motors.limit.throttle_upper);
    motors.spool_limit(1.0f);

    // A setpoint that is not finite: held for 100 ms, then stopped.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
    const float before = motors.actuator(0);
    motors.cycle(State::THROTTLE_UNLIMITED, NAN, 0.0f, 0.0f, 0.3f);
    CHECK(before > ISAE_X8_THROTTLE_MIN && std::fabs(motors.actuator(0) - before) <= 0.0f && motors.limit.roll);
    for (int i = 0; i < 50; i++) {
        motors.cycle(State::THROTTLE_UNLIMITED, NAN, 0.0f, 0.0f, 0.3f);
    }
    CHECK(motors.all_written(0.0f));

    // Stopped in flight, as by the emergency stop: nothing of the last mix is left.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
    CHECK(motors.throttle_out() > 0.25f);
    motors.cycle(State::SHUT_DOWN, 0.5f, 0.0f, 0.0f, 0.3f);
    CHECK(motors.all_written(0.0f) && motors.throttle_out() <= 0.0f && motors.output(0) <= 0.0f);

    // The standard atmosphere at 3,000 m, 100 m above the ground; then a barometer that fails: the density is the last one.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
    const float dense = motors.actuator(0);
    AP::baro().pressure = 70108.5f;
    AP::baro().ground_temperature = -3.85f;
    AP::baro().altitude = 100.0f;
    AP::baro().good = true;
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
    CHECK(motors.same(0.0f, 0.0f, 0.0f, 0.3f, 15.5f, 0.90912f) && motors.actuator(0) > 1.05f * dense);
    AP::baro().pressure = 50000.0f;
    AP::baro().good = false;
    motors.cycle(State::THROTTLE_UNLIMITED, 0.0f, 0.0f, 0.0f, 0.3f);
    CHECK(motors.same(0.0f, 0.0f, 0.0f, 0.3f, 15.5f, 0.90912f));

    printf("%u faults\n", faults);
    return faults != 0;
}
