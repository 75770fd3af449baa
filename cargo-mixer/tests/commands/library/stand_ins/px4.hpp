// Stand-ins for what examples/px4 uses of PX4: our own declarations, not PX4's, enough to compile the module and to drive
// it once. Every header of PX4 that the module includes is this file.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

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
}

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
	bool torque_setpoint_achieved;
	bool thrust_setpoint_achieved;
};

struct failure_detector_status_s {
	uint64_t timestamp;
	bool fd_motor;
	uint16_t motor_failure_mask;
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

// Parameters: CA_FAILURE_MODE alone.
typedef int param_t;

namespace stand_in
{
inline int32_t &failure_mode()
{
	static int32_t mode = 0;
	return mode;
}
}

inline param_t param_find(const char *name) { return strcmp(name, "CA_FAILURE_MODE") == 0 ? 1 : -1; }

inline int param_get(param_t parameter, int32_t *value)
{
	*value = stand_in::failure_mode();
	return parameter == 1 ? PX4_OK : PX4_ERROR;
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
class WorkItem
{
public:
	WorkItem(const char *, const wq_config_t &) {}
	virtual ~WorkItem() = default;
	void ScheduleNow() { Run(); }

protected:
	virtual void Run() = 0;
};
}

struct orb_metadata {
	void *last;
	size_t size;
	unsigned generation;
	bool advertised;
	px4::WorkItem *callback;
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

	bool publish(const T &message)
	{
		memcpy(_topic->last, &message, _topic->size);
		++_topic->generation;
		_topic->advertised = true;

		if (_topic->callback) {
			_topic->callback->ScheduleNow();
		}

		return true;
	}

private:
	orb_metadata *_topic;
};

class Subscription
{
public:
	explicit Subscription(orb_metadata *topic) : _topic(topic) {}

	bool update(void *message)
	{
		if (_seen == _topic->generation) {
			return false;
		}

		_seen = _topic->generation;
		memcpy(message, _topic->last, _topic->size);
		return true;
	}

protected:
	orb_metadata *_topic;
	unsigned _seen{0};
};

class SubscriptionCallbackWorkItem : public Subscription
{
public:
	SubscriptionCallbackWorkItem(px4::WorkItem *item, orb_metadata *topic) : Subscription(topic), _item(item) {}

	bool registerCallback()
	{
		_topic->callback = _item;
		return true;
	}

	void unregisterCallback() { _topic->callback = nullptr; }

private:
	px4::WorkItem *_item;
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
