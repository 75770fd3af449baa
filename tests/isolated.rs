//! The mixers for comparison, `isolated_rotors`, against the oracle's of the same rules in
//! double precision.
#![allow(missing_docs)]

use std::fs;
use std::path::Path;
use std::process::Command;

use isolated_rotors::IsolatedTables;
use mixer_rt::{Wrench, tables::Airmode};
use mixer_tests::{golden, root};

/// Frames of one to six units. X8s that differ by their pair alone differ by two numbers here.
const AIRFRAMES: [&str; 6] = [
    "coaxial-bicopter",
    "isae-x8",
    "px4-x12",
    "px4-y6",
    "single-pair",
    "x8-22in-cubic",
];
/// Random setpoints per airframe.
const SETPOINTS: &str = "200";
/// The oracle prints seven decimals; a throttle is an f32 of thrusts up to some hundred newtons.
const TOLERANCE: f64 = 5e-6;

fn oracle(arguments: &[&str]) -> String {
    let output = Command::new("python3")
        .arg(root().join("tests/oracle.py"))
        .args(arguments)
        .current_dir(root())
        .output()
        .unwrap_or_else(|error| panic!("the oracle needs python3 (3.11 or later): {error}"));
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("CSV is UTF-8")
}

fn rows(csv: &str) -> impl Iterator<Item = Vec<f64>> {
    csv.lines().skip(1).map(|line| {
        line.split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect()
    })
}

#[test]
fn isolated_rotors_are_mixed_as_the_oracle_does() {
    let mut faults = Vec::new();
    for airframe in AIRFRAMES {
        let path = format!("airframes/{airframe}.toml");
        let tables = IsolatedTables::new(&golden::compile(airframe).unwrap_or_else(|e| panic!("{e}")));
        let asked = oracle(&["draw", &path, SETPOINTS, "5"]);
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{airframe}.isolated.csv"));
        fs::write(&file, &asked).expect("scratch folder");
        for method in ["conventional", "disabled", "roll-pitch", "roll-pitch-yaw"] {
            let expected = oracle(&["isolated", &path, method, &file.display().to_string()]);
            let (worst, clipped) = compare(&tables, method, &asked, &expected);
            println!("{airframe:<20} {method:<16} worst {worst:.1e}, {clipped} of {SETPOINTS} clipped");
            if worst > TOLERANCE || clipped == 0 {
                faults.push(format!("{airframe}, {method}: {worst:e}, {clipped} clipped"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Largest difference of a throttle over setpoints and expected throttles as CSV, and how many rows
/// were clipped.
fn compare(tables: &IsolatedTables, method: &str, asked: &str, expected: &str) -> (f64, usize) {
    let (mut worst, mut clipped) = (0.0f64, 0);
    for (request, expected) in rows(asked).zip(rows(expected)) {
        let [roll, pitch, yaw, thrust, volts] = request[..] else {
            panic!("not a setpoint: {request:?}")
        };
        let setpoint = Wrench::from_array([roll, pitch, yaw, thrust].map(|value| value as f32));
        let mixed = match method {
            "conventional" => tables.conventional(&setpoint, volts as f32),
            "disabled" => tables.sequential(Airmode::Disabled, &setpoint, volts as f32),
            "roll-pitch" => tables.sequential(Airmode::RollPitch, &setpoint, volts as f32),
            "roll-pitch-yaw" => tables.sequential(Airmode::RollPitchYaw, &setpoint, volts as f32),
            other => panic!("no method {other}"),
        };
        let (throttles, within) = mixed.expect("finite");
        assert_eq!(throttles.len(), expected.len());
        clipped += usize::from(!within);
        for (throttle, expected) in throttles.iter().zip(expected) {
            worst = worst.max((f64::from(*throttle) - expected).abs());
        }
    }
    (worst, clipped)
}

/// A request that isolated rotors can deliver is not touched by desaturation, and what is not
/// finite is refused.
#[test]
fn desaturation_leaves_alone_what_can_be_delivered() {
    let tables = IsolatedTables::new(&golden::compile("isae-x8").unwrap_or_else(|e| panic!("{e}")));
    for request in [[0.0, 0.0, 0.0, 40.0], [0.5, -0.3, 0.1, 35.0]] {
        let setpoint = Wrench::from_array(request);
        let (plain, within) = tables.conventional(&setpoint, 14.8).expect("finite");
        assert!(within);
        for airmode in [Airmode::Disabled, Airmode::RollPitch, Airmode::RollPitchYaw] {
            let (throttles, within) = tables.sequential(airmode, &setpoint, 14.8).expect("finite");
            assert!(within);
            for (a, b) in throttles.iter().zip(&plain) {
                assert!((a - b).abs() < 1e-6, "{airmode:?}: {throttles:?} {plain:?}");
            }
        }
    }
    let bad = Wrench {
        yaw_nm: f32::NAN,
        ..Wrench::default()
    };
    assert!(tables.conventional(&bad, 14.8).is_err());
    assert!(tables.sequential(Airmode::Disabled, &bad, 14.8).is_err());
}
