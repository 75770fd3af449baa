// Stand-ins for what examples/px4 uses of PX4: our own declarations, not PX4's, enough to compile the module and to drive
// it once. Every header of PX4 that the module includes is this file.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

typedef uint64_t hrt_abstime;

namespace stand_in
{
inline hrt_abstime &now_us()
{
	static hrt_abstime time = 1000000;
	return time;
}

inline unsigned &errors()
{
	static unsigned count = 0;
	return count;
}

// What the ground station was told last.
inline char (&told())[128]
{
	static char text[128];
	return text;
}
}

namespace time_literals
{
constexpr hrt_abstime operator""_s(unsigned long long seconds) { return seconds * 1000000; }
constexpr hrt_abstime operator""_ms(unsigned long long milliseconds) { return milliseconds * 1000; }
}

typedef void *orb_advert_t;

#define mavlink_log_critical(publication, ...) ((void)(publication), snprintf(stand_in::told(), 128, __VA_ARGS__))
#define mavlink_log_warning(publication, ...) mavlink_log_critical(publication, __VA_ARGS__)

// Performance counters: cycles begun and not ended.
typedef int *perf_counter_t;
constexpr int PC_ELAPSED = 1;
inline perf_counter_t perf_alloc(int, const char *) { return new int{0}; }
inline void perf_begin(perf_counter_t counter) { ++*counter; }
inline void perf_end(perf_counter_t counter) { --*counter; }
inline void perf_print_counter(perf_counter_t counter) { printf("%d cycles under way\n", *counter); }
inline void perf_free(perf_counter_t counter) { delete counter; }

inline hrt_abstime hrt_absolute_time() { return stand_in::now_us(); }
inline hrt_abstime hrt_elapsed_time(const hrt_abstime *then) { return hrt_absolute_time() - *then; }

constexpr int PX4_OK = 0;
constexpr int PX4_ERROR = -1;

#define MODULE_NAME "coaxial_mixer"
#define __EXPORT __attribute__((visibility("default")))
#define PX4_LINE(...) (printf(__VA_ARGS__), printf("\n"))
#define PX4_INFO(...) PX4_LINE(__VA_ARGS__)
#define PX4_WARN(...) PX4_LINE(__VA_ARGS__)
#define PX4_ERR(...) (++stand_in::errors(), PX4_LINE(__VA_ARGS__))
#define PRINT_MODULE_DESCRIPTION(text) PX4_LINE("%s", text)
#define PRINT_MODULE_USAGE_NAME(name, category) PX4_LINE("%s: %s", category, name)
#define PRINT_MODULE_USAGE_COMMAND(name) PX4_LINE("%s", name)
#define PRINT_MODULE_USAGE_DEFAULT_COMMANDS() PX4_LINE("stop, status")

struct actuator_motors_s {
	static constexpr uint8_t NUM_CONTROLS = 12;
	uint64_t timestamp;
	uint64_t timestamp_sample;
	uint16_t reversible_flags;
	float control[12];
};

struct arming_check_reply_s {
	uint64_t timestamp;
	uint8_t request_id;
	uint8_t registration_id;
	bool can_arm_and_run;
};

struct arming_check_request_s {
	uint64_t timestamp;
	uint32_t valid_registrations_mask;
	uint8_t request_id;
};

struct battery_status_s {
	uint64_t timestamp;
	float voltage_v;
	bool connected;
};

struct control_allocator_status_s {
	static constexpr int8_t ACTUATOR_SATURATION_OK = 0;
	static constexpr int8_t ACTUATOR_SATURATION_UPPER = 2;
	static constexpr int8_t ACTUATOR_SATURATION_LOWER = -2;
	uint64_t timestamp;
	float unallocated_torque[3];
	float unallocated_thrust[3];
	int8_t actuator_saturation[16];
	uint16_t handled_motor_failure_mask;
	uint16_t motor_stop_mask;
	bool torque_setpoint_achieved;
	bool thrust_setpoint_achieved;
};

struct failure_detector_status_s {
	uint64_t timestamp;
	bool fd_motor;
	uint16_t motor_failure_mask;
	uint16_t motor_stop_mask;
};

struct parameter_update_s {
	uint64_t timestamp;
};

struct register_ext_component_reply_s {
	uint64_t timestamp;
	char name[25];
	bool success;
	int8_t arming_check_id;
};

struct register_ext_component_request_s {
	static constexpr uint16_t LATEST_PX4_ROS2_API_VERSION = 1;
	uint64_t timestamp;
	uint64_t request_id;
	uint16_t px4_ros2_api_version;
	char name[25];
	bool register_arming_check;
	bool register_mode;
};

struct vehicle_air_data_s {
	uint64_t timestamp;
	float rho;
};

