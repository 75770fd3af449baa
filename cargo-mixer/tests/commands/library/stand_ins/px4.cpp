// Drives examples/px4 once: what it publishes is what the library mixes.
#include "px4.hpp"

#include "isae_x8.h"

extern "C" int coaxial_mixer_main(int argc, char *argv[]);

static unsigned faults;

#define CHECK(condition) \
	do { \
		if (!(condition)) { \
			++faults; \
			printf("line %d: %s\n", __LINE__, #condition); \
		} \
	} while (0)

static int command(const char *word)
{
	char name[] = "coaxial_mixer";
	char argument[16];
	snprintf(argument, sizeof(argument), "%s", word);
	char *argv[] = {name, argument, nullptr};
	return coaxial_mixer_main(2, argv);
}

template<class T>
static T last()
{
	T message;
	memcpy(&message, stand_in::topic<T>()->last, sizeof(T));
	return message;
}

template<class T>
static unsigned published() { return stand_in::topic<T>()->generation; }

template<class T>
static void publish(const T &message) { uORB::Publication<T>(stand_in::topic<T>()).publish(message); }

// A cycle of the rate controller: thrust first, then the torque that wakes the module.
static void cycle(float roll, float pitch, float yaw, float thrust)
{
	stand_in::now_us() += 2500;
	publish(vehicle_thrust_setpoint_s{0, 0, {0.f, 0.f, -thrust}});
	publish(vehicle_torque_setpoint_s{0, stand_in::now_us() - 100, {roll, pitch, yaw}});
}

// The density that was published last.
static float density_kg_m3 = NAN;

// Whether the motors are, bit by bit, those of the library without the rotors of the channels in `failed`, whose motors
// PX4 is told to stop.
static bool same(float roll, float pitch, float yaw, float thrust, float voltage_v, unsigned failed = 0)
{
	const mixer_wrench_t setpoint{roll * ISAE_X8_ROLL_NM, pitch * ISAE_X8_PITCH_NM, yaw * ISAE_X8_YAW_NM, thrust * ISAE_X8_THRUST_N};
	isae_x8_mix_t mix;
	const actuator_motors_s motors = last<actuator_motors_s>();
	const mixer_conditions_t conditions{voltage_v, density_kg_m3};
	bool equal = (failed ? isae_x8_mix_in_with_health(&setpoint, &conditions, failed, &mix)
		      : isae_x8_mix_in(&setpoint, &conditions, &mix)) == MIXER_OK;

	for (int i = 0; i < actuator_motors_s::NUM_CONTROLS; ++i) {
		const bool stopped = i >= ISAE_X8_CHANNELS || (failed & (1u << i));
		equal = equal && (stopped ? std::isnan(motors.control[i])
				  : memcmp(&motors.control[i], &mix.throttle[i], sizeof(float)) == 0);
	}

	return equal && motors.timestamp_sample == stand_in::now_us() - 100;
}

int main()
{
	// PX4's allocator still runs.
	stand_in::topic<actuator_motors_s>()->advertised = true;
	CHECK(command("start") == PX4_ERROR);
	stand_in::topic<actuator_motors_s>()->advertised = false;
	CHECK(command("start") == PX4_OK);

	// Allocation is not enabled: a status, but no motors.
	cycle(0.f, 0.f, 0.f, 0.f);
	CHECK(published<actuator_motors_s>() == 0 && published<control_allocator_status_s>() == 1);
	publish(vehicle_control_mode_s{0, true, true});

	// Before a voltage is measured it is the reference voltage.
	cycle(0.02f, -0.01f, 0.05f, 0.3f);
	CHECK(same(0.02f, -0.01f, 0.05f, 0.3f, ISAE_X8_REFERENCE_V));
	publish(battery_status_s{0, 15.5f, true});
	cycle(0.02f, -0.01f, 0.05f, 0.3f);
	CHECK(same(0.02f, -0.01f, 0.05f, 0.3f, 15.5f));
	control_allocator_status_s status = last<control_allocator_status_s>();
	CHECK(status.torque_setpoint_achieved && status.thrust_setpoint_achieved);

	for (int axis = 0; axis < 3; ++axis) {
		CHECK(status.unallocated_torque[axis] <= 0.f && status.unallocated_torque[axis] >= 0.f);
	}

	// A voltage that is not measured is the last one that was.
	const battery_status_s unusable[] = {{0, 13.f, false}, {0, 0.f, true}, {0, NAN, true}, {0, INFINITY, true}};

	for (const battery_status_s &battery : unusable) {
		publish(battery);
		cycle(0.f, 0.f, 0.f, 0.4f);
		CHECK(same(0.f, 0.f, 0.f, 0.4f, 15.5f));
	}


	// Yaw beyond the authority, either way: that axis only.
	cycle(0.f, 0.f, 2.f, 0.3f);
	CHECK(same(0.f, 0.f, 2.f, 0.3f, 15.5f));
	status = last<control_allocator_status_s>();
	CHECK(!status.torque_setpoint_achieved && status.thrust_setpoint_achieved);
	CHECK(status.unallocated_torque[2] > 0.5f && status.unallocated_torque[2] < 2.f);
	CHECK(status.unallocated_torque[0] <= 0.f && status.unallocated_torque[0] >= 0.f);
	cycle(0.f, 0.f, -2.f, 0.3f);
	status = last<control_allocator_status_s>();
	CHECK(status.unallocated_torque[2] < -0.5f && status.unallocated_torque[2] > -2.f);

	// All of the thrust, and more: PX4's z counts downwards.
	cycle(0.f, 0.f, 0.f, 1.5f);
	status = last<control_allocator_status_s>();
	CHECK(status.torque_setpoint_achieved && !status.thrust_setpoint_achieved && status.unallocated_thrust[2] < -0.1f);
	CHECK(status.actuator_saturation[0] == control_allocator_status_s::ACTUATOR_SATURATION_UPPER);

	// A setpoint that is not finite: held for 100 ms, then stopped.
	const unsigned before = published<actuator_motors_s>();
	cycle(NAN, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == before);

	for (int i = 0; i < 50; ++i) {
		cycle(NAN, 0.f, 0.f, 0.3f);
	}

	CHECK(published<actuator_motors_s>() > before && std::isnan(last<actuator_motors_s>().control[0]));
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f));

	// A rotor that is found out: nothing by the default, mixed without by CA_FAILURE_MODE 1, until the vehicle is disarmed.
	publish(failure_detector_status_s{0, true, 1u << 2});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f));
	stand_in::failure_mode() = 1;
	const unsigned errors = stand_in::errors();
	publish(failure_detector_status_s{0, true, 1u << 2});
	cycle(0.01f, 0.f, 0.f, 0.3f);
	CHECK(same(0.01f, 0.f, 0.f, 0.3f, 15.5f, 1u << 2));
	// No density was measured, which says nothing of level flight.
	CHECK(stand_in::errors() == errors);
	CHECK(last<control_allocator_status_s>().handled_motor_failure_mask == 1u << 2);
	publish(failure_detector_status_s{0, false, 0});
	cycle(0.01f, 0.f, 0.f, 0.3f);
	CHECK(same(0.01f, 0.f, 0.f, 0.3f, 15.5f, 1u << 2));
	publish(failure_detector_status_s{0, true, 1u << 5});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f, 1u << 2 | 1u << 5));

	// A third rotor, and motors that the airframe has not, are not believed.
	publish(failure_detector_status_s{0, true, 1u << 6 | 1u << 9});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f, 1u << 2 | 1u << 5));
	publish(vehicle_control_mode_s{0, false, true});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f));

	// The telemetry of all motors is lost at once: all are mixed for.
	publish(vehicle_control_mode_s{0, true, true});
	publish(failure_detector_status_s{0, true, 0xff});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f));
	CHECK(last<control_allocator_status_s>().handled_motor_failure_mask == 0);

	// Thin air takes more throttle, and a density that is none is that of the bench.
	const float dense = last<actuator_motors_s>().control[0];
	density_kg_m3 = 0.9f;
	publish(vehicle_air_data_s{0, density_kg_m3});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f) && last<actuator_motors_s>().control[0] > 1.05f * dense);
	CHECK(command("status") == PX4_OK);
	density_kg_m3 = NAN;
	publish(vehicle_air_data_s{0, 0.f});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 15.5f));
	CHECK(command("nonsense") == 0);
	CHECK(command("stop") == PX4_OK);
	cycle(0.f, 0.f, 0.f, 0.3f);
	const unsigned after = published<actuator_motors_s>();
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == after);

	// PX4's allocator is started while the module runs: the module yields.
	stand_in::topic<actuator_motors_s>()->advertised = false;
	CHECK(command("start") == PX4_OK);
	publish(vehicle_control_mode_s{0, true, true});
	cycle(0.f, 0.f, 0.f, 0.3f);
	cycle(0.f, 0.f, 0.f, 0.3f);
	const unsigned alone = published<actuator_motors_s>();
	CHECK(alone == after + 2);
	publish(actuator_motors_s{});
	cycle(0.f, 0.f, 0.f, 0.3f);
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == alone + 1);

	printf("%u faults\n", faults);
	return faults != 0;
}
