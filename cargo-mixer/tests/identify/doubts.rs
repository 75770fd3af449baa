//! What a fit may hide: files of different pairs, throttles that were not measured.

use mixer_identify::identified::{Identified, from_benches};

use crate::sweep::{Row, bench, plain, rows, settings};

fn identified(sweeps: &[Vec<Row>]) -> Identified {
    let benches = sweeps
        .iter()
        .enumerate()
        .map(|(k, rows)| bench(&format!("{k}.csv"), &plain(rows), &settings(None)).expect("a bench"))
        .collect();
    from_benches(benches, &settings(None).wishes).expect("a pair")
}

fn warns(identified: &Identified, of: &str) -> bool {
    identified.warnings.iter().any(|warning| warning.contains(of))
}

/// The second pair gives more thrust, by so much.
fn stronger(mut rows: Vec<Row>, by: f64) -> Vec<Row> {
    for row in &mut rows {
        row.thrust = row.thrust.map(|thrust| by * thrust);
    }
    rows
}

#[test]
fn files_of_different_pairs_are_told() {
    let files = "the files differ from their common map by";
    assert!(!warns(&identified(&[rows(1), rows(2)]), files), "repeats");
    assert!(
        !warns(&identified(&[rows(1), stronger(rows(2), 1.01)]), files),
        "another day"
    );
    assert!(
        warns(&identified(&[rows(1), stronger(rows(2), 1.06)]), files),
        "another propeller"
    );
}

#[test]
fn throttles_that_were_not_measured_are_told() {
    let (low, full) = ("with a rotor out the map is extrapolated", "is never commanded");
    let whole = identified(&[rows(3)]);
    assert!(
        !warns(&whole, low) && !warns(&whole, full),
        "{:?}",
        whole.warnings
    );
    let of = |range: std::ops::RangeInclusive<f64>| {
        let within = |row: &Row| range.contains(&row.u) && range.contains(&row.l);
        identified(&[rows(3).into_iter().filter(within).collect()])
    };
    assert!(warns(&of(0.35..=1.1), low));
    let part = of(0.0..=0.85);
    assert!(warns(&part, full) && !warns(&part, low), "{:?}", part.warnings);
}
