//! Frames of flight stacks: `import`, `params` and `new --outputs` against PX4's formulas, and, in
//! `MIXER_BENCH_DATA`, against PX4's files and ArduPilot's frame tables. None of them is part of the
//! project.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;
use toml::{Table, Value};

use crate::{bench_data, folder, run, stderr};

/// A unit of an airframe file.
#[derive(Debug, PartialEq)]
struct Unit {
    position_m: Vec<f64>,
    upper_spin: String,
    channels: Vec<i64>,
}

/// Imports `files` into `folder`, has the airframe checked, and returns its units and the file.
#[track_caller]
fn import(folder: &Path, files: &[&Path], options: &[&str]) -> (Vec<Unit>, String) {
    let airframe = folder.join("airframe.toml");
    let output = airframe.display().to_string();
    let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    let mut arguments = vec![
        "import",
        "--pair",
        "airframes/isae-x8.toml",
        "--force",
        "-o",
        &output,
    ];
    arguments.extend(files.iter().map(String::as_str));
    arguments.extend(options);
    let imported = run(&arguments);
    assert!(imported.status.success(), "{imported:?}");
    let checked = run(&["check", &output]);
    assert!(checked.status.success(), "{checked:?}");
    let text = fs::read_to_string(airframe).unwrap();
    (units(&text), text)
}

fn units(text: &str) -> Vec<Unit> {
    let table: Table = text.parse().unwrap();
    let unit = |unit: &Value| Unit {
        position_m: floats(&unit["position_m"]),
        upper_spin: unit["upper_spin"].as_str().unwrap().to_owned(),
        channels: unit["channels"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| c.as_integer().unwrap())
            .collect(),
    };
    table["unit"].as_array().unwrap().iter().map(unit).collect()
}

fn floats(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_float().unwrap())
        .collect()
}

/// Channels and upper spin of every unit.
fn outline(units: &[Unit]) -> Vec<(Vec<i64>, &str)> {
    units
        .iter()
        .map(|unit| (unit.channels.clone(), unit.upper_spin.as_str()))
        .collect()
}

/// What a refusal says; nothing is written.
#[track_caller]
fn refused(file: &Path, options: &[&str]) -> String {
    let arguments = [&["import", file.to_str().unwrap(), "-o", "never.toml"], options].concat();
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    stderr(&output).to_owned()
}

/// Writes a file of the folder.
fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

/// What a command prints; it succeeds.
#[track_caller]
fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?} {output:?}");
    String::from_utf8(output.stdout).unwrap()
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

