//! Every airframe compiles to its golden outputs, byte for byte.
#![allow(missing_docs)]

use std::collections::BTreeMap;

use cargo_mixer::golden::compare;
use mixer_rt::Wrench;
use mixer_tests::vectors::{self, Kind};
use mixer_tests::{airframes, golden};

const MEND: &str =
    "if the change is meant, `cargo run -p mixer-tests --bin bless` and look at the difference";

#[test]
fn airframes_compile_to_their_golden_outputs() {
    let mut outputs = BTreeMap::new();
    for name in airframes().expect("airframes/") {
        outputs.extend(golden::outputs(&name).unwrap_or_else(|e| panic!("{e}")));
    }
    let differences = compare::differences(&golden::folder(), &outputs).unwrap_or_else(|e| panic!("{e}"));
    assert!(differences.is_empty(), "{}\n{MEND}", differences.join("\n"));
}

/// The same text gives the same bytes, also in one process and whatever was compiled before.
#[test]
fn compilation_is_deterministic() {
    let once = golden::outputs("isae-x8").expect("isae-x8");
    let _ = golden::outputs("px4-y6").expect("px4-y6");
    assert_eq!(once, golden::outputs("isae-x8").expect("isae-x8"));
}

/// No vector is lost on the way into the table, and every kind is what it says.
#[test]
fn golden_vectors_cover_what_they_should() {
    for name in airframes().expect("airframes/") {
        let compiled = golden::compile(&name).unwrap_or_else(|e| panic!("{e}"));
        let is_saturated = |(setpoint, voltage_v): &(Wrench, f32)| {
            let (.., saturation) = compiled.tables.mix(setpoint, *voltage_v).expect("finite");
            saturation.any_axis()
        };
        let kinds = vectors::by_kind(&compiled);
        let (mut all, mut all_saturated) = (0, 0);
        for (kind, list) in &kinds {
            let saturated = list.iter().filter(|vector| is_saturated(vector)).count();
            println!("{name} {kind:?}: {saturated} of {} saturated", list.len());
            all += list.len();
            all_saturated += saturated;
            match kind {
                Kind::Attainable => assert_eq!(saturated, 0, "{name} {kind:?}"),
                // Thrust of 40 % of the ceiling and roll, pitch and yaw of next to nothing are delivered.
                Kind::Faint => assert!(saturated >= 18, "{name} {kind:?}"),
                Kind::Alone | Kind::Together => assert_eq!(saturated, list.len(), "{name} {kind:?}"),
                // A third is beyond what is attainable.
                Kind::Edge => assert!(3 * saturated >= list.len(), "{name} {kind:?}"),
                Kind::NullSpace => {
                    assert_eq!(saturated, 0, "{name} {kind:?}");
                    // One unit has no freedom.
                    let expected = if compiled.airframe.units.len() > 1 { 20 } else { 0 };
                    assert!(list.len() >= expected, "{name} {kind:?}: {}", list.len());
                }
                Kind::ByHand | Kind::Ordinary | Kind::Excessive => assert!(!list.is_empty()),
            }
        }
        let share = f64::from(all_saturated as u32) / f64::from(all as u32);
        println!("{name}: {all} vectors, {:.0} % saturated", 100.0 * share);
        assert!((400..600).contains(&all), "{name}: {all}");
        assert!(
            (0.3..0.8).contains(&share),
            "{name}: {share} of the vectors saturate"
        );
    }
}
