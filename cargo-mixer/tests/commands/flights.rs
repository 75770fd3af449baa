//! Real flights of an X8 with an ordinary mixer: what its thrust command in hover is, over its
//! weight. The logs are not part of the project: `MIXER_BENCH_DATA` names their folder.

use std::path::Path;

use crate::{bench_data, measured};

/// Declared weight, N: 1.92 kg.
const WEIGHT_N: f64 = 1.92 * 9.80665;

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

#[test]
fn an_ordinary_mixer_asks_for_more_than_the_weight_in_hover() {
    let Some(data) = bench_data("an_ordinary_mixer_asks_for_more_than_the_weight_in_hover") else {
        return;
    };
    let mut text = String::from("flight,command_over_weight,deviation,rows\n");
    for (name, flight, told) in [
        ("log_20240613_121802.csv", "2024-06-13 12:18", 1.18),
        ("log_20240621_103807.csv", "2024-06-21 10:38", 1.21),
        ("log_20240613_115633.csv", "2024-06-13 11:56", 1.40),
    ] {
        let (mean, deviation, rows) = hover(&data.join("acsl").join(name));
        println!("{name}: {mean:.4} +- {deviation:.4}, {rows} rows");
        assert!((mean - told).abs() < 0.01, "{name}: {mean}");
        text += &format!("{flight},{mean:.2},{deviation:.2},{rows}\n");
    }
    measured::hold("logged-hover.csv", &text);
}
