//! Rows of real pairs, as they are and with the mistakes that people make, on top of real runs of their
//! rotors, where `MIXER_BENCH_DATA` names the folder of the bench files.

use std::collections::BTreeMap;
use std::path::Path;

use mixer_identify::bench::{Point, Preparation};
use mixer_identify::identified::Settings;
use mixer_identify::plan::CORRECTING;
use mixer_identify::rotor::predict::PredictOptions;
use mixer_identify::rotor::single::RunFacts;
use mixer_identify::texts::{Prediction, Text, predict, read};

type Propeller = (&'static [&'static str], &'static [(&'static str, f64)]);

/// Parts of the names of a propeller's runs, of the upper and of the lower rotor alone, and of maps of
/// its pairs with their z/D.
const PROPELLERS: [Propeller; 3] = [
    (
        &["propdrivev2_single_rotor_good", "propdrivev2_bottom_rotor"],
        &[
            ("07_23_08_27_27_11in", 0.2),
            ("08_17_11_11_55_11in", 0.4),
            ("08_17_09_33_47_11in", 1.0),
        ],
    ),
    (
        &["U5_T_motor_single_rotor", "U5_T_motor_bottom_rotor"],
        &[("08_09_18_15_06_16p2in", 0.5), ("07_22_10_20_01_16p2in", 1.0)],
    ),
    (
        &["MN501S_T_motor_single_rotor", "MN501S_T_motor_bottom_rotor"],
        &[("08_17_17_00_55_22in", 0.4), ("07_20_14_17_57_22in", 0.5)],
    ),
];

/// u, l, thrust, torque, voltage of the upper and the lower rotor.
type Row = [f64; 6];
type Mistake = fn(&mut [Row]);

fn times(rows: &mut [Row], thrust: f64, torque: f64) {
    for row in rows {
        row[2] *= thrust;
        row[3] *= torque;
    }
}

fn exchange(rows: &mut [Row]) {
    for row in rows {
        row.swap(0, 1);
        row.swap(4, 5);
    }
}

/// A mistake, and how it is made.
const MISTAKES: [(&str, Mistake); 32] = [
    ("x2", |r| times(r, 2.0, 1.0)),
    ("/2", |r| times(r, 0.5, 1.0)),
    ("x9.8", |r| times(r, 9.80665, 1.0)),
    ("/9.8", |r| times(r, 1.0 / 9.80665, 1.0)),
    ("gf as N", |r| times(r, 101.97, 1.0)),
    ("N as gf", |r| times(r, 1.0 / 101.97, 1.0)),
    ("x1000", |r| times(r, 1000.0, 1.0)),
    ("/1000", |r| times(r, 0.001, 1.0)),
    ("lbf as N", |r| times(r, 1.0 / 4.448, 1.0)),
    ("N as lbf", |r| times(r, 4.448, 1.0)),
    ("ozf as N", |r| times(r, 3.597, 1.0)),
    ("Q/2", |r| times(r, 1.0, 0.5)),
    ("Qx2", |r| times(r, 1.0, 2.0)),
    ("N cm", |r| times(r, 1.0, 100.0)),
    ("mN m", |r| times(r, 1.0, 1000.0)),
    ("kgf cm", |r| times(r, 1.0, 10.197)),
    ("Q/100", |r| times(r, 1.0, 0.01)),
    ("18 V of 14.8", |r| times(r, 1.408, 1.408)),
    ("14.8 V of 18", |r| times(r, 0.71, 0.71)),
    ("4.2 of 3.7", |r| times(r, 1.248, 1.248)),
    ("3.7 of 4.2", |r| times(r, 0.801, 0.801)),
    ("gf as N, Q N cm", |r| times(r, 101.97, 100.0)),
    ("exchanged", |r| exchange(r)),
    ("exchanged, /2", |r| {
        exchange(r);
        times(r, 0.5, 1.0)
    }),
    ("row f x1.1", |r| r[1][2] *= 1.1),
    ("row f x1.2", |r| r[1][2] *= 1.2),
    ("row f x0.8", |r| r[1][2] *= 0.8),
    ("row f x10", |r| r[1][2] *= 10.0),
    ("row Q sign", |r| r[1][3] *= -1.0),
    ("row exch", |r| exchange(&mut r[1..2])),
    ("row throttle", |r| r[1][0] = r[1][1]),
    ("row voltage", |r| {
        r[1][2] *= 0.801;
        r[1][3] *= 0.801
    }),
];

