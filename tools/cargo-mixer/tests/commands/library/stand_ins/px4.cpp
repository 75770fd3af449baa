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
static void publish(const T &message)
{
	static uORB::Publication<T> publication(stand_in::topic<T>());
	publication.publish(message);
}

// A cycle of the rate controller: thrust first, then the torque that wakes the module.
static void cycle(float roll, float pitch, float yaw, float thrust, hrt_abstime period_us = 5000)
{
	stand_in::now_us() += period_us;
	publish(vehicle_thrust_setpoint_s{0, 0, {0.f, 0.f, -thrust}});
	publish(vehicle_torque_setpoint_s{0, stand_in::now_us() - 100, {roll, pitch, yaw}});
}

// The battery as it is measured, and what the low-pass of 0.1 s makes of it.
static float voltage_v = ISAE_X8_REFERENCE_V;

static void measure(float measured_v)
{
	static hrt_abstime last_us = 0;
	const float dt_s = 1e-6f * (stand_in::now_us() - last_us);
	last_us = stand_in::now_us();
	voltage_v += (measured_v - voltage_v) * dt_s / (dt_s + 0.1f);
	publish(battery_status_s{last_us, measured_v, true});
}

// A parameter as `cargo mixer params` writes it, or another, and the module is told.
static void set(const char *name, float value)
{
	stand_in::parameters()[name] = value;
	publish(parameter_update_s{});
}

static void set_parameters_of_the_airframe()
{
	static const char *keys[] = {"PX", "PY", "PZ", "AX", "AY", "AZ", "CT", "KM"};
	static const float rotors[ISAE_X8_CHANNELS][8] = ISAE_X8_PX4_ROTORS;
	set("CA_ROTOR_COUNT", ISAE_X8_CHANNELS);

	for (int rotor = 0; rotor < ISAE_X8_CHANNELS; ++rotor) {
		for (int key = 0; key < 8; ++key) {
			set(("CA_ROTOR" + std::to_string(rotor) + "_" + keys[key]).c_str(), rotors[rotor][key]);
		}
	}
}

// The commander asks whether the vehicle may arm: 1 or 0, -1 without an answer.
static int may_arm(int registration)
{
	const unsigned before = published<arming_check_reply_s>();
	const uint8_t id = static_cast<uint8_t>(before + 7);
	publish(arming_check_request_s{0, 1u << registration, id});
	const arming_check_reply_s reply = last<arming_check_reply_s>();
	return published<arming_check_reply_s>() == before ? -1
	       : reply.request_id == id && reply.registration_id == registration && reply.can_arm_and_run;
}

// The density that was published last.
static float density_kg_m3 = NAN;

