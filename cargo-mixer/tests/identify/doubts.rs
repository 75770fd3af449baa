//! What a fit may hide: files of different pairs, throttles that were not measured.

use mixer_identify::identified::{Identified, from_benches};

use mixer_compiler::airframe::Basis;
use mixer_identify::paper::{THRUST, TORQUE};

use crate::sweep::{Row, bench, plain, rows, rows_of, settings};

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

fn of_text(text: &str) -> Identified {
    let bench = bench("b.csv", text.as_bytes(), &settings(None)).expect("a bench");
    from_benches(vec![bench], &settings(None).wishes).expect("a pair")
}

#[test]
fn a_missing_tare_is_told() {
    let told = "set the load cell to zero";
    let of = |offset: f64| {
        let mut rows = rows(4);
        for row in &mut rows {
            row.thrust[0] += offset;
        }
        identified(&[rows])
    };
    assert!(!warns(&of(0.0), told));
    assert!(warns(&of(0.5), told), "{:?}", of(0.5).warnings);
}

#[test]
fn exchanged_rotors_are_told_and_the_paper_s_are_asked_about() {
    let told = |torque: [f64; 8]| {
        let rows = rows_of(Basis::Biquadratic, [&THRUST, &torque], 5);
        identified(&[rows])
    };
    let (exchanged, ask) = (
        "look exchanged",
        "make sure that the columns are the right way round",
    );
    // The paper's own pair is between; a little less torque of the lower rotor settles it.
    let paper = told(TORQUE);
    assert!(
        warns(&paper, ask) && !warns(&paper, exchanged),
        "{:?}",
        paper.warnings
    );
    let mut wake = TORQUE;
    wake[6] -= 0.04;
    let real = told(wake);
    assert!(
        !warns(&real, ask) && !warns(&real, exchanged),
        "{:?}",
        real.warnings
    );
    let mut other = TORQUE;
    other[6] += 0.04;
    assert!(warns(&told(other), exchanged));
}

#[test]
fn a_row_without_supply_is_named_and_left_out() {
    let mut text = String::from_utf8(plain(&rows(1))).expect("text");
    text.push_str(".33,.44,6.0,0.01,0\n.35,.44,6.0,0.01,0.2\n");
    let bench = bench("b.csv", text.as_bytes(), &settings(None)).expect("a bench");
    let refused: Vec<(u64, &str)> = bench
        .refused_rows
        .iter()
        .map(|row| (row.line, row.reason.as_str()))
        .collect();
    assert_eq!(
        refused,
        [
            (102, "the voltage is 0 V, in the middle of the rows 14.8 V"),
            (103, "the voltage is 0.2 V, in the middle of the rows 14.8 V")
        ]
    );
    assert_eq!(bench.points_used, 100);
}

#[test]
fn voltages_that_were_not_recorded_are_told() {
    let text = String::from_utf8(plain(&rows(1)))
        .expect("text")
        .replace(",14.8\n", ",0\n");
    let told = of_text(&text);
    assert!(
        told.files[0]
            .notes
            .iter()
            .any(|note| note.contains("taken as not measured"))
    );
    assert!(told.voltage.is_none());
}

#[test]
fn a_total_that_is_no_sum_is_told() {
    let of = |by: f64| {
        let mut text =
            String::from("upper,lower,thrust upper (N),thrust lower (N),total thrust (N),torque_nm\n");
        for row in rows(1) {
            let [a, b] = row.thrust;
            let torque: f64 = row.torque.iter().sum();
            text += &format!("{},{},{a},{b},{},{torque}\n", row.u, row.l, by * (a + b));
        }
        of_text(&text).files[0].notes.join("; ")
    };
    assert!(!of(1.0).contains("differs from the sum"), "{}", of(1.0));
    assert!(
        of(2.0).contains("total thrust differs from the sum"),
        "{}",
        of(2.0)
    );
}
