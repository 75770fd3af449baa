// PX4's control allocation by a compiled coaxial mixer: runs after every torque setpoint, in place of control_allocator.
#pragma once

#include <cmath>

#include <drivers/drv_hrt.h>
#include <parameters/param.h>
#include <px4_platform_common/module.h>
#include <px4_platform_common/px4_work_queue/WorkItem.hpp>
#include <uORB/Publication.hpp>
#include <uORB/Subscription.hpp>
#include <uORB/SubscriptionCallback.hpp>
#include <uORB/topics/actuator_motors.h>
#include <uORB/topics/battery_status.h>
#include <uORB/topics/control_allocator_status.h>
#include <uORB/topics/failure_detector_status.h>
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

class CoaxialMixer : public Module, public px4::WorkItem
{
public:
#ifdef MODULE_BASE_HAS_DESCRIPTOR
	static Descriptor desc;
#endif

	CoaxialMixer();

	static int task_spawn(int argc, char *argv[]);
	static int custom_command(int argc, char *argv[]);
	static int print_usage(const char *reason = nullptr);
	int print_status() override;

private:
	void Run() override;
	void update_conditions();
	void update_failed(const mixer_wrench_t &setpoint);
	int mix(const mixer_wrench_t &setpoint, isae_x8_mix_t &out) const;
	bool is_displaced();
	void publish_motors(const float *throttle, hrt_abstime timestamp_sample);
	void publish_status(const mixer_wrench_t &setpoint, const isae_x8_mix_t &mix);

	// Without a usable setpoint for so long, the motors stop.
	static constexpr hrt_abstime PATIENCE_US = 100000;
	// More rotors than these are not believed to be dead: the mixer is tested with up to two out.
	static constexpr int MOST_OUT = 2;
	static constexpr uint16_t ALL_ROTORS = (1u << ISAE_X8_CHANNELS) - 1;

	uORB::SubscriptionCallbackWorkItem _torque_sub{this, ORB_ID(vehicle_torque_setpoint)};
	uORB::Subscription _thrust_sub{ORB_ID(vehicle_thrust_setpoint)};
	uORB::Subscription _battery_sub{ORB_ID(battery_status)};
	uORB::Subscription _air_sub{ORB_ID(vehicle_air_data)};
	uORB::Subscription _mode_sub{ORB_ID(vehicle_control_mode)};
	uORB::Subscription _failure_sub{ORB_ID(failure_detector_status)};
	// Sees what others publish: this module's own messages are taken from it at once.
	uORB::Subscription _motors_sub{ORB_ID(actuator_motors)};
	uORB::Publication<actuator_motors_s> _motors_pub{ORB_ID(actuator_motors)};
	uORB::Publication<control_allocator_status_s> _status_pub{ORB_ID(control_allocator_status)};

	vehicle_thrust_setpoint_s _thrust{};
	vehicle_control_mode_s _mode{};
	hrt_abstime _last_mix{0};
	// The last voltage and density that were measured: until then those of the bench, which NAN stands for.
	mixer_conditions_t _conditions{ISAE_X8_REFERENCE_V, NAN};
	// Bit k: the rotor on channel k is out, until the vehicle is disarmed.
	uint16_t _failed{0};
	// What the failure detector reported last and was not believed.
	uint16_t _doubted{0};
	bool _displaced{false};
	unsigned _refused{0};
	uint32_t _saturation{0};
};
