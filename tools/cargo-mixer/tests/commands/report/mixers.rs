//! The static comparison of both mixers.

use mixer_files::report::comparison::Comparison;
use mixer_files::report::number::range;
use mixer_files::report::study::Study;

use super::x8;

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