struct vehicle_control_mode_s {
	uint64_t timestamp;
	bool flag_armed;
	bool flag_control_allocation_enabled;
};

// Parameters: whole ones, flags and those by name are all kept as numbers.
typedef const char *param_t;

namespace stand_in
{
inline std::map<std::string, float> &parameters()
{
	static std::map<std::string, float> all;
	return all;
}
}

inline param_t param_find(const char *name) { return stand_in::parameters().count(name) ? name : nullptr; }

inline int param_get(param_t parameter, float *value)
{
	if (!parameter) {
		return PX4_ERROR;
	}

	*value = stand_in::parameters()[parameter];
	return PX4_OK;
}

namespace px4
{
namespace params
{
struct CA_ROTOR_COUNT { static constexpr const char *NAME = "CA_ROTOR_COUNT"; };
struct CA_FAILURE_MODE { static constexpr const char *NAME = "CA_FAILURE_MODE"; };
struct THR_MDL_FAC { static constexpr const char *NAME = "THR_MDL_FAC"; };
struct MC_BAT_SCALE_EN { static constexpr const char *NAME = "MC_BAT_SCALE_EN"; };
}
}

template<class Name, class T>
class Param
{
public:
	T get() const { return _value; }
	void update() { _value = static_cast<T>(stand_in::parameters()[Name::NAME]); }

private:
	T _value{};
};

template<class Name> using ParamInt = Param<Name, int32_t>;
template<class Name> using ParamFloat = Param<Name, float>;
template<class Name> using ParamBool = Param<Name, bool>;

class ModuleParams
{
public:
	explicit ModuleParams(ModuleParams *) {}
	virtual ~ModuleParams() = default;

protected:
	// A parameter has its value from then on.
	void updateParams() { updateParamsImpl(); }
	virtual void updateParamsImpl() = 0;
};

// The four parameters of the module, each written as `(type) name`.
#define STAND_IN_REMOVE(...)
#define STAND_IN_KEEP(...) __VA_ARGS__
#define STAND_IN_NAME(parameter) STAND_IN_REMOVE parameter
#define STAND_IN_DECLARE(parameter) STAND_IN_KEEP parameter;
#define DEFINE_PARAMETERS(a, b, c, d) \
	STAND_IN_DECLARE(a) STAND_IN_DECLARE(b) STAND_IN_DECLARE(c) STAND_IN_DECLARE(d) \
	void updateParamsImpl() override \
	{ \
		STAND_IN_NAME(a).update(); \
		STAND_IN_NAME(b).update(); \
		STAND_IN_NAME(c).update(); \
		STAND_IN_NAME(d).update(); \
	}

struct vehicle_thrust_setpoint_s {
	uint64_t timestamp;
	uint64_t timestamp_sample;
	float xyz[3];
};

struct vehicle_torque_setpoint_s {
	uint64_t timestamp;
	uint64_t timestamp_sample;
	float xyz[3];
};

namespace px4
{
struct wq_config_t {
	const char *name;
};

namespace wq_configurations
{
constexpr wq_config_t rate_ctrl{"wq:rate_ctrl"};
}

// Runs at once where PX4 would queue it.
class ScheduledWorkItem
{
public:
	ScheduledWorkItem(const char *, const wq_config_t &) { stand_in_scheduled() = this; }
	virtual ~ScheduledWorkItem() { stand_in_scheduled() = nullptr; }
	void ScheduleNow() { Run(); }
	void ScheduleDelayed(uint32_t delay_us) { _due_us = hrt_absolute_time() + delay_us; }

	// Time goes on, and nothing else happens.
	static void wait_until(hrt_abstime then_us)
	{
		ScheduledWorkItem *item = stand_in_scheduled();

		while (item && item->_due_us && item->_due_us <= then_us) {
			stand_in::now_us() = item->_due_us;
			item->_due_us = 0;
			item->Run();
			item = stand_in_scheduled();
		}

		stand_in::now_us() = then_us;
	}

protected:
	virtual void Run() = 0;

private:
	static ScheduledWorkItem *&stand_in_scheduled()
	{
		static ScheduledWorkItem *only = nullptr;
		return only;
	}

	hrt_abstime _due_us{0};
};
}

struct orb_metadata {
	void *last;
	size_t size;
	unsigned generation;
	bool advertised;
	px4::ScheduledWorkItem *callback;
};

namespace stand_in
{
template<class T>
orb_metadata *topic()
{
	static T last{};
	static orb_metadata metadata{&last, sizeof(T), 0, false, nullptr};
	return &metadata;
}
}

#define ORB_ID(name) stand_in::topic<name##_s>()

inline int orb_exists(const orb_metadata *topic, int) { return topic->advertised ? PX4_OK : PX4_ERROR; }

