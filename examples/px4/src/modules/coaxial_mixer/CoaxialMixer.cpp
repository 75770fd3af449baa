#include "CoaxialMixer.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>

#ifdef MODULE_BASE_HAS_DESCRIPTOR
ModuleBase::Descriptor CoaxialMixer::desc {task_spawn, custom_command, print_usage};
#endif

CoaxialMixer::CoaxialMixer() : ModuleParams(nullptr), ScheduledWorkItem(MODULE_NAME, px4::wq_configurations::rate_ctrl)
{
	// The logger subscribes to what is advertised when it starts.
	_motors_pub.advertise();
	_status_pub.advertise();
	// What was published before this module started.
	actuator_motors_s before;
	_motors_sub.update(&before);
	updateParams();
}

CoaxialMixer::~CoaxialMixer()
{
	perf_free(_loop_perf);
}

void CoaxialMixer::Run()
{
	if (should_exit()) {
		_torque_sub.unregisterCallback();
		_arming_check_sub.unregisterCallback();
#ifdef MODULE_BASE_HAS_DESCRIPTOR
		exit_and_cleanup(desc);
#else
		exit_and_cleanup();
#endif
		return;
	}

	perf_begin(_loop_perf);
#ifndef ENABLE_LOCKSTEP_SCHEDULER // It would interfere with lockstep, as control_allocator says.
	ScheduleDelayed(BACKUP_SCHEDULE);
#endif
	cycle();
	perf_end(_loop_perf);
}

void CoaxialMixer::cycle()
{
	_mode_sub.update(&_mode);

	if (_parameter_update_sub.updated()) {
		parameter_update_s update;
		_parameter_update_sub.copy(&update);
		updateParams();
		_is_compared = false;

		if (_mode.flag_armed) {
			tell_change();
		}
	}

	if (!_is_compared && !_mode.flag_armed) {
		_is_compared = true;
		compare_parameters(_mismatch);
	}

	const bool displaced = is_displaced();
	answer_arming_check();

	if (displaced) {
		return;
	}

	vehicle_torque_setpoint_s torque;

	if (_torque_sub.update(&torque) && mix_setpoint(torque)) {
		_last_mix = hrt_absolute_time();

	} else if (_mismatch[0] || hrt_elapsed_time(&_last_mix) > PATIENCE) {
		// Until then the outputs hold the last throttles.
		publish_motors(nullptr, hrt_absolute_time());
	}
}

// Library and parameters must be of one vehicle: those of its frame as `cargo mixer params` writes them, and no
// correction of what the mixer corrects itself.
void CoaxialMixer::compare_parameters(Text &first)
{
	first[0] = '\0';
	expect(first, "CA_ROTOR_COUNT", _param_rotor_count.get(), ISAE_X8_CHANNELS);
	expect(first, "THR_MDL_FAC", _param_thrust_curve.get(), 0.f);

	// 0 V: the airframe has no voltage law, and PX4's may stand.
	if (ISAE_X8_REFERENCE_V > 0.f) {
		expect(first, "MC_BAT_SCALE_EN", _param_battery_scale.get(), 0.f);
	}

	static constexpr const char *keys[] {"PX", "PY", "PZ", "AX", "AY", "AZ", "CT", "KM"};
	static constexpr float rotors[ISAE_X8_CHANNELS][8] = ISAE_X8_PX4_ROTORS;

	for (int rotor = 0; rotor < ISAE_X8_CHANNELS; ++rotor) {
		for (int key = 0; key < 8; ++key) {
			char name[32];
			float value = NAN;
			snprintf(name, sizeof(name), "CA_ROTOR%d_%s", rotor, keys[key]);
			param_get(param_find(name), &value);
			expect(first, name, value, rotors[rotor][key]);
		}
	}
}

// PX4 bends the throttles by a THR_MDL_FAC that is set in flight at once. Stopping the motors would be worse.
void CoaxialMixer::tell_change()
{
	Text first;
	compare_parameters(first);

	if (first[0]) {
		mavlink_log_critical(&_mavlink_log_pub, "Coaxial mixer: %s, set it back", first);
	}
}

