//! `cargo mixer predict` and `identify --prior`: the command, what it refuses, real pairs.
#![allow(missing_docs)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use cargo_mixer::bench_files::{identify, read_one};
use mixer_compiler::airframe::Basis;
use mixer_compiler::{Source, compile};
use mixer_identify::bench::Preparation;
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::identified::Settings;
use mixer_identify::rotor::predict::{Predicted, Wishes, predict, text};
use mixer_identify::rotor::single::{Known, Single};
use mixer_rt::Wrench;

fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("predict-{test}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder");
    path
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_cargo-mixer"))
        .arg("mixer")
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the command runs")
}

fn json(output: &Output) -> serde_json::Value {
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Thrust (gf) and torque (N m) of a rotor at a throttle in per cent.
fn rotor(throttle: f64) -> [f64; 2] {
    let x = 0.01 * throttle;
    [2000.0 * x * (0.2 + 0.8 * x), 0.3 * x * (0.2 + 0.8 * x)]
}

fn table(throttles: &[f64], with_torque: bool) -> String {
    let mut text = String::from(if with_torque {
        "Throttle (%),Thrust (gf),Torque (N*m)\n"
    } else {
        "Throttle (%),Thrust (gf)\n"
    });
    for &throttle in throttles {
        let [thrust, torque] = rotor(throttle);
        text += &format!("{throttle},{thrust:.1}");
        text += &if with_torque {
            format!(",{torque:.5}\n")
        } else {
            "\n".into()
        };
    }
    text
}

const FIVE: [f64; 5] = [50.0, 65.0, 75.0, 85.0, 95.0];

#[test]
fn a_table_of_five_rows_becomes_an_airframe() {
    let folder = folder("five");
    fs::write(folder.join("rotor.csv"), table(&FIVE, true)).expect("a file");
    let arguments = [
        "predict",
        "rotor.csv",
        "--frame",
        "x8",
        "--arm",
        "0.4",
        "-o",
        "my-x8.toml",
    ];
    let output = run(&folder, &arguments);
    assert!(output.status.success(), "{output:?}");
    let report = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(report.starts_with("Predicted, not measured"), "{report}");
    let file = fs::read_to_string(folder.join("my-x8.toml")).expect("the airframe");
    for part in [
        "# Predicted by cargo mixer predict",
        "rotor.csv",
        "[pair.uncertainty]",
        "[pair.lower_out]",
        "[pair.upper_out]",
    ] {
        assert!(file.contains(part), "{part} in\n{file}");
    }
    let checked = json(&run(&folder, &["check", "my-x8.toml", "--json"]));
    assert_eq!(checked["rotors"], 8);
    // With a mass, hover and margins have their bands.
    let with_mass = file.clone() + "\n[vehicle]\nmass_kg = 5.0\n";
    fs::write(folder.join("heavy.toml"), with_mass).expect("a file");
    let checked = json(&run(&folder, &["check", "heavy.toml", "--json"]));
    let hover = &checked["hover"]["at"][0];
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{hover}"));
    let upper = number(&hover["upper_throttle"]);
    let [least, most] = [0, 1].map(|k| number(&hover["throttle_band"][k][0]));
    assert!(least < upper && upper < most && most - least < 0.1, "{hover}");
    let margins = hover["margins"].as_array().expect("margins");
    assert!(margins.iter().all(|margin| number(&margin["band_nm"]) > 0.0));
    let said = run(&folder, &["check", "heavy.toml"]);
    assert!(String::from_utf8_lossy(&said.stdout).contains("by [pair.uncertainty]: throttle"));
    // It is not overwritten.
    assert_eq!(run(&folder, &arguments).status.code(), Some(1));
}

/// One table in other units, and by hand, is one prediction.
#[test]
fn units_are_those_of_the_header_or_given() {
    let folder = folder("units");
    let forms: [(&str, f64, f64, &[&str]); 5] = [
        ("Throttle (%),Thrust (gf),Torque (N*m)", 1.0, 1.0, &[]),
        ("throttle,thrust_n,torque_nm", 0.01, 9.80665e-3, &[]),
        ("throttle,thrust_kgf,torque_nm", 0.01, 1e-3, &[]),
        (
            "throttle,thrust,torque",
            1.0,
            1.0,
            &[
                "--unit",
                "throttle=%",
                "--unit",
                "thrust=gf",
                "--unit",
                "torque=Nm",
            ],
        ),
        ("PWM (us),Thrust (g),Torque (N*m)", 10.0, 1.0, &[]),
    ];
    let mut first = None;
    for (header, by_throttle, by_thrust, more) in forms {
        let mut text = format!("{header}\n");
        for throttle in FIVE {
            let [thrust, torque] = rotor(throttle);
            let offset = if header.starts_with("PWM") { 1000.0 } else { 0.0 };
            text += &format!(
                "{},{},{torque}\n",
                offset + by_throttle * throttle,
                by_thrust * thrust
            );
        }
        fs::write(folder.join("rotor.csv"), text).expect("a file");
        let arguments = [&["predict", "rotor.csv", "--json"], more].concat();
        let found = json(&run(&folder, &arguments));
        let thrust: Vec<f64> = serde_json::from_value(found["pair"]["thrust_n"].clone()).expect("numbers");
        let first = first.get_or_insert_with(|| thrust.clone());
        for (a, b) in thrust.iter().zip(first) {
            assert!((a - *b).abs() < 1e-6, "{header}: {a} {b}");
        }
    }
}

/// Speeds as the abscissa take the constants of speed controllers that hold them.
#[test]
fn a_curve_over_speed_is_read_as_such() {
    let folder = folder("rpm");
    let mut text = String::from("RPM,Thrust (N),Torque (N*m)\n");
    for throttle in FIVE {
        let x = 0.01 * throttle;
        text += &format!("{},{},{}\n", 8000.0 * x, 20.0 * x * x, 0.3 * x * x);
    }
    fs::write(folder.join("rotor.csv"), text).expect("a file");
    let found = json(&run(
        &folder,
        &["predict", "rotor.csv", "--rpm-at-full", "8000", "--json"],
    ));
    assert_eq!(found["constants"][0], 4.28);
    let refused = run(&folder, &["predict", "rotor.csv"]);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("rotor speeds are no throttles"));
}