fn file(data: &Path, part: &str) -> Text {
    let mut entries = std::fs::read_dir(data.join("newdexterity"))
        .expect("the folder")
        .flatten();
    let entry = entries
        .find(|e| e.file_name().to_string_lossy().contains(part))
        .expect(part);
    Text {
        name: entry.file_name().to_string_lossy().into_owned(),
        content: Ok(std::fs::read(entry.path()).expect("a file")),
    }
}

fn closest(points: &[Point], [u, l]: [f64; 2]) -> Point {
    let distance = |p: &Point| (p.u - u) * (p.u - u) + (p.l - l) * (p.l - l);
    *points
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("a point")
}

/// The rows of a map nearest to these places.
fn rows(points: &[Point], places: &[[f64; 2]]) -> Vec<Row> {
    let row = |at: &[f64; 2]| {
        let p = closest(points, *at);
        let [upper, lower] = [1.0 + p.imbalance, 1.0 - p.imbalance].map(|x| p.voltage * x);
        [p.u, p.l, p.thrust, p.torque, upper, lower]
    };
    places.iter().map(row).collect()
}

fn csv(rows: &[Row], with_torque: bool) -> Text {
    let mut text = String::from("upper,lower,thrust_n,torque_nm,upper_voltage_v,lower_voltage_v\n");
    for [u, l, thrust, torque, a, b] in rows {
        let torque = if with_torque {
            torque.to_string()
        } else {
            String::new()
        };
        text += &format!("{u},{l},{thrust},{torque},{a},{b}\n");
    }
    Text {
        name: "rows.csv".into(),
        content: Ok(text.into_bytes()),
    }
}

/// Silent, warned or refused.
fn outcome(run: &Text, rows: Text, spacing_ratio: f64) -> usize {
    let how = Prediction {
        run: own(),
        map: Settings {
            preparation: Preparation {
                is_correction: true,
                ..Preparation::default()
            },
            ..Settings::default()
        },
        known: RunFacts::default(),
        wishes: PredictOptions {
            spacing_ratio: Some(spacing_ratio),
            ..PredictOptions::default()
        },
    };
    match predict(run, None, &[rows], &how) {
        Ok(found) => {
            let warnings = &found.found.warnings;
            usize::from(warnings.iter().any(|w| w.contains("the rows miss")))
        }
        Err(_) => 2,
    }
}

fn own() -> Settings {
    Settings {
        preparation: Preparation {
            prefers_rotor_cell: true,
            ..Preparation::default()
        },
        ..Settings::default()
    }
}

/// Choices of rows: the four of the plan, equal commands, and 4 to 12 places by a generator of numbers.
fn choices() -> Vec<Vec<[f64; 2]>> {
    let mut seed = 7_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    };
    let equal = [0.4, 0.55, 0.7, 0.85, 0.95].map(|x| [x; 2]);
    let random = (4..13).map(|count| {
        (0..count)
            .map(|_| [next(), next()].map(|x| 0.2 + 0.75 * x))
            .collect()
    });
    [CORRECTING.to_vec(), equal.to_vec()]
        .into_iter()
        .chain(random)
        .collect()
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn rows_of_other_pairs_and_units_are_told_and_right_ones_pass() {
    let data =
        std::env::var_os("MIXER_BENCH_DATA").expect("MIXER_BENCH_DATA names the folder of the bench files");
    let data = Path::new(&data);
    let mut right = [0; 3];
    let mut wrong: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for (runs, maps) in PROPELLERS {
        let others = PROPELLERS
            .iter()
            .filter(|(others, _)| *others != runs)
            .map(|(runs, _)| runs[0]);
        for (map, spacing_ratio) in maps {
            let points = read(&file(data, map), &own()).expect("a map").points;
            let four = rows(&points, &CORRECTING);
            for run in runs {
                let run = file(data, run);
                for places in choices() {
                    for with_torque in [true, false] {
                        right[outcome(&run, csv(&rows(&points, &places), with_torque), *spacing_ratio)] += 1;
                    }
                }
                for (name, mistake) in MISTAKES {
                    let mut rows = four.clone();
                    mistake(&mut rows);
                    let told = outcome(&run, csv(&rows, true), *spacing_ratio);
                    wrong.entry(name).or_default()[told] += 1;
                }
            }
            for other in others.clone() {
                let told = outcome(&file(data, other), csv(&four, true), *spacing_ratio);
                wrong.entry("another propeller").or_default()[told] += 1;
            }
        }
    }
    eprintln!("right: {right:?} silent, warned, refused; wrong: {wrong:#?}");
    let [silent, warned, refused] = right;
    assert_eq!(refused, 0);
    assert!(warned * 25 <= silent, "{right:?}");
    for (name, [silent, warned, refused]) in wrong {
        // One value off by a tenth is no more than what the model leaves of a map.
        assert!(
            silent == 0 || name.contains("1.1") && warned + refused > 4,
            "{name}: {silent} silent"
        );
    }
}

