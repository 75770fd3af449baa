// PX4's control allocation by a compiled coaxial mixer: runs after every torque setpoint, in place of control_allocator.
#pragma once

#include <cmath>

#include <drivers/drv_hrt.h>
#include <lib/perf/perf_counter.h>
#include <px4_platform_common/module.h>
#include <px4_platform_common/module_params.h>
#include <px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp>
#include <systemlib/mavlink_log.h>
#include <uORB/Publication.hpp>
#include <uORB/Subscription.hpp>
#include <uORB/SubscriptionCallback.hpp>
#include <uORB/SubscriptionInterval.hpp>
#include <uORB/topics/actuator_motors.h>
#include <uORB/topics/arming_check_reply.h>
#include <uORB/topics/arming_check_request.h>
#include <uORB/topics/battery_status.h>
#include <uORB/topics/control_allocator_status.h>
#include <uORB/topics/failure_detector_status.h>
#include <uORB/topics/parameter_update.h>
#include <uORB/topics/register_ext_component_reply.h>
#include <uORB/topics/register_ext_component_request.h>
#include <uORB/topics/vehicle_air_data.h>
#include <uORB/topics/vehicle_control_mode.h>
#include <uORB/topics/vehicle_thrust_setpoint.h>
#include <uORB/topics/vehicle_torque_setpoint.h>

#include "isae_x8.h"

class CoaxialMixer;

// PX4 has two forms of ModuleBase: a template, and since February 2026 a plain class with a descriptor per module.
// CMakeLists.txt looks which one it is.
#ifdef MODULE_BASE_HAS_DESCRIPTOR
using Module = ModuleBase;
#else
using Module = ModuleBase<CoaxialMixer>;
#endif

using namespace time_literals;

class CoaxialMixer : public Module, public ModuleParams, public px4::ScheduledWorkItem
{
public:
#ifdef MODULE_BASE_HAS_DESCRIPTOR
	static Descriptor desc;
#endif

	CoaxialMixer();
	~CoaxialMixer() override;

	static int task_spawn(int argc, char *argv[]);
	static int custom_command(int argc, char *argv[]);
	static int print_usage(const char *reason = nullptr);
	int print_status() override;

private:
	void Run() override;
	void cycle();
	using Text = char[100];

	void compare_parameters(Text &first);
	void tell_change();
	void expect(Text &first, const char *name, float value, float of_airframe);
	const char *refusal();
	const char *outside();
	void answer_arming_check();
	void tell_voltage();
	void update_conditions();
	void update_failed(const mixer_wrench_t &setpoint);
	bool mix_setpoint(const vehicle_torque_setpoint_s &torque);
	int mix(const mixer_wrench_t &setpoint, isae_x8_mix_t &out) const;
	int mix_in_flight(const mixer_wrench_t &setpoint, hrt_abstime sample, isae_x8_mix_t &out);
	bool is_displaced();
	void publish_motors(const float *throttle, hrt_abstime timestamp_sample);
	void publish_status(const mixer_wrench_t &setpoint, const isae_x8_mix_t &mix);

	// Without a usable setpoint for so long, the motors stop. PX4 takes as long to leave a gyroscope that is silent.
	static constexpr hrt_abstime PATIENCE = 500_ms;
	// As control_allocator: where no setpoint comes, and between two messages of status.
	static constexpr uint32_t BACKUP_SCHEDULE = 50_ms;
	static constexpr hrt_abstime STATUS_INTERVAL = 5_ms;
	// Of the low-pass on the battery's voltage: a step of thrust must not change the throttles by its own sag at once.
	static constexpr float VOLTAGE_TIME_CONSTANT_S = 0.1f;
	// Error of a measured voltage, as a share: only what is further out is told.
	static constexpr float VOLTAGE_ERROR = 0.01f;
	// More rotors than these are not believed to be dead: the mixer is tested with up to two out.
	static constexpr int MOST_OUT = 2;
	static constexpr uint16_t ALL_ROTORS = (1u << ISAE_X8_CHANNELS) - 1;

	uORB::SubscriptionCallbackWorkItem _torque_sub{this, ORB_ID(vehicle_torque_setpoint)};
	uORB::SubscriptionCallbackWorkItem _arming_check_sub{this, ORB_ID(arming_check_request)};
	uORB::Subscription _registered_sub{ORB_ID(register_ext_component_reply)};
	uORB::SubscriptionInterval _parameter_update_sub{ORB_ID(parameter_update), 1_s};
	uORB::Subscription _thrust_sub{ORB_ID(vehicle_thrust_setpoint)};
	uORB::Subscription _battery_sub{ORB_ID(battery_status)};
	uORB::Subscription _air_sub{ORB_ID(vehicle_air_data)};
	uORB::Subscription _mode_sub{ORB_ID(vehicle_control_mode)};
	uORB::Subscription _failure_sub{ORB_ID(failure_detector_status)};
	// Sees what others publish: this module's own messages are taken from it at once.
	uORB::Subscription _motors_sub{ORB_ID(actuator_motors)};
	uORB::Publication<actuator_motors_s> _motors_pub{ORB_ID(actuator_motors)};
	uORB::Publication<control_allocator_status_s> _status_pub{ORB_ID(control_allocator_status)};
	uORB::Publication<register_ext_component_request_s> _register_pub{ORB_ID(register_ext_component_request)};
	uORB::Publication<arming_check_reply_s> _arming_check_pub{ORB_ID(arming_check_reply)};
	orb_advert_t _mavlink_log_pub{nullptr};
	perf_counter_t _loop_perf{perf_alloc(PC_ELAPSED, MODULE_NAME": cycle")};

	vehicle_thrust_setpoint_s _thrust{};
	vehicle_control_mode_s _mode{};
	hrt_abstime _last_mix{0};
#ifdef ISAE_X8_ROTOR_LAG_S
	// How fast the rotors turn, by what they were given.
	isae_x8_state_t _rotors{};
	hrt_abstime _last_sample{0};
#endif
	hrt_abstime _last_status{0};
	// The voltage, filtered, and the density that were measured last: until then those of the bench, which NAN stands for.
	mixer_conditions_t _conditions{ISAE_X8_REFERENCE_V, NAN};
	hrt_abstime _last_battery{0};
	// The first parameter that is of another vehicle than the library; empty where all are of this one.
	Text _mismatch{};
	// The voltage and the range that it is outside of.
	Text _outside{};
	// Whether the parameters have been compared since the last of them changed: what is changed in flight waits for its end.
	bool _is_compared{false};
	bool _told_voltage{false};
	hrt_abstime _last_told{0};
	// Of the arming check with the commander, which asks every 300 ms; -1 without one.
	int _check_id{-1};
	hrt_abstime _last_asked{0};
	// Bit k: the rotor on channel k is out, until the vehicle is disarmed.
	uint16_t _failed{0};
	// Motors that an injected failure stops: mixed for, and not driven.
	uint16_t _stopped{0};
	// What the failure detector reported last and was not believed.
	uint16_t _doubted{0};
	bool _displaced{false};
	unsigned _refused{0};
	uint32_t _saturation{0};

	DEFINE_PARAMETERS(
		(ParamInt<px4::params::CA_ROTOR_COUNT>) _param_rotor_count,
		(ParamInt<px4::params::CA_FAILURE_MODE>) _param_failure_mode,
		(ParamFloat<px4::params::THR_MDL_FAC>) _param_thrust_curve,
		(ParamBool<px4::params::MC_BAT_SCALE_EN>) _param_battery_scale
	)
};