/// What is wrong, what is given, the status, and what is said of it.
#[test]
fn wrong_inputs_are_named() {
    let folder = folder("wrong");
    let grid: String = (0..25)
        .map(|k| (0.2 + 0.2 * f64::from(k / 5), 0.2 + 0.2 * f64::from(k % 5)))
        .map(|(u, l)| {
            format!(
                "{u:.1},{l:.1},{},{}\n",
                9.0 * u * u + 7.0 * l * l,
                0.2 * l * l - 0.2 * u * u
            )
        })
        .collect();
    let pair = format!("upper,lower,thrust_n,torque_nm\n{grid}");
    let falling = "throttle,thrust_n,torque_nm\n0.5,9,0.1\n0.6,7,0.1\n0.7,5,0.1\n0.8,3,0.1\n0.9,1,0.1\n";
    let whole: Vec<f64> = (2..=10).map(|k| 10.0 * f64::from(k)).collect();
    let files = [
        ("good.csv", table(&whole, true)),
        ("pair.csv", pair),
        ("four-rows.csv", table(&FIVE[..4], true)),
        ("stops.csv", table(&[20.0, 30.0, 40.0, 50.0, 60.0], true)),
        ("no-torque.csv", table(&FIVE, false)),
        ("falling.csv", falling.to_owned()),
        ("no-unit.csv", table(&FIVE, true).replace(" (gf)", "")),
        ("per-cent.csv", table(&FIVE, true).replace(" (%)", "")),
        ("empty.csv", String::new()),
        (
            "words.csv",
            table(&FIVE, true).replace("50,", "half,").replace("65,", "more,"),
        ),
        ("speed.csv", "RPM,Thrust (N)\n1000,2\n".to_owned()),
        (
            "scattered.csv",
            "throttle,thrust_n,torque_nm\n.2,9,.1\n.4,2,.3\n.6,14,.1\n.8,4,.4\n1,16,.2\n".to_owned(),
        ),
        (
            "half.csv",
            table(&whole, true).replace("Thrust (gf)", "Thrust (half)"),
        ),
        (
            "large.csv",
            table(&whole, true).replace("Thrust (gf)", "Thrust (kgf)"),
        ),
    ];
    for (name, text) in &files {
        fs::write(folder.join(name), text).expect("a file");
    }
    // Propellers of another size below.
    let upper = table(&whole, true);
    let lower = upper.lines().map(|line| match line.split_once(',') {
        Some((throttle, rest)) if !line.starts_with('T') => {
            let (thrust, torque) = rest.split_once(',').expect("three cells");
            format!(
                "{throttle},{},{torque}\n",
                0.8 * thrust.parse::<f64>().expect("a number")
            )
        }
        _ => format!("{line}\n"),
    });
    fs::write(folder.join("lower.csv"), lower.collect::<String>()).expect("a file");
    let cases: [(&[&str], i32, &str); 22] = [
        (&["predict", "half.csv"], 1, "the unit \"half\""),
        (&["predict", "large.csv"], 1, "check the units of thrust"),
        (&["predict", "pair.csv"], 1, "cargo mixer identify pair.csv"),
        (&["identify", "good.csv"], 1, "cargo mixer predict"),
        (&["predict", "missing.csv"], 1, "missing.csv: cannot be read"),
        (
            &["predict", "four-rows.csv"],
            1,
            "4 distinct throttles, at least 5",
        ),
        (
            &["predict", "stops.csv"],
            1,
            "stops at a throttle of 0.60, below 0.7",
        ),
        (&["predict", "no-torque.csv"], 1, "--diameter METRE"),
        (
            &["predict", "falling.csv", "--thrust-sign", "-"],
            1,
            "the thrust does not grow with the throttle",
        ),
        (
            &["predict", "no-unit.csv"],
            1,
            "no-unit.csv:1: the column \"Thrust\" has no unit",
        ),
        (&["predict", "per-cent.csv"], 1, "--unit upper=%"),
        (&["predict", "empty.csv"], 1, "the file is empty"),
        (&["predict", "words.csv"], 1, "3 distinct throttles"),
        (&["predict", "speed.csv"], 1, "rotor speeds are no throttles"),
        (&["predict", "scattered.csv"], 1, "misses a growing curve"),
        (
            &["predict", "good.csv", "--lower-single", "pair.csv"],
            1,
            "both rotors turn in it",
        ),
        (
            &["predict", "good.csv", "--reference-voltage", "22"],
            1,
            "--run-voltage VOLT",
        ),
        (&["predict", "good.csv", "--spacing", "0.1"], 2, "--diameter"),
        (
            &["predict", "good.csv", "--spacing-ratio", "0"],
            2,
            "not positive",
        ),
        (
            &["predict", "good.csv", "-o", "good.csv", "--force"],
            2,
            "would be overwritten",
        ),
        (&["identify", "pair.csv", "--kappa", "0.01"], 2, "--prior"),
        (
            &["identify", "good.csv", "--prior", "good.csv"],
            1,
            "it is no row of the pair",
        ),
    ];
    for (arguments, status, said) in cases {
        let output = run(&folder, arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {text}");
        assert!(text.contains(said), "{arguments:?} says\n{text}");
    }
    // What serves with a remark.
    let remarks: [(&[&str], &str); 6] = [
        (
            &["predict", "good.csv", "--spacing-ratio", "0.05"],
            "extrapolated",
        ),
        (&["predict", "good.csv", "--spacing-ratio", "1.5"], "extrapolated"),
        (
            &["predict", "good.csv", "--lower-single", "lower.csv"],
            "measured on equal rotors",
        ),
        (
            &["predict", "no-torque.csv", "--diameter", "0.3"],
            "torque was not measured",
        ),
        (
            &["predict", "good.csv", "--throttle", "0.1,1"],
            "not held against benches",
        ),
        (
            &[
                "predict",
                "good.csv",
                "--run-voltage",
                "20",
                "--reference-voltage",
                "22",
            ],
            "exponent of 1.75",
        ),
    ];
    for (arguments, said) in remarks {
        let found = json(&run(&folder, &[arguments, &["--json"]].concat()));
        let warnings = found["warnings"].to_string();
        assert!(warnings.contains(said), "{arguments:?} says\n{warnings}");
    }
}

/// Rows of a pair move the prediction: with thrust and torque, and with thrust alone.
#[test]
fn rows_of_the_pair_correct_a_prediction() {
    let folder = folder("prior");
    fs::write(folder.join("rotor.csv"), table(&FIVE, true)).expect("a file");
    let before = json(&run(&folder, &["predict", "rotor.csv", "--json"]));
    let plan = run(&folder, &["plan", "--prior"]);
    let plan = String::from_utf8_lossy(&plan.stdout).into_owned();
    let places: Vec<&str> = plan
        .lines()
        .skip(1)
        .map(|line| line.trim_end_matches(','))
        .collect();
    assert_eq!(places, ["0.6,0.6", "0.95,0.4", "0.4,0.95", "0.95,0.95"]);
    let coefficients = |found: &serde_json::Value, key: &str| -> Polynomial {
        let numbers: Vec<f64> = serde_json::from_value(found["pair"][key].clone()).expect("numbers");
        Polynomial::of(Basis::Cubic, &numbers)
    };
    let thrust = coefficients(&before, "thrust_n");
    let torque = coefficients(&before, "torque_nm");
    let at = |p: &Polynomial, place: &str| {
        let (u, l) = place.split_once(',').expect("two throttles");
        p.at(u.parse().expect("a number"), l.parse().expect("a number"))
    };
    for with_torque in [true, false] {
        let mut text = String::from("upper,lower,thrust_n,torque_nm\n");
        for place in &places {
            // The pair gives 4 % more thrust than predicted.
            text += &format!("{place},{},", 1.04 * at(&thrust, place));
            text += &if with_torque {
                format!("{}\n", at(&torque, place))
            } else {
                "\n".into()
            };
        }
        fs::write(folder.join("four.csv"), text).expect("a file");
        let after = json(&run(
            &folder,
            &["identify", "four.csv", "--prior", "rotor.csv", "--json"],
        ));
        let moved = coefficients(&after, "thrust_n");
        for place in &places {
            let ratio = at(&moved, place) / at(&thrust, place);
            assert!((1.02..1.06).contains(&ratio), "{place}: {ratio}");
        }
        let percent = after["pair"]["uncertainty"]["thrust_percent"]
            .as_f64()
            .expect("a number");
        let alone = before["pair"]["uncertainty"]["thrust_percent"]
            .as_f64()
            .expect("a number");
        assert_eq!(percent < alone, with_torque);
        let warned = after["warnings"].to_string().contains("halve the error");
        assert_eq!(warned, !with_torque);
    }
    // From sixteen rows on it says that a plain identification is truer.
    let mut text = String::from("upper,lower,thrust_n,torque_nm\n");
    for k in 0..16 {
        let place = format!(
            "{:.2},{:.2}",
            0.25 + 0.25 * f64::from(k / 4),
            0.25 + 0.25 * f64::from(k % 4)
        );
        text += &format!("{place},{},{}\n", at(&thrust, &place), at(&torque, &place));
    }
    fs::write(folder.join("sixteen.csv"), text).expect("a file");
    let found = json(&run(
        &folder,
        &["identify", "sixteen.csv", "--prior", "rotor.csv", "--json"],
    ));
    assert!(found["warnings"].to_string().contains("leave --prior out"));
}

/// Runs of rotors, maps of their pairs, z/D.
const PAIRS: [(&str, &str, f64); 7] = [
    ("propdrivev2_single_rotor_good", "07_23_08_27_27_11in", 0.2),
    ("propdrivev2_single_rotor_good", "08_17_11_11_55_11in", 0.4),
    ("propdrivev2_single_rotor_good", "08_17_09_33_47_11in", 1.0),
    ("U5_T_motor_single_rotor", "08_09_18_15_06_16p2in", 0.5),
    ("U5_T_motor_single_rotor", "07_22_10_20_01_16p2in", 1.0),
    ("MN501S_T_motor_single_rotor", "08_17_17_00_55_22in", 0.4),
    ("MN501S_T_motor_single_rotor", "07_20_14_17_57_22in", 0.5),
];

/// Predicted airframes of real pairs, through the whole mixer, by the quartic of the pair's own map.
#[test]
fn predicted_airframes_lift_what_is_asked() {
    let Some(data) = std::env::var_os("MIXER_BENCH_DATA").map(PathBuf::from) else {
        eprintln!("NOT RUN: predicted_airframes_lift_what_is_asked needs MIXER_BENCH_DATA");
        return;
    };
    let file = |part: &str| {
        let entries = fs::read_dir(data.join("newdexterity"))
            .expect("the folder")
            .flatten();
        let mut paths = entries.map(|entry| entry.path());
        paths
            .find(|path| path.to_string_lossy().contains(part))
            .expect("a file")
    };
    let settings = Settings {
        preparation: Preparation {
            own_columns: true,
            ..Preparation::default()
        },
        ..Settings::default()
    };
    let mut all = Vec::new();
    for (run, map, spacing_ratio) in PAIRS {
        let bench = read_one(&file(run), &settings).expect("a run");
        let single = Single::of(&bench, &Known::default(), &mut Vec::new()).expect("a rotor");
        let wishes = Wishes {
            spacing_ratio: Some(spacing_ratio),
            ..Wishes::default()
        };
        let predicted: Predicted = predict(single, None, &wishes, Vec::new()).expect("a pair");
        let airframe = format!(
            "name = \"predicted\"\n{}\n[layout]\narm_m = 0.4\nunits = 4\nfirst_angle_deg = 45.0\n",
            text(&predicted)
        );
        let compiled = compile(&Source::new("predicted.toml", airframe))
            .unwrap_or_else(|faults| panic!("{map}: {faults}"));
        let mut quartic = Settings::default();
        quartic.wishes.basis = Some(Basis::Quartic);
        let measured = identify(&[file(map)], &quartic)
            .expect("a map")
            .pair
            .expect("a pair");
        let truth = Polynomial::of(Basis::Quartic, &measured.thrust_n);
        let lowest = measured.measured[0][0].max(measured.measured[1][0]);
        let ceiling = f64::from(compiled.thrust_range_n[1]);
        let mut errors = Vec::new();
        // Frames hover there.
        for k in 0..=20 {
            let asked = ceiling * (0.3 + 0.4 * f64::from(k) / 20.0);
            let setpoint = Wrench {
                thrust_n: asked as f32,
                ..Wrench::default()
            };
            let (throttles, ..) = compiled.tables.mix(&setpoint, 0.0).expect("a mix");
            let units = &compiled.airframe.units;
            let places = units.iter().map(|unit| {
                [unit.upper_channel, unit.lower_channel].map(|channel| f64::from(throttles[channel]))
            });
            let places: Vec<[f64; 2]> = places.collect();
            // Within what the map measured; its polynomial is a guess elsewhere.
            if places.iter().flatten().all(|t| (lowest..=0.96).contains(t)) {
                let given: f64 = places.iter().map(|[u, l]| truth.at(*u, *l)).sum();
                errors.push(100.0 * (given / asked - 1.0));
            }
        }
        assert!(errors.len() >= 8, "{map}: {} thrusts", errors.len());
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let worst = errors
            .iter()
            .fold(0.0, |worst: f64, error| worst.max(error.abs()));
        println!(
            "{map}: {mean:+.1} % in the mean of level thrusts, {worst:.1} % at most, idle {}",
            predicted.pair.min_idle
        );
        assert!(worst < 4.0, "{map}: {worst:.1} %");
        all.push(mean.abs());
    }
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    assert!(mean < 1.5, "{mean} % in the mean of maps");
}