/// A table of 20 u2 + 2 u N and a torque of 0.02 m of it.
fn table(header: &str, row: impl Fn(f64, f64) -> String) -> Text {
    let rows = (4..=10)
        .map(|k| 0.1 * f64::from(k))
        .map(|u| row(u, 20.0 * u * u + 2.0 * u));
    Text {
        name: "table.csv".into(),
        content: Ok(rows
            .fold(format!("{header}\n"), |text, row| text + &row + "\n")
            .into_bytes()),
    }
}

/// The pair gives 1.58 of one rotor at equal throttles.
#[test]
fn a_stand_with_one_signal_for_both_rotors_corrects_a_prediction() {
    let single = table("throttle,thrust_n,torque_nm", |u, f| {
        format!("{u},{f},{}", 0.02 * f)
    });
    let both = table("throttle,thrust_n", |u, f| format!("{u},{}", 1.56 * f));
    let wide = table("throttle,thrust_n", |u, f| format!("{u},{}", 2.4 * f));
    let how = |both: bool| {
        let preparation = Preparation {
            is_correction: both,
            ..own().preparation
        };
        Prediction {
            run: own(),
            map: Settings { preparation, ..own() },
            ..Prediction::default()
        }
    };
    let found = predict(&single, None, std::slice::from_ref(&both), &how(true)).expect("a pair");
    assert!(
        found.report.contains("7 rows of equal throttles"),
        "{}",
        found.report
    );
    let percent = found.found.pair.uncertainty.thrust_percent;
    let before = predict(&single, None, &[], &how(true))
        .expect("a pair")
        .found
        .pair
        .uncertainty;
    assert!(percent < before.thrust_percent, "{percent}");
    // One rotor for two, and two of another size.
    let net = table("throttle,thrust_n,torque_nm", |u, f| {
        format!("{u},{f},{}", 0.001 * f)
    });
    for rows in [&net, &single, &wide] {
        let refused = predict(&single, None, std::slice::from_ref(rows), &how(true)).expect_err("no pair");
        assert!(refused[0].reason.contains("the rows miss"), "{}", refused[0]);
    }
    // A run of both rotors is none of one: their own columns say so, and a net torque near zero.
    let rotor_columns = table("throttle,upper_thrust_n,lower_thrust_n", |u, f| {
        format!("{u},{f},{}", 0.6 * f)
    });
    let net = table("throttle,thrust_n,torque_nm", |u, f| {
        format!("{u},{},{}", 1.56 * f, 0.001 * f)
    });
    for run in [&rotor_columns, &net] {
        let refused = predict(run, None, &[], &how(true)).expect_err("both rotors");
        assert!(
            refused[0].needed.contains("identify table.csv --prior"),
            "{}",
            refused[0]
        );
    }
}

/// Units and diameters that no rotor has, and two propellers in one table.
#[test]
fn an_impossible_rotor_is_refused_and_a_bad_curve_widens_the_band() {
    let of = |run: &Text, diameter: f64| {
        let known = RunFacts {
            diameter_m: Some(diameter),
            ..RunFacts::default()
        };
        let how = Prediction {
            run: own(),
            known,
            ..Prediction::default()
        };
        predict(run, None, &[], &how)
    };
    let right = table("throttle,thrust_n,torque_nm", |u, f| {
        format!("{u},{f},{}", 0.02 * f)
    });
    assert!(of(&right, 0.4).is_ok());
    for diameter in [0.04, 4.0, 40.0] {
        assert!(of(&right, diameter).is_err(), "{diameter}");
    }
    for (thrust, torque) in [(102.0, 0.02), (1.0, 2.0), (1.0, 0.0002), (0.102, 0.02)] {
        let wrong = table("throttle,thrust_n,torque_nm", |u, f| {
            format!("{u},{},{}", thrust * f, torque * f)
        });
        assert!(of(&wrong, 0.4).is_err(), "{thrust} {torque}");
    }
    let two = table("throttle,thrust_n", |u, f| format!("{u},{f}\n{u},{}", 1.12 * f));
    let found = of(&two, 0.4).expect("a pair").found;
    let missed = found.runs[0].misfit_percent[0].expect("a misfit");
    assert!(
        missed > 2.0 && found.pair.uncertainty.thrust_percent > missed,
        "{missed}"
    );
}