void CoaxialMixer::expect(Text &first, const char *name, float value, float of_airframe)
{
	// Ground stations show two decimals, which are a fifth of a CA_ROTORn_KM.
	const bool is_ratio = strstr(name, "_KM") != nullptr;
	const float tolerance = (is_ratio ? 1e-4f : 0.005f) + 0.01f * std::fabs(of_airframe);

	if (!first[0] && !(std::fabs(value - of_airframe) <= tolerance)) {
		snprintf(first, sizeof(first), "%s is %.4f, must be %.4f for %s", name, static_cast<double>(value),
			 static_cast<double>(of_airframe), ISAE_X8_AIRFRAME);
	}
}

// How far a voltage is outside the airframe's range_v, as a share; 0 inside, and where the airframe has no [voltage].
static float beyond_range(float voltage_v)
{
	const float beyond_v = fmaxf(ISAE_X8_MIN_V - voltage_v, voltage_v - ISAE_X8_MAX_V);
	return ISAE_X8_REFERENCE_V > 0.f ? fmaxf(beyond_v, 0.f) / voltage_v : 0.f;
}

// Why the vehicle must not arm: another vehicle's parameters, or a battery that is not the airframe's; null where it may.
// Where another module flies the vehicle, that is not this one's to say.
const char *CoaxialMixer::refusal()
{
	if (_displaced || _mode.flag_armed) {
		return nullptr;
	}

	if (_mismatch[0]) {
		return _mismatch;
	}

	return beyond_range(_conditions.voltage_v) > VOLTAGE_ERROR ? outside() : nullptr;
}

const char *CoaxialMixer::outside()
{
	snprintf(_outside, sizeof(_outside), "%.2f V, %s has %.2f to %.2f V", static_cast<double>(_conditions.voltage_v),
		 ISAE_X8_AIRFRAME, static_cast<double>(ISAE_X8_MIN_V), static_cast<double>(ISAE_X8_MAX_V));
	return _outside;
}

// Outside its range the model is that of the range's end. In flight that is told once, and again after the voltage was inside.
void CoaxialMixer::tell_voltage()
{
	const float beyond = beyond_range(_conditions.voltage_v);

	if (!_mode.flag_armed || beyond <= 0.f) {
		_told_voltage = false;

	} else if (!_told_voltage && beyond > VOLTAGE_ERROR) {
		_told_voltage = true;
		mavlink_log_warning(&_mavlink_log_pub, "Coaxial mixer: %s", outside());
	}
}

// Keeps the vehicle from arming, by an arming check that the commander has for components outside it. It drops one that
// does not answer, so a question that stays away is asked for again.
void CoaxialMixer::answer_arming_check()
{
	const char *why = refusal();

	if (why && (_last_told == 0 || hrt_elapsed_time(&_last_told) > 10_s)) {
		_last_told = hrt_absolute_time();
		mavlink_log_critical(&_mavlink_log_pub, "Coaxial mixer: %s", why);
	}

	register_ext_component_reply_s registered;

	while (_registered_sub.update(&registered)) {
		if (registered.success && strncmp(registered.name, MODULE_NAME, sizeof(registered.name)) == 0) {
			_check_id = registered.arming_check_id;
		}
	}

	arming_check_request_s request;

	if (_arming_check_sub.update(&request) && _check_id >= 0 && (request.valid_registrations_mask & (1u << _check_id))) {
		_last_asked = hrt_absolute_time();
		arming_check_reply_s reply{};
		reply.timestamp = _last_asked;
		reply.request_id = request.request_id;
		reply.registration_id = _check_id;
		reply.can_arm_and_run = !why;
		_arming_check_pub.publish(reply);

	} else if (why && hrt_elapsed_time(&_last_asked) > 1_s) {
		_last_asked = hrt_absolute_time();
		register_ext_component_request_s component{};
		component.timestamp = _last_asked;
		component.request_id = _last_asked;
		strncpy(component.name, MODULE_NAME, sizeof(component.name) - 1);
		component.px4_ros2_api_version = register_ext_component_request_s::LATEST_PX4_ROS2_API_VERSION;
		component.register_arming_check = true;
		_register_pub.publish(component);
	}
}

