//! Real flights of an X8 with an ordinary mixer: what its thrust command in hover is, over its
//! weight. The logs are not part of the project: `MIXER_BENCH_DATA` names their folder.

use std::fs;
use std::path::Path;

use mixer_compiler::Source;
use mixer_files::params::Stack;
use mixer_files::review::{Flight, Review, Series};

use crate::{bench_data, folder, measured, run_with};

/// Declared mass, kg, and weight, N.
const MASS_KG: f64 = 1.92;
const WEIGHT_N: f64 = MASS_KG * 9.80665;

/// Mean and standard deviation of the vertical thrust command over the weight in hover, and the
/// rows that these are of.
fn hover(log: &Path) -> (f64, f64, usize) {
    let mut reader = csv::Reader::from_path(log).unwrap_or_else(|e| panic!("{}: {e}", log.display()));
    let headers = reader.headers().expect("a header").clone();
    let column = |name: &str| {
        let found = headers.iter().position(|header| header == name);
        found.unwrap_or_else(|| panic!("no {name:?} in {}", log.display()))
    };
    let columns = [
        "Position z [m]",
        "Velocity z [m/s]",
        "Roll [rad]",
        "Pitch [rad]",
        "U control input U1 [N]",
    ]
    .map(column);
    let mut shares = Vec::new();
    for record in reader.records() {
        let record = record.expect("a row");
        let [down, sinking, roll, pitch, thrust] =
            columns.map(|at| record[at].parse::<f64>().expect("a number"));
        if -down > 0.4 && sinking.abs() < 0.15 {
            shares.push(thrust * libm::cos(roll) * libm::cos(pitch) / WEIGHT_N);
        }
    }
    let n = shares.len() as f64;
    let mean = shares.iter().sum::<f64>() / n;
    let variance = shares.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
    (mean, variance.sqrt(), shares.len())
}

/// Columns of a log by their names.
fn columns(log: &Path, names: &[String]) -> Vec<Vec<f64>> {
    let mut reader = csv::Reader::from_path(log).unwrap_or_else(|e| panic!("{}: {e}", log.display()));
    let headers = reader.headers().expect("a header").clone();
    let at = |name: &String| {
        headers
            .iter()
            .position(|header| header == name)
            .expect("a column")
    };
    let at: Vec<usize> = names.iter().map(at).collect();
    let rows = reader.records().map(|record| {
        let record = record.expect("a row");
        at.iter()
            .map(|at| record[*at].parse().expect("a number"))
            .collect()
    });
    rows.collect()
}

/// Throttles of the rotors whose thrusts, N, make a run of one rotor.
const RUN: [f64; 10] = [0.2, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.88];

/// Higher than this the vehicle flies, m.
const FLIES_M: f64 = 0.4;

/// The pair that `predict` makes of the curve from newtons to throttles that the vehicle's mixer used, over the flight.
/// `widest` is the log with the most of the curve.
fn reviewed(log: &Path, widest: &Path, folder: &Path) -> Review {
    let motors = |of: [&str; 2]| -> Vec<String> {
        let [name, unit] = of;
        let motor = |k| format!("Thrust motors {name}X8COPTER T{k} [{unit}]");
        (1..=8).map(motor).collect()
    };
    let throttles = motors(["normalized ", "-"]);
    let names = [throttles.clone(), motors(["", "N"])].concat();
    let points: Vec<[f64; 2]> = columns(widest, &names)
        .iter()
        .flat_map(|row| (0..8).map(|k| [row[k], row[k + 8]]).collect::<Vec<_>>())
        .collect();
    let mut sheet = String::from("throttle,thrust (N)\n");
    for throttle in RUN {
        let off = |point: &&[f64; 2]| (point[0] - throttle).abs();
        let nearest = points
            .iter()
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .expect("points");
        if off(&nearest) < 0.02 {
            sheet += &format!("{},{}\n", nearest[0], nearest[1]);
        }
    }
    let [rotor, pair] = ["rotor.csv", "x8.toml"].map(|name| folder.join(name).display().to_string());
    fs::write(&rotor, sheet).unwrap();
    let arguments = [
        "predict",
        &rotor,
        "--diameter",
        "0.127",
        "--frame",
        "x8",
        "--arm",
        "0.14",
        "-o",
        &pair,
        "--force",
    ];
    let output = run_with(&arguments, b"");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = fs::read_to_string(&pair).unwrap();
    let compiled = mixer_compiler::compile(&Source::new("x8.toml", text)).unwrap();

    let names = ["Current time [s]", "Position z [m]", "Roll [rad]", "Pitch [rad]"];
    let velocities = ["x", "y", "z"].map(|axis| format!("Velocity {axis} [m/s]"));
    let names: Vec<String> = names
        .map(str::to_owned)
        .into_iter()
        .chain(velocities)
        .chain(throttles)
        .collect();
    let rows = columns(log, &names);
    let [mut throttle, mut force, mut down, mut velocity, mut landed] = [(); 5].map(|()| Series::default());
    for three in rows.windows(3) {
        let [before, row, after] = three else { continue };
        let time_s = row[0];
        let (sin_p, cos_p) = (libm::sin(row[3]), libm::cos(row[3]));
        let (sin_r, cos_r) = (libm::sin(row[2]), libm::cos(row[2]));
        let tilted = [-sin_p, cos_p * sin_r, cos_p * cos_r];
        // What an accelerometer would measure; motion capture has none. Sideways forces are not looked at.
        let upward = WEIGHT_N / MASS_KG - (after[6] - before[6]) / (after[0] - before[0]);
        force.push(time_s, tilted.map(|d| -upward * d).to_vec());
        down.push(time_s, tilted.to_vec());
        velocity.push(time_s, row[4..7].to_vec());
        throttle.push(time_s, row[7..].to_vec());
        landed.push(time_s, vec![f64::from(u8::from(-row[1] < FLIES_M))]);
    }
    let flight = Flight {
        down: Some(down),
        velocity: Some(velocity),
        landed: Some(landed),
        ..Flight::new(Stack::Px4, throttle, force)
    };
    Review::of(&flight, &compiled, Some(MASS_KG)).unwrap_or_else(|error| panic!("{}: {error}", log.display()))
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn an_ordinary_mixer_asks_for_more_than_the_weight_in_hover() {
    let data = bench_data();
    let (logs, folder) = (data.join("acsl"), folder("flights"));
    let mut text = String::from("flight,command_over_weight,deviation,rows,scale,low,high\n");
    for (name, flight, told) in [
        ("log_20240613_121802.csv", "2024-06-13 12:18", 1.18),
        ("log_20240621_103807.csv", "2024-06-21 10:38", 1.21),
        ("log_20240613_115633.csv", "2024-06-13 11:56", 1.40),
    ] {
        let (mean, deviation, rows) = hover(&logs.join(name));
        println!("{name}: {mean:.4} +- {deviation:.4}, {rows} rows");
        assert!((mean - told).abs() < 0.01, "{name}: {mean}");
        let thrust = reviewed(&logs.join(name), &logs.join("log_20240613_121802.csv"), &folder).thrust;
        let (scale, [low, high]) = (thrust.scale.unwrap(), thrust.interval);
        println!("{name}: {thrust:?}");
        text += &format!("{flight},{mean:.2},{deviation:.2},{rows},{scale:.3},{low:.3},{high:.3}\n");
    }
    measured::hold("logged-hover.csv", &text);
}