namespace uORB
{
template<class T>
class Publication
{
public:
	explicit Publication(orb_metadata *topic) : _topic(topic) {}

	// As PX4's own: the topic is unadvertised with the publication.
	~Publication()
	{
		if (_advertised) {
			_topic->advertised = false;
		}
	}

	bool advertise()
	{
		_topic->advertised = _advertised = true;
		return true;
	}

	bool publish(const T &message)
	{
		advertise();
		memcpy(_topic->last, &message, _topic->size);
		++_topic->generation;

		if (_topic->callback) {
			_topic->callback->ScheduleNow();
		}

		return true;
	}

private:
	orb_metadata *_topic;
	bool _advertised{false};
};

class Subscription
{
public:
	explicit Subscription(orb_metadata *topic) : _topic(topic) {}

	// As in PX4, a topic that nobody advertises any more has nothing new.
	bool updated() const { return _topic->advertised && _seen != _topic->generation; }

	bool update(void *message)
	{
		if (!updated()) {
			return false;
		}

		_seen = _topic->generation;
		memcpy(message, _topic->last, _topic->size);
		return true;
	}

	bool copy(void *message)
	{
		update(message);
		memcpy(message, _topic->last, _topic->size);
		return true;
	}

protected:
	orb_metadata *_topic;
	unsigned _seen{0};
};

class SubscriptionInterval : public Subscription
{
public:
	SubscriptionInterval(orb_metadata *topic, hrt_abstime) : Subscription(topic) {}
};

class SubscriptionCallbackWorkItem : public Subscription
{
public:
	SubscriptionCallbackWorkItem(px4::ScheduledWorkItem *item, orb_metadata *topic) : Subscription(topic), _item(item) {}

	bool registerCallback()
	{
		_topic->callback = _item;
		return true;
	}

	void unregisterCallback() { _topic->callback = nullptr; }

private:
	px4::ScheduledWorkItem *_item;
};
}

constexpr int task_id_is_work_queue = -2;

#ifdef MODULE_BASE_HAS_DESCRIPTOR
// Since February 2026: a plain class, and a descriptor per module.
class ModuleBase
{
public:
	struct Descriptor {
		int (*task_spawn)(int argc, char *argv[]);
		int (*custom_command)(int argc, char *argv[]);
		int (*print_usage)(const char *reason);
		struct Object {
			ModuleBase *instance;
			void store(ModuleBase *object) { instance = object; }
		} object{nullptr};
		int task_id{-1};

		Descriptor(int (*spawn)(int, char *[]), int (*custom)(int, char *[]), int (*usage)(const char *))
			: task_spawn(spawn), custom_command(custom), print_usage(usage) {}
	};

	virtual ~ModuleBase() = default;
	virtual int print_status() = 0;

	static int main(Descriptor &module, int argc, char *argv[])
	{
		const char *command = argc > 1 ? argv[1] : "";

		if (strcmp(command, "start") == 0) {
			return module.task_spawn(argc - 1, argv + 1);

		} else if (strcmp(command, "status") == 0 && module.object.instance) {
			return module.object.instance->print_status();

		} else if (strcmp(command, "stop") == 0 && module.object.instance) {
			module.object.instance->_exit = true;
			return PX4_OK;
		}

		return module.custom_command(argc - 1, argv + 1);
	}

protected:
	bool should_exit() const { return _exit; }

	void exit_and_cleanup(Descriptor &module)
	{
		delete module.object.instance;
		module.object.store(nullptr);
	}

private:
	bool _exit{false};
};
#else
template<class T>
class ModuleBase
{
public:
	virtual ~ModuleBase() = default;
	virtual int print_status() = 0;

	static int main(int argc, char *argv[])
	{
		const char *command = argc > 1 ? argv[1] : "";

		if (strcmp(command, "start") == 0) {
			return T::task_spawn(argc - 1, argv + 1);

		} else if (strcmp(command, "status") == 0 && _object.instance) {
			return _object.instance->print_status();

		} else if (strcmp(command, "stop") == 0 && _object.instance) {
			_object.instance->_exit = true;
			return PX4_OK;
		}

		return T::custom_command(argc - 1, argv + 1);
	}

protected:
	struct Object {
		T *instance;
		void store(T *object) { instance = object; }
	};

	bool should_exit() const { return _exit; }

	void exit_and_cleanup()
	{
		delete _object.instance;
		_object.store(nullptr);
	}

	static Object _object;
	static int _task_id;

private:
	bool _exit{false};
};

template<class T> typename ModuleBase<T>::Object ModuleBase<T>::_object{nullptr};
template<class T> int ModuleBase<T>::_task_id{-1};
#endif
