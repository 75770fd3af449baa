//! The static comparison of both mixers, and the conventional one against an independent oracle.

use std::fs;
use std::process::Command;

use isolated_rotors::IsolatedTables;
use mixer_report::comparison::{self, Comparison};
use mixer_report::number::range;
use mixer_report::study::Study;

use super::{compiled, root, scratch, x8};

/// The largest yaw that four units give at 10 N each, N m: twice Q_max - Q_min there (0.644).
const YAW_AT_10_N: f64 = 0.643;

#[test]
fn the_coaxial_mixer_keeps_every_unit_s_thrust_and_the_conventional_one_does_not() {
    let compiled = x8();
    let study = Study::new(&compiled, None);
    assert_eq!(study.thrust_n, 40.0);
    let comparison = Comparison::sweep(&study, 41).unwrap();
    let tolerance = compiled.airframe.inverse.thrust_tolerance_n;
    let (first, last) = (&comparison.rows[0], &comparison.rows[40]);
    assert!(
        first.yaw_nm < -0.5 && last.yaw_nm > 0.5,
        "{} {}",
        first.yaw_nm,
        last.yaw_nm
    );
    let mut spread = 0.0f64;
    let mut constant = 0;
    for row in &comparison.rows {
        assert!(row.coaxial.within);
        assert!((row.coaxial.wrench[3] - 40.0).abs() <= 4.0 * tolerance);
        let missed = (row.coaxial.wrench[2] - row.yaw_nm).abs();
        if row.yaw_nm.abs() > YAW_AT_10_N {
            // Given with unequal thrusts, by the null space of M; the sweep ends where yaw
            // saturates.
            assert!(missed <= 1e-3, "{missed} N m at {} N m", row.yaw_nm);
            continue;
        }
        assert!(missed <= 4.0 * 1e-4, "{missed} N m at {} N m", row.yaw_nm);
        constant += 1;
        for [f, _] in &row.coaxial.efforts {
            assert!((f - 10.0).abs() <= tolerance, "{f} N at {} N m", row.yaw_nm);
        }
        let thrusts = row.conventional.efforts.iter().map(|[f, _]| *f);
        let [low, high] = range(thrusts);
        spread = spread.max(high - low);
        // The lower rotor works in the wake of the upper one, which this mixer does not know.
        assert!(row.conventional.wrench[3] < 37.5, "{:?}", row.conventional.wrench);
        if row.conventional.within {
            assert!(row.conventional.wrench[3] < 36.0, "{:?}", row.conventional.wrench);
        }
    }
    assert!(constant >= 30, "{constant}");
    assert!(spread > 1.5, "{spread}");
}

#[test]
fn the_conventional_mixer_is_the_oracle_s() {
    let asked = [
        [0.0, 0.0, 0.0, 31.4],
        [0.0, 0.0, 0.3, 31.4],
        [0.5, 0.0, 0.0, 31.4],
        [1.0, -0.5, 0.2, 40.0],
        [0.2, 0.1, -0.4, 55.0],
    ];
    let mut rows = String::from("roll_nm,pitch_nm,yaw_nm,thrust_n\n");
    for [roll, pitch, yaw, thrust] in asked {
        rows.push_str(&format!("{roll},{pitch},{yaw},{thrust}\n"));
    }
    let setpoints = scratch("setpoints.csv");
    fs::write(&setpoints, rows).unwrap();
    for name in ["isae-x8", "px4-y6", "px4-x12", "coaxial-bicopter"] {
        let airframe = root().join(format!("airframes/{name}.toml"));
        let output = Command::new("python3")
            .arg(root().join("tests/oracle.py"))
            .arg("conventional")
            .args([&airframe, &setpoints])
            .output()
            .unwrap_or_else(|error| panic!("the oracle needs python3 (3.11 or later): {error}"));
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let compiled = compiled(&airframe);
        let study = Study::new(&compiled, None);
        let conventional = IsolatedTables::new(&compiled);
        let text = String::from_utf8(output.stdout).unwrap();
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(lines.len(), asked.len());
        for (line, asked) in lines.iter().zip(asked) {
            let expected: Vec<f64> = line
                .split(',')
                .skip(4)
                .map(|cell| cell.parse().unwrap())
                .collect();
            let (throttles, _) = comparison::throttles(&study, &conventional, asked);
            let efforts: Vec<[f64; 2]> = throttles.iter().map(|&pair| study.pair.efforts(pair)).collect();
            for (given, expected) in study.wrench(&efforts).iter().zip(expected) {
                // The oracle prints four decimals.
                assert!(
                    (given - expected).abs() < 6e-5,
                    "{name}, {asked:?}: {given} is not {expected}"
                );
            }
        }
    }
}