bool CoaxialMixer::mix_setpoint(const vehicle_torque_setpoint_s &torque)
{
	_thrust_sub.update(&_thrust);
	update_conditions();

	// FRD as in PX4, but thrust counts upwards.
	const mixer_wrench_t setpoint{
		torque.xyz[0] * ISAE_X8_ROLL_NM,
		torque.xyz[1] * ISAE_X8_PITCH_NM,
		torque.xyz[2] * ISAE_X8_YAW_NM,
		-_thrust.xyz[2] * ISAE_X8_THRUST_N,
	};
	update_failed(setpoint);
	isae_x8_mix_t mixed;

	if (_mismatch[0]) {
		return false;
	}

	if (mix_in_flight(setpoint, torque.timestamp_sample, mixed) != MIXER_OK) {
		++_refused;
		return false;
	}

	_saturation = mixed.saturation;
	publish_motors(mixed.throttle, torque.timestamp_sample);

	if (hrt_elapsed_time(&_last_status) >= STATUS_INTERVAL) {
		_last_status = hrt_absolute_time();
		publish_status(setpoint, mixed);
	}

	return true;
}

int CoaxialMixer::mix(const mixer_wrench_t &setpoint, isae_x8_mix_t &out) const
{
	return _failed ? isae_x8_mix_in_with_health(&setpoint, &_conditions, _failed, &out)
	       : isae_x8_mix_in(&setpoint, &_conditions, &out);
}

// The throttles that go out: where the airframe file has the rotors' lag, those of rotors that are under way. What is achieved
// and the flags are those of steady speeds either way.
int CoaxialMixer::mix_in_flight(const mixer_wrench_t &setpoint, hrt_abstime sample, isae_x8_mix_t &out)
{
#ifdef ISAE_X8_ROTOR_LAG_S
	const hrt_abstime held = sample - _last_sample;
	_last_sample = sample;

	// Rotors begin at rest; what they did in a pause nobody knows.
	if (!_mode.flag_armed || held > PATIENCE) {
		_rotors = {};
	}

	const float held_s = 1e-6f * held;
	const int status = _failed ? isae_x8_mix_dynamic_with_health(&_rotors, &setpoint, &_conditions, _failed, held_s, &out)
			   : isae_x8_mix_dynamic(&_rotors, &setpoint, &_conditions, held_s, &out);

	for (int i = 0; i < ISAE_X8_CHANNELS; ++i) {
		if (_stopped & (1u << i)) {
			_rotors.worth[i] = 0.f;
		}
	}

	return status;
#else
	(void)sample;
	return mix(setpoint, out);
#endif
}

// Whether another module publishes the motors, too. It would be control_allocator, started later: PX4's own flies on.
bool CoaxialMixer::is_displaced()
{
	actuator_motors_s other;

	if (!_displaced && _motors_sub.update(&other)) {
		_displaced = true;
		PX4_ERR("another module publishes actuator_motors: this one publishes no more");
	}

	return _displaced;
}

