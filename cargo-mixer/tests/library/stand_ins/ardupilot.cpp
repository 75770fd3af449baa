// Drives examples/ardupilot once: what it writes is what the library mixes.
#include "AP_MotorsCoaxialMixer.h"

#include <cstdio>

static unsigned faults;

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

class Bench : public AP_MotorsCoaxialMixer {
public:
    Bench() : AP_MotorsCoaxialMixer(400)
    {
        for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
            motor_enabled[i] = true;
        }
    }

    void cycle(SpoolState state, float roll, float pitch, float yaw, float throttle)
    {
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
    bool same(float roll, float pitch, float yaw, float throttle, float voltage_v) const
    {
        const mixer_wrench_t setpoint {roll * ROLL_NM, pitch * PITCH_NM, yaw * YAW_NM, throttle * ISAE_X8_ARDUPILOT_THRUST_N};
        isae_x8_mix_t mix;
        if (isae_x8_mix(&setpoint, voltage_v, &mix) != MIXER_OK) {
            return false;
        }
        for (uint8_t i = 0; i < ISAE_X8_CHANNELS; i++) {
            const bool close = std::fabs(_actuator[i] - mix.throttle[i]) < 1e-5f && std::fabs(_thrust_rpyt_out[i] - mix.throttle[i]) < 1e-5f;
            if (!close || _written[i] != static_cast<uint16_t>(1000.0f + 1000.0f * _actuator[i])) {
                return false;
            }
        }
        return std::fabs(_throttle_out - mix.achieved.thrust_n / ISAE_X8_ARDUPILOT_THRUST_N) < 1e-5f;
    }

    void spool_limit(float throttle) { _throttle_thrust_max = throttle; }

    float checked() const { return _checked_throttle; }

    float actuator(uint8_t motor) const { return _actuator[motor]; }
};

int main()
{
    using State = AP_MotorsMatrix::SpoolState;
    Bench motors;

    motors.cycle(State::SHUT_DOWN, 0.0f, 0.0f, 0.0f, 0.0f);
    CHECK(motors.all_written(0.0f));
    motors.cycle(State::GROUND_IDLE, 0.0f, 0.0f, 0.0f, 0.0f);
    CHECK(motors.all_written(0.05f));

    // Before a voltage is measured it is the reference voltage, and while it is not it is the last one that was.
    motors.cycle(State::THROTTLE_UNLIMITED, 0.05f, -0.02f, 0.1f, 0.3f);
    CHECK(motors.same(0.05f, -0.02f, 0.1f, 0.3f, ISAE_X8_REFERENCE_V));
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

    printf("%u faults\n", faults);
    return faults != 0;
}