// Whether the motors are, bit by bit, those of the library without the rotors of the channels in `failed`, whose motors
// PX4 is told to stop.
static bool same(float roll, float pitch, float yaw, float thrust, unsigned failed = 0, unsigned stopped = 0)
{
	const mixer_wrench_t setpoint{roll * ISAE_X8_ROLL_NM, pitch * ISAE_X8_PITCH_NM, yaw * ISAE_X8_YAW_NM, thrust * ISAE_X8_THRUST_N};
	isae_x8_mix_t mix;
	const actuator_motors_s motors = last<actuator_motors_s>();
	const mixer_conditions_t conditions{voltage_v, density_kg_m3};
	bool equal = (failed ? isae_x8_mix_in_with_health(&setpoint, &conditions, failed, &mix)
		      : isae_x8_mix_in(&setpoint, &conditions, &mix)) == MIXER_OK;

	for (int i = 0; i < actuator_motors_s::NUM_CONTROLS; ++i) {
		const bool is_still = i >= ISAE_X8_CHANNELS || ((failed | stopped) & (1u << i));
		equal = equal && (is_still ? std::isnan(motors.control[i])
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

	// No parameters yet: the module refuses to arm by name, and mixes nothing.
	CHECK(command("start") == PX4_OK);
	CHECK(stand_in::topic<control_allocator_status_s>()->advertised);
	publish(vehicle_control_mode_s{0, false, true});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(strstr(stand_in::told(), "CA_ROTOR_COUNT is 0.0000, must be 8.0000 for isae-x8"));
	CHECK(std::isnan(last<actuator_motors_s>().control[0]) && published<control_allocator_status_s>() == 0);
	const register_ext_component_request_s component = last<register_ext_component_request_s>();
	CHECK(component.register_arming_check && !component.register_mode);
	CHECK(may_arm(3) == -1);
	register_ext_component_reply_s registered{0, "another", true, 2};
	publish(registered);
	CHECK(may_arm(2) == -1);
	snprintf(registered.name, sizeof(registered.name), "%s", component.name);
	registered.arming_check_id = 3;
	publish(registered);
	CHECK(may_arm(3) == 0);
	set_parameters_of_the_airframe();
	CHECK(may_arm(3) == 1);

	// Each of them counts; two decimals of a ground station suffice.
	const float place_m = stand_in::parameters()["CA_ROTOR3_PX"];
	set("CA_ROTOR3_PX", std::round(100.f * place_m) / 100.f);
	CHECK(may_arm(3) == 1);
	set("CA_ROTOR3_PX", 1.1f * place_m);
	CHECK(may_arm(3) == 0);
	stand_in::now_us() += 10000001;
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(strstr(stand_in::told(), "CA_ROTOR3_PX"));
	set("CA_ROTOR3_PX", place_m);
	set("CA_ROTOR5_KM", -stand_in::parameters()["CA_ROTOR5_KM"]);
	CHECK(may_arm(3) == 0);
	set("CA_ROTOR5_KM", -stand_in::parameters()["CA_ROTOR5_KM"]);
	set("THR_MDL_FAC", 0.8f);
	CHECK(may_arm(3) == 0);
	set("THR_MDL_FAC", 0.f);
	set("MC_BAT_SCALE_EN", 1.f);
	CHECK(may_arm(3) == 0);

	// The commander has dropped the check: it is asked for again.
	const unsigned asked = published<register_ext_component_request_s>();
	stand_in::now_us() += 1000001;
	CHECK(may_arm(1) == -1 && published<register_ext_component_request_s>() == asked + 1);
	set("MC_BAT_SCALE_EN", 0.f);
	CHECK(may_arm(3) == 1);

	// Allocation is not enabled: a status, but no motors.
	const unsigned motors = published<actuator_motors_s>();
	publish(vehicle_control_mode_s{0, true, false});
	cycle(0.f, 0.f, 0.f, 0.f);
	CHECK(published<actuator_motors_s>() == motors && published<control_allocator_status_s>() == 1);
	publish(vehicle_control_mode_s{0, true, true});

	// A parameter that is changed in flight is told at once, and refuses arming after it.
	stand_in::told()[0] = '\0';
	set("THR_MDL_FAC", 0.3f);
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(strstr(stand_in::told(), "THR_MDL_FAC is 0.3000, must be 0.0000 for isae-x8"));
	CHECK(same(0.f, 0.f, 0.f, 0.3f) && may_arm(3) == 1);
	publish(vehicle_control_mode_s{0, false, true});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(may_arm(3) == 0);
	set("THR_MDL_FAC", 0.f);
	CHECK(may_arm(3) == 1);

	// A fifth more of a pair's torque over thrust is another pair.
	const float ratio = stand_in::parameters()["CA_ROTOR0_KM"];
	set("CA_ROTOR0_KM", ratio + 0.004f);
	CHECK(may_arm(3) == 0);
	set("CA_ROTOR0_KM", 1.005f * ratio);
	CHECK(may_arm(3) == 1);
	publish(vehicle_control_mode_s{0, true, true});

	// Status at 200 Hz at most.
	cycle(0.f, 0.f, 0.f, 0.3f);
	const unsigned told = published<control_allocator_status_s>();
	cycle(0.f, 0.f, 0.f, 0.3f, 2500);
	CHECK(published<control_allocator_status_s>() == told);
	cycle(0.f, 0.f, 0.f, 0.3f, 2500);
	CHECK(published<control_allocator_status_s>() == told + 1);

	// Before a voltage is measured it is the reference voltage.
	cycle(0.02f, -0.01f, 0.05f, 0.3f);
	CHECK(same(0.02f, -0.01f, 0.05f, 0.3f));
	measure(15.5f);
	cycle(0.02f, -0.01f, 0.05f, 0.3f);
	CHECK(same(0.02f, -0.01f, 0.05f, 0.3f));
	control_allocator_status_s status = last<control_allocator_status_s>();
	CHECK(status.torque_setpoint_achieved && status.thrust_setpoint_achieved);

	for (int axis = 0; axis < 3; ++axis) {
		CHECK(status.unallocated_torque[axis] <= 0.f && status.unallocated_torque[axis] >= 0.f);
	}

	// A sag counts by half after 0.1 s.
	const float full_v = voltage_v;
	stand_in::now_us() += 100000;
	measure(full_v - 2.f);
	cycle(0.f, 0.f, 0.f, 0.4f);
	CHECK(same(0.f, 0.f, 0.f, 0.4f) && std::fabs(voltage_v - (full_v - 1.f)) < 0.03f);

	// Outside the range it is told once in flight, and on the ground the vehicle does not arm.
	const float inside_v = voltage_v;

	for (int i = 0; i < 20; ++i) {
		stand_in::now_us() += 100000;
		measure(0.8f * ISAE_X8_MIN_V);
		cycle(0.f, 0.f, 0.f, 0.4f);
	}

	CHECK(same(0.f, 0.f, 0.f, 0.4f) && strstr(stand_in::told(), "V, isae-x8 has 12.80 to 16.80 V") && may_arm(3) == 1);
	publish(vehicle_control_mode_s{0, false, true});
	cycle(0.f, 0.f, 0.f, 0.4f);
	CHECK(may_arm(3) == 0);

	for (int i = 0; i < 40; ++i) {
		stand_in::now_us() += 100000;
		measure(inside_v);
		cycle(0.f, 0.f, 0.f, 0.4f);
	}

	CHECK(may_arm(3) == 1);
	publish(vehicle_control_mode_s{0, true, true});

	// A voltage that is not measured is the last one that was.
	const battery_status_s unusable[] = {{0, 13.f, false}, {0, 0.f, true}, {0, NAN, true}, {0, INFINITY, true}};

	for (const battery_status_s &battery : unusable) {
		publish(battery);
		cycle(0.f, 0.f, 0.f, 0.4f);
		CHECK(same(0.f, 0.f, 0.f, 0.4f));
	}


	// Yaw beyond the authority, either way: that axis only.
	cycle(0.f, 0.f, 2.f, 0.3f);
	CHECK(same(0.f, 0.f, 2.f, 0.3f));
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

	// A setpoint that is not finite: held for 500 ms, then stopped.
	unsigned before = published<actuator_motors_s>();
	cycle(NAN, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == before);

	for (int i = 0; i < 100; ++i) {
		cycle(NAN, 0.f, 0.f, 0.3f);
	}

	CHECK(published<actuator_motors_s>() > before && std::isnan(last<actuator_motors_s>().control[0]));
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));

	// Setpoints cease: the same.
	before = published<actuator_motors_s>();
	px4::ScheduledWorkItem::wait_until(stand_in::now_us() + 450000);
	CHECK(published<actuator_motors_s>() == before);
	px4::ScheduledWorkItem::wait_until(stand_in::now_us() + 150000);
	CHECK(published<actuator_motors_s>() > before && std::isnan(last<actuator_motors_s>().control[0]));
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));

	// A rotor that is found out: nothing by the default, mixed without by CA_FAILURE_MODE 1, until the vehicle is disarmed.
	publish(failure_detector_status_s{0, true, 1u << 2, 0});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));
	set("CA_FAILURE_MODE", 1.f);
	const unsigned errors = stand_in::errors();
	publish(failure_detector_status_s{0, true, 1u << 2, 0});
	cycle(0.01f, 0.f, 0.f, 0.3f);
	CHECK(same(0.01f, 0.f, 0.f, 0.3f, 1u << 2));
	// No density was measured, which says nothing of level flight.
	CHECK(stand_in::errors() == errors);
	CHECK(last<control_allocator_status_s>().handled_motor_failure_mask == 1u << 2);
	publish(failure_detector_status_s{0, false, 0, 0});
	cycle(0.01f, 0.f, 0.f, 0.3f);
	CHECK(same(0.01f, 0.f, 0.f, 0.3f, 1u << 2));
	publish(failure_detector_status_s{0, true, 1u << 5, 0});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 1u << 2 | 1u << 5));

	// A third rotor, and motors that the airframe has not, are not believed.
	publish(failure_detector_status_s{0, true, 1u << 6 | 1u << 9, 0});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 1u << 2 | 1u << 5));
	publish(vehicle_control_mode_s{0, false, true});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));

	// The telemetry of all motors is lost at once: all are mixed for.
	publish(vehicle_control_mode_s{0, true, true});
	publish(failure_detector_status_s{0, true, 0xff, 0});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));
	CHECK(last<control_allocator_status_s>().handled_motor_failure_mask == 0);

	// A motor that an injected failure stops is still mixed for, until the failure is taken back.
	publish(failure_detector_status_s{0, false, 0, 1u << 4});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f, 0, 1u << 4) && last<control_allocator_status_s>().motor_stop_mask == 1u << 4);
	publish(failure_detector_status_s{0, false, 0, 0});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));

	// Thin air takes more throttle, and a density that is none is that of the bench.
	const float dense = last<actuator_motors_s>().control[0];
	density_kg_m3 = 0.9f;
	publish(vehicle_air_data_s{0, density_kg_m3});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f) && last<actuator_motors_s>().control[0] > 1.05f * dense);
	CHECK(command("status") == PX4_OK);
	density_kg_m3 = NAN;
	publish(vehicle_air_data_s{0, 0.f});
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(same(0.f, 0.f, 0.f, 0.3f));
	CHECK(command("nonsense") == 0);
	CHECK(command("stop") == PX4_OK);
	cycle(0.f, 0.f, 0.f, 0.3f);
	const unsigned after = published<actuator_motors_s>();
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == after);

	// The module starts again after its own messages, and stops without setpoints.
	CHECK(command("start") == PX4_OK);
	CHECK(command("stop") == PX4_OK);
	px4::ScheduledWorkItem::wait_until(stand_in::now_us() + 100000);
	CHECK(command("start") == PX4_OK);
	cycle(0.f, 0.f, 0.f, 0.3f);
	const unsigned alone = published<actuator_motors_s>();
	CHECK(alone > after && !std::isnan(last<actuator_motors_s>().control[0]));

	// PX4's allocator is started while the module runs: the module yields.
	publish(actuator_motors_s{});
	cycle(0.f, 0.f, 0.f, 0.3f);
	cycle(0.f, 0.f, 0.f, 0.3f);
	CHECK(published<actuator_motors_s>() == alone + 1);

	// What another module flies is not this one's to refuse.
	publish(vehicle_control_mode_s{0, false, true});
	set("CA_ROTOR3_PX", 1.1f * place_m);
	CHECK(may_arm(3) != 0);

	printf("%u faults\n", faults);
	return faults != 0;
}