// Rotors that the failure detector finds dead stay out until the vehicle is disarmed.
void CoaxialMixer::update_failed(const mixer_wrench_t &setpoint)
{
	failure_detector_status_s detected{};
	const bool is_new = _failure_sub.update(&detected) && _param_failure_mode.get() > 0;

	if (is_new) {
		_stopped = detected.motor_stop_mask;
	}

	if (!_mode.flag_armed) {
		_failed = 0;
		_doubted = 0;
		return;
	}

	const uint16_t found = detected.motor_failure_mask & ALL_ROTORS;

	if (!is_new || !detected.fd_motor || !(found & ~_failed)) {
		return;
	}

	const uint16_t out = _failed | found;

	if (__builtin_popcount(out) > MOST_OUT) {
		// The telemetry of healthy rotors is lost, or the vehicle is. Stopping more would end every flight of the former kind.
		if (out != _doubted) {
			_doubted = out;
			PX4_ERR("failure detector: rotors 0x%x, more than %d: still mixing without 0x%x", static_cast<unsigned>(out),
				MOST_OUT, static_cast<unsigned>(_failed));
		}

		return;
	}

	_failed = out;
	PX4_WARN("mixing without the rotors 0x%x", static_cast<unsigned>(_failed));

	// Whether the present thrust is held level without them.
	const mixer_wrench_t level{0.f, 0.f, 0.f, setpoint.thrust_n};
	isae_x8_mix_t mixed;

	if (mix(level, mixed) != MIXER_OK || (mixed.saturation & ~(MIXER_VOLTAGE_CLAMPED | MIXER_DENSITY_CLAMPED))) {
		PX4_ERR("without the rotors 0x%x this thrust is not held level", static_cast<unsigned>(_failed));
	}
}

void CoaxialMixer::update_conditions()
{
	// The battery that the rate controller takes for MC_BAT_SCALE_EN, which this takes the place of.
	battery_status_s battery;

	if (_battery_sub.update(&battery) && battery.connected && std::isfinite(battery.voltage_v) && battery.voltage_v > 0.f) {
		const float dt_s = 1e-6f * (battery.timestamp - _last_battery);
		_conditions.voltage_v += (battery.voltage_v - _conditions.voltage_v) * dt_s / (dt_s + VOLTAGE_TIME_CONSTANT_S);
		_last_battery = battery.timestamp;
		tell_voltage();
	}

	vehicle_air_data_s air;

	// The mixer takes and flags what is no density.
	if (_air_sub.update(&air)) {
		_conditions.density_kg_m3 = air.rho;
	}
}

// Throttles, or NAN where there are none: PX4 stops such motors.
void CoaxialMixer::publish_motors(const float *throttle, hrt_abstime timestamp_sample)
{
	if (!_mode.flag_control_allocation_enabled) {
		return;
	}

	static_assert(ISAE_X8_CHANNELS <= actuator_motors_s::NUM_CONTROLS, "more rotors than PX4 has motors");
	actuator_motors_s motors{};

	for (int i = 0; i < actuator_motors_s::NUM_CONTROLS; ++i) {
		motors.control[i] = throttle && i < ISAE_X8_CHANNELS && !((_failed | _stopped) & (1u << i)) ? throttle[i] : NAN;
	}

	motors.timestamp_sample = timestamp_sample;
	motors.timestamp = hrt_absolute_time();
	_motors_pub.publish(motors);
	_motors_sub.update(&motors);
}