/// PX4's octa_cox: pairs (0, 5), (1, 4), (2, 7), (3, 6).
fn octa_cox() -> Vec<(Vec<i64>, &'static str)> {
    vec![
        (vec![0, 5], "ccw"),
        (vec![1, 4], "cw"),
        (vec![2, 7], "ccw"),
        (vec![3, 6], "cw"),
    ]
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn px4_files_give_their_frames() {
    let data = bench_data();
    let folder = folder("px4-data");
    let file = |name: &str| data.join("px4").join(name);
    let (units, _) = import(&folder, &[&file("CONSTRUCTED_octo_cox_qgc.params")], &[]);
    assert_eq!(outline(&units), octa_cox());
    let expected = [
        [0.1905, 0.1905],
        [0.1905, -0.1905],
        [-0.1905, -0.1905],
        [-0.1905, 0.1905],
    ];
    for (unit, expected) in units.iter().zip(expected) {
        assert_eq!(unit.position_m[..2], expected);
    }
    let geometry = |names: &[&str]| import(&folder, &[&parameters(&folder, &data, names)], &[]).0;
    assert_eq!(outline(&geometry(&["octa_cox.toml"])), octa_cox());
    let units = geometry(&["dodeca_top_cox.toml", "dodeca_bottom_cox.toml"]);
    let spins = ["cw", "ccw", "cw", "ccw", "ccw", "cw"];
    let expected: Vec<_> = spins
        .into_iter()
        .zip(0..)
        .map(|(spin, k)| (vec![k, 6 + k], spin))
        .collect();
    assert_eq!(outline(&units), expected);
    for name in [
        "REAL_excerpt_flight1_v1.12.3.params",
        "REAL_excerpt_stable_old.params",
    ] {
        assert!(refused(&file(name), &[]).contains("no rotors"));
    }
}

/// FRAME_CLASS and FRAME_TYPE by ArduPilot's names.
fn numbers(frame: &Json) -> (u32, u32) {
    let class = match frame["frame_class"].as_str().unwrap() {
        "OCTAQUAD" => 4,
        "Y6" => 5,
        "DODECAHEXA" => 12,
        other => panic!("{other}"),
    };
    let kind = match frame["frame_type"].as_str().unwrap() {
        "PLUS" => 0,
        "X" | "Y6A(default)" => 1,
        "V" => 2,
        "H" => 3,
        "Y6B" => 10,
        "Y6F" => 11,
        "BF_X" => 12,
        "CW_X" => 14,
        "BF_X_REV" => 18,
        "X_COR" => 20,
        "CW_X_COR" => 21,
        other => panic!("{other}"),
    };
    (class, kind)
}

/// Whether a unit is the pair of these motors: outputs, spin, and where it is.
fn is_pair(unit: &Unit, frame: &Json, motors: &Json) -> bool {
    let all = frame["motors"].as_array().unwrap();
    let numbers = [0, 1].map(|k| motors[k].as_i64().unwrap());
    let upper = all.iter().find(|motor| motor["motor"] == numbers[0]).unwrap();
    // A spin, or a yaw factor, positive counter-clockwise.
    let spin = match upper["spin"].as_str().unwrap() {
        "CCW" => "ccw",
        "CW" => "cw",
        factor if factor.starts_with('+') => "ccw",
        _ => "cw",
    };
    let [x, y] = [unit.position_m[0], unit.position_m[1]];
    let is_there = match upper["angle_deg"].as_f64() {
        Some(angle) => {
            let turn = (libm::atan2(y, x).to_degrees() - angle).rem_euclid(360.0);
            turn.min(360.0 - turn) < 0.1
        }
        // Roll is positive to the left, pitch to the front; a factor of 0 is on the axis.
        None => {
            let factor = |key: &str| upper[key].as_f64().unwrap();
            let same = |factor: f64, place: f64| (factor == 0.0) == (place == 0.0) && factor * place >= 0.0;
            same(-factor("roll_fac"), y) && same(factor("pitch_fac"), x)
        }
    };
    unit.channels == numbers.map(|motor| motor - 1) && unit.upper_spin == spin && is_there
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn ardupilot_tables_give_their_frames() {
    let data = bench_data();
    let folder = folder("ardupilot-data");
    let text = fs::read_to_string(data.join("ardupilot/coax_frames.json")).unwrap();
    let table: Json = serde_json::from_str(&text).unwrap();
    let frames = table["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 14);
    for frame in frames {
        let (class, kind) = numbers(frame);
        let name = format!("{} {}", frame["frame_class"], frame["frame_type"]);
        let file = write(
            &folder,
            "a.param",
            &format!("FRAME_CLASS,{class}\nFRAME_TYPE,{kind}\n"),
        );
        if kind == 20 || kind == 21 {
            assert!(refused(&file, &["--arm", "0.45"]).contains("turn the same way"));
            continue;
        }
        let (units, _) = import(&folder, &[Path::new(&file)], &["--arm", "0.45"]);
        let pairs = frame["pairs_top_bottom"].as_array().unwrap();
        assert_eq!(units.len(), pairs.len(), "{name}");
        for pair in pairs {
            assert!(
                units.iter().any(|unit| is_pair(unit, frame, pair)),
                "{name}: {pair} {units:?}"
            );
        }
    }
}

/// Channels, spins and places of `new --outputs` in the order of the first channel.
fn new_frame(folder: &Path, frame: &str, stack: &str) -> (PathBuf, String) {
    let file = folder.join(format!("{frame}-{stack}.toml"));
    let arguments = ["new", "--frame", frame, "--arm", "1", "--outputs", stack, "-o"];
    printed(&[&arguments[..], &[file.to_str().unwrap()]].concat());
    let text = fs::read_to_string(&file).unwrap();
    (file, text)
}

/// PX4's geometry files, a layer each, as its parameters.
fn parameters(folder: &Path, data: &Path, names: &[&str]) -> PathBuf {
    let mut rotors = Vec::new();
    for name in names {
        let text = fs::read_to_string(data.join("px4").join(name)).unwrap();
        rotors.extend(
            text.parse::<Table>().unwrap()["rotors"]
                .as_array()
                .unwrap()
                .clone(),
        );
    }
    let mut text = format!("CA_ROTOR_COUNT,{}\n", rotors.len());
    for (k, rotor) in rotors.iter().enumerate() {
        for (key, x) in ["PX", "PY", "PZ"].iter().zip(floats(&rotor["position"])) {
            text += &format!("CA_ROTOR{k}_{key},{x}\n");
        }
        let sign = if rotor["direction"].as_str() == Some("CCW") {
            ""
        } else {
            "-"
        };
        text += &format!("CA_ROTOR{k}_KM,{sign}0.05\n");
    }
    write(folder, "geometry.params", &text)
}

/// The units of a frame that `new` writes, as `params` has them for PX4.
fn of_px4(folder: &Path, airframe: &Path, upper: &str) -> Vec<Unit> {
    let text = printed(&["params", airframe.to_str().unwrap(), "--stack", "px4"]);
    let file = write(folder, "new.params", &text);
    import(folder, &[&file], &["--upper", upper]).0
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn new_frames_are_those_of_the_stacks_tables() {
    let data = bench_data();
    let folder = folder("new-outputs");
    // PX4: place, spin and outputs of every unit are those of its own geometry files.
    let geometry = |names: &[&str]| import(&folder, &[&parameters(&folder, &data, names)], &[]).0;
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
        let params = printed(&["params", file.to_str().unwrap(), "--stack", "ardupilot", "--own"]);
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

/// Roll, pitch, yaw (N m) and thrust (N) of setpoints of 1, as `params` states them.
fn setpoint_of_one(airframe: &str, stack: &str) -> [f64; 4] {
    let told = printed(&["params", airframe, "--stack", stack]);
    let (_, told) = told.split_once("# A setpoint of 1 is ").expect("the scale");
    let words = told.lines().next().unwrap_or_default().split([' ', ',']);
    let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().expect("four numbers")
}

/// One unit of PX4's setpoints: where the rows of the effectiveness B are orthogonal, B+ is
/// b / sum b^2 by axis, PX4's scale of roll and pitch is sqrt(sum / (non-zero / 2)), and that of yaw
/// the largest entry.
fn assert_units_of_px4(name: &str, units: &[Unit], airframe: &str) {
    let unit = setpoint_of_one(airframe, "px4");
    let rotors = 2 * units.len();
    let thrust_n = unit[3] / rotors as f64;
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
    let expected = [(roll_pitch, 1e-4), (roll_pitch, 1e-4), (yaw, 2e-3)];
    for (given, (expected, tolerance)) in unit.iter().zip(expected) {
        assert!(
            (given / expected - 1.0).abs() < tolerance,
            "{name}: {given} {expected}"
        );
    }
}

#[test]
fn px4_units_are_those_of_its_formulas() {
    let folder = folder("px4-formulas");
    for frame in ["x8", "x12"] {
        let (file, text) = new_frame(&folder, frame, "px4");
        // As [[unit]] tables.
        let upper = if frame == "x8" { "0,1,2,3" } else { "0,1,2,3,4,5" };
        let units = of_px4(&folder, &file, upper);
        assert!(text.contains("[layout]") && units.len() >= 4, "{text}");
        assert_units_of_px4(frame, &units, file.to_str().unwrap());
    }
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn px4_units_are_those_of_its_geometries() {
    let data = bench_data();
    let folder = folder("px4-units");
    let airframe = folder.join("airframe.toml");
    for names in [
        &["octa_cox.toml"][..],
        &["dodeca_top_cox.toml", "dodeca_bottom_cox.toml"],
    ] {
        let (units, _) = import(&folder, &[&parameters(&folder, &data, names)], &[]);
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
#[ignore = "needs MIXER_BENCH_DATA"]
fn ardupilot_units_are_those_of_its_tables() {
    let data = bench_data();
    let folder = folder("ardupilot-units");
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
        let file = write(
            &folder,
            "a.param",
            &format!("FRAME_CLASS,{class}\nFRAME_TYPE,{kind}\n"),
        );
        let (units, _) = import(&folder, &[&file], &["--arm", "0.45"]);
        let airframe = folder.join("airframe.toml");
        let airframe = airframe.to_str().unwrap();
        // PX4 has no files of +, H and Y6 frames in the data: its formulas on the same places.
        assert_units_of_px4(&name, &units, airframe);
        let [roll_nm, pitch_nm, yaw_nm, thrust_n] = setpoint_of_one(airframe, "ardupilot");
        let motors = frame["motors"].as_array().unwrap();
        let factors: Vec<[f64; 3]> = motors.iter().map(factors).collect();
        let largest = |axis: usize| factors.iter().fold(0.0, |most: f64, f| most.max(f[axis].abs()));
        let thrust_n = thrust_n / motors.len() as f64;
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
            (roll_nm, sum(0, &|channel| -thrust_n * lever(channel, "PY"))),
            (pitch_nm, sum(1, &|channel| thrust_n * lever(channel, "PX"))),
        ];
        for (given, expected) in expected {
            assert!(
                (given / expected - 1.0).abs() < 2e-3,
                "{name}: {given} {expected}"
            );
        }
        // Half of every motor's torque; V has other yaw factors, which an airframe does not show.
        let moment = (0..motors.len())
            .map(|channel| lever(channel, "KM").abs())
            .sum::<f64>();
        let expected = 0.5 * thrust_n * moment;
        assert!(
            (yaw_nm / expected - 1.0).abs() < 2e-3,
            "{name}: {yaw_nm} {expected}"
        );
        let params = printed(&["params", airframe, "--stack", "ardupilot", "--own"]);
        let found = ["FRAME_CLASS", "FRAME_TYPE"].map(|name| value(&params, name));
        let kind = if (class, kind) == (4, 2) { 1 } else { kind };
        assert_eq!(found, [Some(f64::from(class)), Some(f64::from(kind))], "{name}");
    }
    // X8 in + and X and H, Y6 A and B, X12 in + and X.
    for frame in [(4, 0), (4, 1), (4, 3), (5, 1), (5, 10), (12, 0), (12, 1)] {
        assert!(seen.contains(&frame), "{frame:?} is not in the tables");
    }
}
