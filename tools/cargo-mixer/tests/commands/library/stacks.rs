//! `examples/px4`, `examples/ardupilot` and `examples/betaflight`, compiled against the declarations in `stand_ins` and
//! driven once.

use std::fs;
use std::process::Command;

use super::program::source;
use super::{Folder, library, root, run};

const WARNINGS: [&str; 3] = ["-Wall", "-Wextra", "-Werror"];

/// A flight stack's example.
struct Stack {
    /// Name of the stand-ins: `<name>.cpp` drives the example.
    name: &'static str,
    /// What `<name>.{hpp,h}` stands in for.
    headers: &'static [&'static str],
    declarations: &'static str,
    /// The example's source in its folder.
    folder: &'static str,
    source: &'static str,
    /// What the stack compiles with.
    flags: &'static [&'static [&'static str]],
}

const PX4: Stack = Stack {
    name: "px4",
    headers: &[
        "drivers/drv_hrt.h",
        "lib/perf/perf_counter.h",
        "px4_platform_common/module.h",
        "px4_platform_common/module_params.h",
        "px4_platform_common/px4_work_queue/ScheduledWorkItem.hpp",
        "systemlib/mavlink_log.h",
        "uORB/Publication.hpp",
        "uORB/Subscription.hpp",
        "uORB/SubscriptionCallback.hpp",
        "uORB/SubscriptionInterval.hpp",
        "uORB/topics/actuator_motors.h",
        "uORB/topics/arming_check_reply.h",
        "uORB/topics/arming_check_request.h",
        "uORB/topics/battery_status.h",
        "uORB/topics/control_allocator_status.h",
        "uORB/topics/failure_detector_status.h",
        "uORB/topics/parameter_update.h",
        "uORB/topics/register_ext_component_reply.h",
        "uORB/topics/register_ext_component_request.h",
        "uORB/topics/vehicle_air_data.h",
        "uORB/topics/vehicle_control_mode.h",
        "uORB/topics/vehicle_thrust_setpoint.h",
        "uORB/topics/vehicle_torque_setpoint.h",
    ],
    declarations: "px4.hpp",
    folder: "examples/px4/src/modules/coaxial_mixer",
    source: "CoaxialMixer.cpp",
    flags: &[
        &["-std=gnu++14"],
        &["-std=gnu++20"],
        &["-std=gnu++17", "-DMODULE_BASE_HAS_DESCRIPTOR"],
    ],
};

const ARDUPILOT: Stack = Stack {
    name: "ardupilot",
    headers: &[
        "AP_Baro/AP_Baro.h",
        "AP_BattMonitor/AP_BattMonitor.h",
        "AP_HAL/AP_HAL.h",
        "AP_Motors/AP_MotorsMatrix.h",
        "AP_Motors_config.h",
        "AP_Vehicle/AP_Vehicle_Type.h",
        "Filter/LowPassFilter.h",
        "GCS_MAVLink/GCS.h",
    ],
    declarations: "ardupilot.h",
    folder: "examples/ardupilot",
    source: "AP_MotorsCoaxialMixer.cpp",
    flags: &[
        &["-std=gnu++11", "-DAPM_BUILD_DIRECTORY=2"],
        &["-std=gnu++17", "-DAPM_BUILD_DIRECTORY=2"],
    ],
};

const BETAFLIGHT: Stack = Stack {
    name: "betaflight",
    headers: &[
        "platform.h",
        "build/version.h",
        "common/filter.h",
        "common/maths.h",
        "common/utils.h",
        "config/config.h",
        "drivers/dshot.h",
        "drivers/motor.h",
        "fc/rc_modes.h",
        "fc/runtime_config.h",
        "flight/isae_x8.h",
        "flight/mixer.h",
        "flight/mixer_coaxial.h",
        "flight/mixer_init.h",
        "flight/pid.h",
        "pg/motor.h",
        "sensors/barometer.h",
        "sensors/battery.h",
        "sensors/sensors.h",
    ],
    declarations: "betaflight.h",
    folder: "examples/betaflight",
    source: "mixer_coaxial.c",
    flags: &[&["-std=gnu++20"]],
};

