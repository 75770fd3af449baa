//! `identify --prior` with rows of a pair, and predicted airframes of real pairs.

use std::fs;

use cargo_mixer::bench_files::{identify, read_one};
use mixer_compiler::airframe::{Basis, TYPICAL_EXPONENT};
use mixer_compiler::{Source, compile};
use mixer_identify::air::Air;
use mixer_identify::bench::Preparation;
use mixer_identify::fit::polynomial::Polynomial;
use mixer_identify::fragment;
use mixer_identify::identified::Settings;
use mixer_identify::rotor::predict::{PredictOptions, Predicted, correct};
use mixer_identify::rotor::single::{RunFacts, Single};
use mixer_rt::Wrench;

use crate::{bench_data, folder, json, run, stdout};

/// Rows of a pair move the prediction: with thrust and torque, and with thrust alone.
#[test]
fn rows_of_the_pair_correct_a_prediction() {
    let folder = folder("prior");
    let rotor = "tools/cargo-mixer/tests/cases/files/five.csv";
    let before = json(&run(&["predict", rotor, "--json"]));
    let plan = run(&["plan", "--prior"]);
    let rows = stdout(&plan).lines().skip(1);
    let mut places: Vec<&str> = rows.map(|line| line.trim_end_matches(',')).collect();
    places.retain(|place| *place != "0.0,0.0");
    assert_eq!(places, ["0.6,0.6", "0.95,0.4", "0.4,0.95", "0.95,0.95"]);
    let with_rows = |name: &str, text: String| {
        let file = folder.join(name);
        fs::write(&file, text).unwrap();
        json(&run(&[
            "identify",
            file.to_str().unwrap(),
            "--prior",
            rotor,
            "--json",
        ]))
    };
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
        let after = with_rows("four.csv", text);
        let moved = coefficients(&after, "thrust_n");
        for place in &places {
            let ratio = at(&moved, place) / at(&thrust, place);
            assert!((1.02..1.06).contains(&ratio), "{place}: {ratio}");
        }
        let [percent, alone] = [&after, &before].map(|found| {
            let percent = &found["pair"]["uncertainty"]["thrust_percent"];
            percent.as_f64().unwrap()
        });
        assert!(percent < alone, "{with_torque}");
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
    let found = with_rows("sixteen.csv", text);
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
#[ignore = "needs MIXER_BENCH_DATA"]
fn predicted_airframes_lift_what_is_asked() {
    let data = bench_data();
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
            prefers_rotor_cell: true,
            ..Preparation::default()
        },
        ..Settings::default()
    };
    let mut all = Vec::new();
    for (run, map, spacing_ratio) in PAIRS {
        let bench = read_one(&file(run), &settings).expect("a run");
        let single = Single::of(&bench, &RunFacts::default(), &mut Vec::new()).expect("a rotor");
        let wishes = PredictOptions {
            spacing_ratio: Some(spacing_ratio),
            ..PredictOptions::default()
        };
        let predicted: Predicted =
            correct(single, None, &[], Air::default(), &wishes, Vec::new()).expect("a pair");
        let airframe = format!(
            "name = \"predicted\"\n{}\n[layout]\narm_m = 0.4\nunits = 4\nfirst_angle_deg = 45.0\n",
            fragment::of_prediction(&predicted)
        );
        let compiled = compile(&Source::new("predicted.toml", airframe))
            .unwrap_or_else(|faults| panic!("{map}: {faults}"));
        let mut quartic = Settings::default();
        quartic.wishes.basis = Some(Basis::Quartic);
        // Rows of the map at the voltage of the prediction.
        quartic.wishes.voltage_exponent = Some([TYPICAL_EXPONENT; 2]);
        quartic.wishes.reference_v = predicted.reference_v;
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
            let volts = predicted.reference_v.unwrap_or_default() as f32;
            let (throttles, ..) = compiled.tables.mix(&setpoint, volts).expect("a mix");
            let units = &compiled.airframe.units;
            let places = units.iter().map(|unit| unit.throttles(&throttles));
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
