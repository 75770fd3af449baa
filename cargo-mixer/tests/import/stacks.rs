//! `cargo mixer params` and `new --outputs`: what a stack is told is what it has for that frame.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;

use crate::bench_data::{folder_of_data, is_pair, numbers};
use crate::{Folder, Unit, cargo_mixer, import, outline};

/// What a command prints; it succeeds.
#[track_caller]
fn printed(arguments: &[&str]) -> String {
    let output = cargo_mixer(arguments);
    assert!(output.status.success(), "{arguments:?} {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Writes a copy of the paper's X8 with a mass.
fn with_mass(folder: &Folder) -> PathBuf {
    let text = fs::read_to_string(crate::root().join("airframes/isae-x8.toml")).unwrap();
    let text = text.replacen("[throttle]", "[vehicle]\nmass_kg = 3.2\n\n[throttle]", 1);
    folder.write("x8.toml", &text)
}

/// The value of a parameter in a file of any of the three forms.
fn value(text: &str, name: &str) -> Option<f64> {
    let words = |line: &str| -> Vec<String> {
        let separated = |c: char| c.is_whitespace() || c == ',';
        line.split(separated).map(str::to_owned).collect()
    };
    let lines = text.lines().filter(|line| !line.starts_with('#')).map(words);
    lines
        .filter_map(|words| {
            let at = words.iter().position(|word| word == name)?;
            words.get(at + 1)?.parse().ok()
        })
        .next()
}

#[test]
fn px4_parameters_describe_the_same_rotors() {
    let folder = Folder::new("params-px4");
    let airframe = with_mass(&folder);
    let airframe = airframe.to_str().unwrap();
    let text = printed(&["params", airframe, "--stack", "px4", "--pwm-range", "1070,1950"]);
    // Every line is a comment or five columns, and whole numbers have MAV_PARAM_TYPE 6.
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let columns: Vec<&str> = line.split('\t').collect();
        assert_eq!((columns.len(), columns[0], columns[1]), (5, "1", "1"), "{line}");
        assert!(["6", "9"].contains(&columns[4]), "{line}");
        assert!(columns[3].parse::<f64>().unwrap().is_finite());
    }
    assert!(text.contains("\tCA_ROTOR_COUNT\t8\t6\n") && text.contains("\tTHR_MDL_FAC\t0\t9\n"));
    let file = folder.write("a.params", &text);
    let (found, _) = import(&folder, &[&file], &["--upper", "0,1,2,3"]);
    let expected = [
        (vec![0, 4], "cw"),
        (vec![1, 5], "ccw"),
        (vec![2, 6], "cw"),
        (vec![3, 7], "ccw"),
    ];
    assert_eq!(outline(&found), expected);
    assert_eq!(found[1].position_m, [0.3182, -0.3182, 0.0]);
    // 3.2 kg of 99.1508 N.
    for (name, expected) in [
        ("THR_MDL_FAC", 0.0),
        ("MPC_THR_HOVER", 0.3165),
        ("MPC_THR_MIN", 0.12),
        ("CA_FAILURE_MODE", 1.0),
        ("FD_ACT_EN", 0.0),
        ("PWM_MAIN_MIN8", 1070.0),
        ("PWM_MAIN_MAX1", 1950.0),
    ] {
        assert_eq!(value(&text, name), Some(expected), "{name}");
    }
}

/// CT and KM: alike they give the header's units, by their slopes those of the map in hover.
#[test]
fn rotors_of_px4_give_its_unit_of_yaw() {
    let folder = Folder::new("params-km");
    let airframe = with_mass(&folder);
    let airframe = airframe.to_str().unwrap();
    let summary: Json = serde_json::from_str(&printed(&["check", "--json", airframe])).unwrap();
    let yaw_nm = summary["normalised"]["yaw_nm"].as_f64().unwrap();
    let constants = |options: &[&str], rotor: usize| {
        let arguments = [&["params", airframe, "--stack", "px4", "--own"], options].concat();
        let text = printed(&arguments);
        ["CT", "KM"].map(|key| value(&text, &format!("CA_ROTOR{rotor}_{key}")).unwrap())
    };
    let alike: f64 = (0..8)
        .map(|rotor| {
            let [thrust, moment] = constants(&[], rotor);
            (thrust * moment).abs()
        })
        .sum();
    assert!((alike / yaw_nm - 1.0).abs() < 1e-3, "{alike} {yaw_nm}");
    // At equal throttles the lower rotor of a pair gives less for more throttle than the upper one.
    let [upper, lower] = [0, 4].map(|rotor| constants(&["--slopes"], rotor));
    assert!(
        lower[0] < upper[0] && upper[1] < 0.0 && lower[1] > 0.0,
        "{upper:?} {lower:?}"
    );
}

#[test]
fn the_simulator_gets_a_script_and_what_runs_after_it() {
    let folder = Folder::new("params-airframe");
    let airframe = with_mass(&folder);
    let script = folder.0.join("22000_x8");
    let arguments = [
        "params",
        airframe.to_str().unwrap(),
        "--stack",
        "px4",
        "--format",
        "airframe",
    ];
    // Two files do not fit on stdout.
    assert_eq!(cargo_mixer(&arguments).status.code(), Some(1));
    printed(&[&arguments[..], &["-o", script.to_str().unwrap()]].concat());
    let text = fs::read_to_string(&script).unwrap();
    assert!(text.starts_with("#!/bin/sh\n#\n# @name isae-x8\n"), "{text}");
    let defaults = text.find("\n. ${R}etc/init.d/rc.mc_defaults\n").unwrap();
    assert!(defaults < text.find("param set-default CA_AIRFRAME 0").unwrap());
    assert!(text.contains("\nparam set-default PWM_MAIN_FUNC8 108\n") && !text.contains("PWM_MAIN_MIN"));
    // PX4 reports 1 A + 15 A x output there: no healthy motor is found dead at any output.
    let limit = |name: &str| value(&text, name).unwrap();
    assert_eq!(limit("FD_ACT_EN"), 1.0);
    for output in [0.0, 0.2, 0.55, 1.0] {
        let (current, scale) = (1.0 + 15.0 * output, limit("FD_ACT_MOT_C2T"));
        assert!(current > scale * output - limit("FD_ACT_LOW_OFF") + 1.0);
        assert!(current < scale * output + limit("FD_ACT_HIGH_OFF") - 1.0);
    }
    assert_eq!((limit("SYS_FAILURE_EN"), limit("SIM_BAT_ENABLE")), (1.0, 0.0));
    let after = fs::read_to_string(folder.0.join("22000_x8.post")).unwrap();
    assert!(after.ends_with("\ncontrol_allocator stop\ncoaxial_mixer start\n"));
    // Neither is overwritten by accident.
    fs::remove_file(&script).unwrap();
    let again = [&arguments[..], &["-o", script.to_str().unwrap()]].concat();
    assert_eq!(cargo_mixer(&again).status.code(), Some(1));
    assert!(!script.exists());
    for file in [&script, &folder.0.join("22000_x8.post")] {
        if file.exists() {
            let shell = std::process::Command::new("sh")
                .arg("-n")
                .arg(file)
                .status()
                .unwrap();
            assert!(shell.success());
        }
    }
    // Its own allocator needs no module.
    let own = folder.0.join("22001_x8");
    printed(&[&arguments[..], &["--own", "-o", own.to_str().unwrap()]].concat());
    assert!(!folder.0.join("22001_x8.post").exists());
    let factor = value(&fs::read_to_string(own).unwrap(), "THR_MDL_FAC").unwrap();
    assert!((0.5..=1.0).contains(&factor), "{factor}");
}

#[test]
fn what_cannot_be_known_is_said() {
    let output = cargo_mixer(&["params", "airframes/isae-x8.toml", "--stack", "ardupilot"]);
    let said = String::from_utf8(output.stderr).unwrap();
    for part in [
        "MOT_THST_HOVER is missing",
        "no FRAME_CLASS",
        "`airmode = \"roll-pitch\"` in the airframe file",
        "MOT_PWM_MIN and MOT_PWM_MAX are missing",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let folder = Folder::new("params-idle");
    let text = fs::read_to_string(crate::root().join("airframes/isae-x8.toml")).unwrap();
    let high = folder.write("high.toml", &text.replacen("min = 0.10", "min = 0.34", 1));
    let arguments = ["params", high.to_str().unwrap(), "--stack", "ardupilot"];
    let output = cargo_mixer(&arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("does not arm with MOT_SPIN_MIN above 0.3"),
        "{said}"
    );
    let text = printed(&arguments);
    assert_eq!(value(&text, "MOT_SPIN_MIN"), Some(0.3));
    // ArduPilot reads lines in pieces of 98 bytes: the rest of a longer comment would be a parameter.
    let longest = text.lines().map(str::len).max().unwrap();
    assert!((80..=98).contains(&longest), "{longest}: {text}");
    for options in [["--slopes", "--own"], ["--format", "airframe"]] {
        assert_eq!(
            cargo_mixer(&[&arguments[..], &options].concat()).status.code(),
            Some(1)
        );
    }
}

/// Channels, spins and places of `new --outputs` in the order of the first channel.
fn new_frame(folder: &Folder, frame: &str, stack: &str) -> (PathBuf, String) {
    let file = folder.0.join(format!("{frame}-{stack}.toml"));
    let arguments = ["new", "--frame", frame, "--arm", "1", "--outputs", stack, "-o"];
    printed(&[&arguments[..], &[file.to_str().unwrap()]].concat());
    let text = fs::read_to_string(&file).unwrap();
    (file, text)
}

#[test]
fn new_has_no_outputs_of_frames_that_no_stack_has() {
    for frame in [&["single"][..], &["bicopter", "--arm", "1"]] {
        let arguments = [&["new", "-o", "/dev/null", "--outputs", "px4", "--frame"], frame].concat();
        assert_eq!(cargo_mixer(&arguments).status.code(), Some(2), "{frame:?}");
    }
}

/// The units of a frame that `new` writes, as `params` has them for PX4.
fn of_px4(folder: &Folder, airframe: &Path, upper: &str) -> Vec<crate::Unit> {
    let text = printed(&["params", airframe.to_str().unwrap(), "--stack", "px4"]);
    let file = folder.write("new.params", &text);
    import(folder, &[&file], &["--upper", upper]).0
}

#[test]
fn new_frames_are_those_of_the_stacks_tables() {
    let Some(data) = folder_of_data("new_frames_are_those_of_the_stacks_tables") else {
        return;
    };
    let folder = Folder::new("new-outputs");
    // PX4: place, spin and outputs of every unit are those of its own geometry files.
    let geometry = |names: &[&str]| {
        let files: Vec<PathBuf> = names.iter().map(|name| data.join("px4").join(name)).collect();
        let files: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        import(&folder, &files, &[]).0
    };
    let octa = geometry(&["octa_cox.toml"]);
    let dodeca = geometry(&["dodeca_top_cox.toml", "dodeca_bottom_cox.toml"]);
    for (frame, upper, expected) in [("x8", "0,1,2,3", octa), ("x12", "0,1,2,3,4,5", dodeca)] {
        let (file, _) = new_frame(&folder, frame, "px4");
        let found = of_px4(&folder, &file, upper);
        assert_eq!(outline(&found), outline(&expected), "{frame}");
        for (unit, expected) in found.iter().zip(&expected) {
            for (x, y) in unit.position_m.iter().zip(&expected.position_m).take(2) {
                assert!((x - y).abs() < 0.01, "{frame}: {unit:?} {expected:?}");
            }
        }
    }
    // ArduPilot: `params` knows the frame by its numbers, which the table then confirms.
    let text = fs::read_to_string(data.join("ardupilot/coax_frames.json")).unwrap();
    let table: Json = serde_json::from_str(&text).unwrap();
    for (frame, expected) in [("x8", (4, 1)), ("y6", (5, 10)), ("x12", (12, 1))] {
        let (file, text) = new_frame(&folder, frame, "ardupilot");
        assert!(text.contains("airmode = \"roll-pitch\""), "{text}");
        let params = printed(&["params", file.to_str().unwrap(), "--stack", "ardupilot"]);
        let numbers_of = ["FRAME_CLASS", "FRAME_TYPE"].map(|name| value(&params, name).unwrap());
        assert_eq!(numbers_of, [f64::from(expected.0), f64::from(expected.1)]);
        let frames = table["frames"].as_array().unwrap();
        let known = frames.iter().find(|frame| numbers(frame) == expected).unwrap();
        let count = known["motors"].as_array().unwrap().len();
        let upper: Vec<String> = known["pairs_top_bottom"]
            .as_array()
            .unwrap()
            .iter()
            .map(|pair| (pair[0].as_i64().unwrap() - 1).to_string())
            .collect();
        let units = of_px4(&folder, &file, &upper.join(","));
        assert_eq!(2 * units.len(), count);
        for pair in known["pairs_top_bottom"].as_array().unwrap() {
            assert!(
                units.iter().any(|unit| is_pair(unit, known, pair)),
                "{frame} {pair} {units:?}"
            );
        }
    }
}

/// One unit of PX4's setpoints: where the rows of the effectiveness B are orthogonal, B+ is
/// b / sum b^2 by axis, PX4's scale of roll and pitch is sqrt(sum / (non-zero / 2)), and that of yaw
/// the largest entry.
fn assert_units_of_px4(name: &str, units: &[Unit], airframe: &str) {
    let checked = printed(&["check", "--json", airframe]);
    let summary: Json = serde_json::from_str(&checked).unwrap();
    let unit = |key: &str| summary["normalised"][key].as_f64().unwrap();
    let rotors = 2 * units.len();
    let thrust_n = unit("thrust_n") / rotors as f64;
    let of_axis = |axis: usize| {
        let rows = units.iter().map(|unit| thrust_n * unit.position_m[axis]);
        let rows: Vec<f64> = rows.filter(|b| b.abs() > 1e-9).collect();
        let squares = 2.0 * rows.iter().map(|b| b * b).sum::<f64>();
        // Two rotors a unit, half of them.
        (squares * rows.len() as f64).sqrt()
    };
    let roll_pitch = of_axis(0).min(of_axis(1));
    let own = printed(&["params", airframe, "--stack", "px4", "--own"]);
    let moment = |channel: usize| value(&own, &format!("CA_ROTOR{channel}_KM")).unwrap().abs();
    let yaw = thrust_n * (0..rotors).map(moment).sum::<f64>();
    // The parameters have four digits.
    for (key, expected, tolerance) in [
        ("roll_nm", roll_pitch, 1e-4),
        ("pitch_nm", roll_pitch, 1e-4),
        ("yaw_nm", yaw, 2e-3),
    ] {
        let ratio = unit(key) / expected;
        assert!(
            (ratio - 1.0).abs() < tolerance,
            "{name} {key}: {} {expected}",
            unit(key)
        );
    }
}

#[test]
fn px4_units_are_those_of_its_geometries() {
    let Some(data) = folder_of_data("px4_units_are_those_of_its_geometries") else {
        return;
    };
    let folder = Folder::new("px4-units");
    let airframe = folder.0.join("airframe.toml");
    for names in [
        &["octa_cox.toml"][..],
        &["dodeca_top_cox.toml", "dodeca_bottom_cox.toml"],
    ] {
        let files: Vec<PathBuf> = names.iter().map(|name| data.join("px4").join(name)).collect();
        let files: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        let (units, _) = import(&folder, &files, &[]);
        assert_units_of_px4(names[0], &units, airframe.to_str().unwrap());
    }
}

/// A motor's roll, pitch and yaw factors as ArduPilot's table has them, before its normalisation.
fn factors(motor: &Json) -> [f64; 3] {
    let yaw = match motor["spin"].as_str().unwrap() {
        "CCW" => 1.0,
        "CW" => -1.0,
        factor => factor.parse().unwrap(),
    };
    match motor["angle_deg"].as_f64() {
        Some(angle) => {
            let angle = angle.to_radians();
            [
                libm::cos(angle + std::f64::consts::FRAC_PI_2),
                libm::cos(angle),
                yaw,
            ]
        }
        None => ["roll_fac", "pitch_fac"]
            .map(|key| motor[key].as_f64().unwrap())
            .into_iter()
            .chain([yaw])
            .collect::<Vec<_>>()
            .try_into()
            .unwrap(),
    }
}

/// One unit of ArduPilot's inputs by its own tables: sum over the motors of what it multiplies the
/// input by and of what the motor gives; and the frame's numbers are found again.
#[test]
fn ardupilot_units_are_those_of_its_tables() {
    let Some(data) = folder_of_data("ardupilot_units_are_those_of_its_tables") else {
        return;
    };
    let folder = Folder::new("ardupilot-units");
    let text = fs::read_to_string(data.join("ardupilot/coax_frames.json")).unwrap();
    let table: Json = serde_json::from_str(&text).unwrap();
    let mut seen = Vec::new();
    for frame in table["frames"].as_array().unwrap() {
        let (class, kind) = numbers(frame);
        // Both rotors of an arm turn the same way.
        if kind == 20 || kind == 21 {
            continue;
        }
        seen.push((class, kind));
        let name = format!("{} {}", frame["frame_class"], frame["frame_type"]);
        let file = folder.write("a.param", &format!("FRAME_CLASS,{class}\nFRAME_TYPE,{kind}\n"));
        let (units, _) = import(&folder, &[&file], &["--arm", "0.45"]);
        let airframe = folder.0.join("airframe.toml");
        let airframe = airframe.to_str().unwrap();
        // PX4 has no files of +, H and Y6 frames in the data: its formulas on the same places.
        assert_units_of_px4(&name, &units, airframe);
        let summary: Json = serde_json::from_str(&printed(&["check", "--json", airframe])).unwrap();
        let unit = |key: &str| summary["normalised_ardupilot"][key].as_f64().unwrap();
        let motors = frame["motors"].as_array().unwrap();
        let factors: Vec<[f64; 3]> = motors.iter().map(factors).collect();
        let largest = |axis: usize| factors.iter().fold(0.0, |most: f64, f| most.max(f[axis].abs()));
        let thrust_n = unit("thrust_n") / motors.len() as f64;
        let own = printed(&["params", airframe, "--stack", "px4", "--own"]);
        let lever = |channel: usize, key: &str| value(&own, &format!("CA_ROTOR{channel}_{key}")).unwrap();
        let sum = |axis: usize, part: &dyn Fn(usize) -> f64| -> f64 {
            let terms = factors
                .iter()
                .zip(0..)
                .map(|(factors, channel)| 0.5 * factors[axis] / largest(axis) * part(channel));
            terms.sum()
        };
        let expected = [
            ("roll_nm", sum(0, &|channel| -thrust_n * lever(channel, "PY"))),
            ("pitch_nm", sum(1, &|channel| thrust_n * lever(channel, "PX"))),
        ];
        for (key, expected) in expected {
            assert!(
                (unit(key) / expected - 1.0).abs() < 2e-3,
                "{name} {key}: {} {expected}",
                unit(key)
            );
        }
        // Half of every motor's torque; V has other yaw factors, which an airframe does not show.
        let moment = (0..motors.len())
            .map(|channel| lever(channel, "KM").abs())
            .sum::<f64>();
        let yaw_nm = 0.5 * thrust_n * moment;
        assert!(
            (unit("yaw_nm") / yaw_nm - 1.0).abs() < 2e-3,
            "{name}: {} {yaw_nm}",
            unit("yaw_nm")
        );
        let params = printed(&["params", airframe, "--stack", "ardupilot"]);
        let found = ["FRAME_CLASS", "FRAME_TYPE"].map(|name| value(&params, name));
        let kind = if (class, kind) == (4, 2) { 1 } else { kind };
        assert_eq!(found, [Some(f64::from(class)), Some(f64::from(kind))], "{name}");
    }
    // X8 in + and X and H, Y6 A and B, X12 in + and X.
    for frame in [(4, 0), (4, 1), (4, 3), (5, 1), (5, 10), (12, 0), (12, 1)] {
        assert!(seen.contains(&frame), "{frame:?} is not in the tables");
    }
}

/// The airframe is an input, with `--force` too.
#[test]
fn parameters_spare_the_airframe() {
    let folder = Folder::new("params-over-airframe");
    let airframe = with_mass(&folder);
    let before = fs::read(&airframe).unwrap();
    let path = airframe.to_str().unwrap();
    let output = cargo_mixer(&["params", path, "--stack", "px4", "-o", path, "--force"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert_eq!(fs::read(&airframe).unwrap(), before);
}