void CoaxialMixer::publish_status(const mixer_wrench_t &setpoint, const isae_x8_mix_t &mix)
{
	// The rate controller stops integrating for any other difference than 0, so those within the mixer's tolerance are 0.
	const auto unallocated = [&mix](uint32_t flags, float asked, float achieved, float unit) {
		return (mix.saturation & flags) ? (asked - achieved) / unit : 0.f;
	};
	const mixer_wrench_t &achieved = mix.achieved;
	control_allocator_status_s status{};
	status.unallocated_torque[0] = unallocated(MIXER_ROLL_SHORT | MIXER_ROLL_OVER, setpoint.roll_nm, achieved.roll_nm, ISAE_X8_ROLL_NM);
	status.unallocated_torque[1] = unallocated(MIXER_PITCH_SHORT | MIXER_PITCH_OVER, setpoint.pitch_nm, achieved.pitch_nm, ISAE_X8_PITCH_NM);
	status.unallocated_torque[2] = unallocated(MIXER_YAW_SHORT | MIXER_YAW_OVER, setpoint.yaw_nm, achieved.yaw_nm, ISAE_X8_YAW_NM);
	status.unallocated_thrust[2] = -unallocated(MIXER_THRUST_SHORT | MIXER_THRUST_OVER, setpoint.thrust_n, achieved.thrust_n, ISAE_X8_THRUST_N);
	status.torque_setpoint_achieved = !(mix.saturation & (MIXER_ROLL_SHORT | MIXER_ROLL_OVER | MIXER_PITCH_SHORT
					    | MIXER_PITCH_OVER | MIXER_YAW_SHORT | MIXER_YAW_OVER));
	status.thrust_setpoint_achieved = !(mix.saturation & (MIXER_THRUST_SHORT | MIXER_THRUST_OVER));

	for (int i = 0; i < ISAE_X8_CHANNELS; ++i) {
		status.actuator_saturation[i] = mix.throttle[i] >= ISAE_X8_THROTTLE_MAX ? control_allocator_status_s::ACTUATOR_SATURATION_UPPER
						: mix.throttle[i] <= ISAE_X8_THROTTLE_MIN ? control_allocator_status_s::ACTUATOR_SATURATION_LOWER
						: control_allocator_status_s::ACTUATOR_SATURATION_OK;
	}

	status.handled_motor_failure_mask = _failed;
	status.motor_stop_mask = _stopped;
	status.timestamp = hrt_absolute_time();
	_status_pub.publish(status);
}

int CoaxialMixer::task_spawn(int, char *[])
{
	// Both would write the motors.
	if (orb_exists(ORB_ID(actuator_motors), 0) == PX4_OK) {
		PX4_ERR("actuator_motors is published already: control_allocator stop");
		return PX4_ERROR;
	}

	CoaxialMixer *instance = new CoaxialMixer();

	if (instance && instance->_torque_sub.registerCallback() && instance->_arming_check_sub.registerCallback()) {
#ifdef MODULE_BASE_HAS_DESCRIPTOR
		desc.object.store(instance);
		desc.task_id = task_id_is_work_queue;
#else
		_object.store(instance);
		_task_id = task_id_is_work_queue;
#endif
		instance->ScheduleNow();
		return PX4_OK;
	}

	PX4_ERR("no memory or no callback");
	delete instance;
	return PX4_ERROR;
}

int CoaxialMixer::print_status()
{
	// 0 V: the airframe has no voltage law, and none was measured.
	PX4_INFO("%s %s of a file with SHA-256 %.12s, %.2f V, %.3f kg/m3", ISAE_X8_AIRFRAME, ISAE_X8_VERSION, ISAE_X8_SHA256,
		 static_cast<double>(_conditions.voltage_v), static_cast<double>(_conditions.density_kg_m3));
	PX4_INFO("saturation 0x%x, rotors out 0x%x, refused %u%s", static_cast<unsigned>(_saturation), static_cast<unsigned>(_failed),
		 _refused, _displaced ? ", displaced by another module" : "");

	const char *why = refusal();

	if (why) {
		PX4_INFO("arming refused: %s", why);
	}

	perf_print_counter(_loop_perf);
	return 0;
}

int CoaxialMixer::custom_command(int, char *[])
{
	return print_usage("unknown command");
}

int CoaxialMixer::print_usage(const char *reason)
{
	if (reason) {
		PX4_WARN("%s", reason);
	}

	PRINT_MODULE_DESCRIPTION("Mixes torque and thrust setpoints for coaxial pairs, in place of control_allocator.");
	PRINT_MODULE_USAGE_NAME("coaxial_mixer", "controller");
	PRINT_MODULE_USAGE_COMMAND("start");
	PRINT_MODULE_USAGE_DEFAULT_COMMANDS();
	return 0;
}

extern "C" __EXPORT int coaxial_mixer_main(int argc, char *argv[])
{
#ifdef MODULE_BASE_HAS_DESCRIPTOR
	return ModuleBase::main(CoaxialMixer::desc, argc, argv);
#else
	return CoaxialMixer::main(argc, argv);
#endif
}
