//! A map between two measured spacings of the same rotors, against the map of a spacing between
//! them.

use std::path::Path;

use cargo_mixer::bench_files::{identify, read_one};
use mixer_compiler::airframe::Basis;
use mixer_identify::bench::Point;
use mixer_identify::fit::balance::balanced;
use mixer_identify::fit::polynomial::Polynomial;

use super::bench_data::coaxial;
use super::sweep::settings;
use crate::bench_data;
use crate::measured;

/// The first is of another day than the other two, and begins at 0.40.
const NEAR: (&str, f64) = ("07_23_08_27_27_11in", 0.2);
const BETWEEN: (&str, f64) = ("08_17_11_11_55_11in", 0.4);
const FAR: (&str, f64) = ("08_17_09_33_47_11in", 1.0);
const FROM: f64 = 0.4;
const REFERENCE_V: f64 = 10.5;
const EXPONENT: f64 = 1.75;

/// Coefficients of thrust and torque at the reference voltage.
fn coefficients(file: &Path) -> [Vec<f64>; 2] {
    let mut settings = settings(Some(Basis::Cubic));
    settings.wishes.voltage_exponent = Some([EXPONENT; 2]);
    settings.wishes.reference_v = Some(REFERENCE_V);
    let found = identify(&[file.to_path_buf()], &settings).unwrap_or_else(|e| panic!("{}", e[0]));
    let pair = found.pair.expect("a pair");
    [pair.thrust_n, pair.torque_nm]
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn a_map_between_two_spacings_is_interpolated() {
    let data = bench_data();
    let [near, between, far] = [NEAR, BETWEEN, FAR].map(|(part, _)| coefficients(&coaxial(&data, part)));
    let weight = (BETWEEN.1 - NEAR.1) / (FAR.1 - NEAR.1);
    let mixed: [Vec<f64>; 2] = [0, 1].map(|k| {
        let pairs = near[k].iter().zip(&far[k]);
        pairs
            .map(|(near, far)| (1.0 - weight) * near + weight * far)
            .collect()
    });
    let bench = read_one(&coaxial(&data, BETWEEN.0), &settings(None));
    let rows = balanced(&bench.expect("a bench")).points;
    let full = rows.iter().fold([0.0f64; 2], |full, row| {
        [full[0].max(row.thrust.abs()), full[1].max(row.torque.abs())]
    });
    let rows: Vec<_> = rows
        .iter()
        .filter(|row| row.u.min(row.l) >= FROM - 1e-6)
        .collect();
    assert!(rows.len() >= 36, "{}", rows.len());
    let percent = |coefficients: &[Vec<f64>; 2]| {
        [0, 1].map(|k| {
            let model = Polynomial::of(Basis::Cubic, &coefficients[k]);
            let square = |row: &&Point| {
                let at_reference = libm::pow(REFERENCE_V / row.voltage, EXPONENT);
                let measured = [row.thrust, row.torque][k] * at_reference;
                let missed = model.at(row.u, row.l) - measured;
                missed * missed
            };
            100.0 * (rows.iter().map(square).sum::<f64>() / rows.len() as f64).sqrt() / full[k]
        })
    };
    let models = [&between, &mixed, &near, &far].map(percent);
    let names = [
        "that spacing's own",
        "interpolated from z/D 0.2 and 1",
        "z/D 0.2",
        "z/D 1",
    ];
    let mut text = String::from("map,thrust_percent,torque_percent\n");
    for (name, [thrust, torque]) in names.iter().zip(models) {
        text += &format!("{name},{thrust:.2},{torque:.2}\n");
    }
    measured::hold("spacings.csv", &text);
    let [_, interpolated, near, far] = models;
    assert!(interpolated[0] < 1.2 && interpolated[1] < 3.0, "{interpolated:?}");
    for single in [near, far] {
        assert!(
            // Thrust differs by 1 % from day to day, by less between the spacings.
            interpolated[0] < single[0] + 0.05 && interpolated[1] < single[1],
            "{models:?}"
        );
    }
}