impl Stack {
    fn drive(&self) {
        let folder = Folder::new(self.name);
        let stand_ins = source("stand_ins");
        let airframe = folder.join("isae-x8.toml");
        let air = "[air]\nreference_density_kg_m3 = 1.225\nrange_kg_m3 = [0.75, 1.40]\n";
        let text = fs::read_to_string(root().join("airframes/isae-x8.toml")).unwrap();
        fs::write(&airframe, format!("{text}\n{air}")).unwrap();
        let arguments = [airframe.to_str().unwrap(), "--health"];
        run(&mut library(&arguments, &folder.join("lib")));
        // With the rotors' lag the same file calls other functions.
        let vehicle = "[vehicle]\nmass_kg = 3.2\nrotor_lag_s = 0.05\n";
        fs::write(&airframe, format!("{text}\n{air}{vehicle}")).unwrap();
        let arguments = [airframe.to_str().unwrap(), "--health", "--dynamic"];
        run(&mut library(&arguments, &folder.join("dynamic")));
        for header in self.headers {
            let path = folder.join("include").join(header);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            let forward = format!("#include \"{}\"\n", self.declarations);
            fs::write(path, forward).unwrap();
        }
        let example = root().join(self.folder);
        for flags in self.flags {
            let program = folder.join("drive");
            let compiler = |lib: &str| {
                let mut compiler = Command::new("g++");
                compiler.args(WARNINGS).args(*flags);
                for include in [&folder.join("include"), &folder.join(lib), &stand_ins, &example] {
                    compiler.arg("-I").arg(include);
                }
                compiler.arg(example.join(self.source));
                compiler
            };
            let object = folder.join("dynamic.o");
            run(compiler("dynamic").arg("-c").arg("-o").arg(&object));
            let symbols = run(Command::new("nm").arg("-u").arg(&object)).stdout;
            let calls = String::from_utf8(symbols).unwrap();
            assert!(calls.contains("isae_x8_mix_dynamic"), "{calls}");
            let mut compiler = compiler("lib");
            compiler.arg(stand_ins.join(format!("{}.cpp", self.name)));
            compiler.arg(folder.join("lib/libisae_x8.a"));
            run(compiler.arg("-o").arg(&program));
            let output = run(&mut Command::new(&program));
            let text = String::from_utf8(output.stdout).unwrap();
            assert!(text.ends_with("0 faults\n"), "{text}");
        }
    }
}

#[test]
fn the_px4_module_publishes_what_the_library_mixes() {
    PX4.drive();
}

#[test]
fn betaflights_motors_are_what_the_library_mixes() {
    BETAFLIGHT.drive();
}

#[test]
fn the_ardupilot_motors_write_what_the_library_mixes() {
    ARDUPILOT.drive();
}

/// `examples/contracts/check.py` on a page and a tree of a stack, made up.
#[test]
fn contracts_are_asked_of_a_tree() {
    let folder = Folder::new("contracts");
    let page = folder.join("page.md");
    let rows = "| counted on | file | shown by | read at |\n|---|---|---|---|\n\
                | order | `a.c` | `first();` `second( );` | 1 |\n\
                | either | `gone.c`, `a.c` | `third();` or `second();` | 1 |\n\
                | absent | `a.c` | no `third();` `first();` | 1 |\n";
    fs::write(&page, format!("# Page\n\n{rows}\nEnd.\n")).unwrap();
    let check = |source: &str| {
        fs::write(folder.join("a.c"), source).unwrap();
        let script = root().join("examples/contracts/check.py");
        let output = Command::new("python3")
            .arg(script)
            .arg(&page)
            .arg(folder.join(""))
            .output()
            .unwrap();
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    let (status, text) = check("first();\n\tsecond();\n");
    assert!(
        status == Some(0) && text.contains("3 contracts, 0 not found"),
        "{text}"
    );
    let (status, text) = check("second(); first(); third();");
    assert!(
        status == Some(1)
            && text.contains("NOT FOUND     a.c: order")
            && text.contains("holds, way 1  gone.c or a.c: either")
            && text.contains("NOT FOUND     a.c: absent"),
        "{text}"
    );
}
