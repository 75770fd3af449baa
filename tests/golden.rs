//! Every airframe compiles to its golden outputs, byte for byte.
#![allow(missing_docs)]

use std::collections::BTreeMap;
use std::fs;

use cargo_mixer::commands::golden::compare;
use mixer_files::golden::outputs;
use mixer_files::vectors::{self, Vector, VectorKind};
use mixer_rt::{Conditions, Health, Wrench};
use mixer_tests::frames;
use mixer_tests::physics::Physics;
use mixer_tests::{airframes, golden, root, toml_names};

#[path = "firmware/src/bin/vectors/harness.rs"]
mod harness;

const MEND: &str = "if the change is meant, `cargo mixer golden airframes/*.toml -o tests/golden --force`, `git clean -fX tests/golden`, \
     remove the files that are called orphans, and look at the difference";

/// Of generated Rust one text of each kind is held: a closed form, another with air and least power, five units and more, single
/// rotors. Of all airframes the bits are. `tests/golden/.gitignore` has the same names.
const TEXTS: [&str; 4] = [
    "isae-x8.rs",
    "x8-11in-least-power.rs",
    "px4-x12.rs",
    "hexa-stacked.rs",
];

#[test]
fn airframes_compile_to_their_golden_outputs() {
    let mut outputs = golden::outputs().unwrap_or_else(|e| panic!("{e}"));
    outputs.retain(|file, _| !file.ends_with(".rs") || TEXTS.contains(&file.as_str()));
    let differences = compare::differences(&golden::folder(), &outputs).unwrap_or_else(|e| panic!("{e}"));
    assert!(differences.is_empty(), "{}\n{MEND}", differences.join("\n"));
}

/// What no shipped airframe has is held by the vectors of `tests/fixtures`: steep facets, reserves, yaw before thrust, least
/// power without a closed form. `MIXER_BLESS=1` writes them.
#[test]
fn fixtures_give_their_golden_vectors() {
    let fixtures = root().join("tests/fixtures");
    let folder = fixtures.join("golden");
    let mut vectors = BTreeMap::new();
    for name in toml_names("tests/fixtures").expect("tests/fixtures") {
        let text = fs::read_to_string(fixtures.join(format!("{name}.toml"))).expect("text");
        let compiled = frames::compile_text(&text).unwrap_or_else(|e| panic!("{e}"));
        let tables = outputs(&compiled).into_iter();
        vectors.extend(tables.filter(|(file, _)| file.ends_with(".csv")));
    }
    if std::env::var_os("MIXER_BLESS").is_some() {
        for (file, content) in &vectors {
            fs::write(folder.join(file), content).expect("tests/fixtures/golden");
        }
    }
    let differences = compare::differences(&folder, &vectors).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        differences.is_empty(),
        "{}\nif the change is meant, MIXER_BLESS=1",
        differences.join("\n")
    );
}

/// The same text gives the same bytes, also in one process and whatever was compiled before.
#[test]
fn compilation_is_deterministic() {
    let outputs = |name| outputs(&golden::compile(name).unwrap_or_else(|e| panic!("{e}")));
    let once = outputs("isae-x8");
    let _ = outputs("px4-y6");
    assert_eq!(once, outputs("isae-x8"));
}

mod isae_x8 {
    mixer_macros::airframe!("../airframes/isae-x8.toml");
    pub(super) use isae_x8::mix;
}

mod thin_air {
    mixer_macros::airframe!("../airframes/x8-11in-least-power.toml");
    pub(super) use x8_11in_least_power::mix;
}

/// A row with another number in a cell.
fn altered(row: &str, cell: usize) -> String {
    let cells = row.split(',').enumerate();
    let cells: Vec<&str> = cells
        .map(|(k, value)| if k == cell { "0x3dcccccc" } else { value })
        .collect();
    cells.join(",")
}

/// The harness that users copy to the target counts every row whose bits differ.
#[test]
fn the_harness_for_the_target_counts_what_differs() {
    let table = include_str!("golden/isae-x8.vectors.csv");
    assert_eq!(harness::differing(table, isae_x8::mix), 0);
    let mut rows: Vec<String> = table.lines().map(str::to_owned).collect();
    let last = rows[0].split(',').count() - 1;
    for (row, cell) in [(4, 5), (201, last - 1), (454, last)] {
        rows[row] = altered(&rows[row], cell);
    }
    assert_eq!(harness::differing(&rows.join("\n"), isae_x8::mix), 3);

    let table = include_str!("golden/isae-x8.rotors-out.csv");
    let without = |setpoint: &Wrench, conditions: Conditions, _| isae_x8::mix(setpoint, conditions);
    let all = harness::rows(table).count();
    assert_eq!(harness::differing_with_rotors_out(table, without), all);
}

/// A mixer that takes the bench's density for the present one gives other bits than the golden vectors.
#[test]
fn a_mixer_that_ignores_the_density_differs() {
    let table = include_str!("golden/x8-11in-least-power.vectors.csv");
    assert_eq!(harness::differing(table, thin_air::mix), 0);
    let ignoring = |setpoint: &Wrench, conditions: Conditions| thin_air::mix(setpoint, conditions.voltage_v);
    let (all, differing) = (harness::rows(table).count(), harness::differing(table, ignoring));
    assert!(differing > all / 3, "{differing} of {all}");
}

/// Every kind of vector is what it says.
#[test]
fn golden_vectors_cover_what_they_should() {
    for name in airframes().expect("airframes/") {
        let compiled = golden::compile(&name).unwrap_or_else(|e| panic!("{e}"));
        let physics = Physics::new(&compiled);
        let is_saturated = |(setpoint, conditions): &Vector| {
            let mixed = compiled
                .tables
                .mix_with_health(setpoint, *conditions, Health::GOOD);
            let (.., saturation) = mixed.expect("finite");
            saturation.any_axis()
        };
        let needs_null_space = |(setpoint, conditions): &Vector| {
            let wrench = setpoint.to_array().map(f64::from);
            let factors = physics.factors_in(conditions.voltage_v, conditions.density_kg_m3);
            !physics.least_norm_attains(wrench, factors)
        };
        let (mut all, mut all_saturated) = (0, 0);
        for (kind, list) in vectors::by_kind(&compiled) {
            let saturated = list.iter().filter(|vector| is_saturated(vector)).count();
            println!("{name} {kind:?}: {saturated} of {} saturated", list.len());
            all += list.len();
            all_saturated += saturated;
            match kind {
                VectorKind::ByHand => assert!((20..list.len()).contains(&saturated), "{name} {kind:?}"),
                VectorKind::Attainable => {
                    assert_eq!(saturated, 0, "{name} {kind:?}");
                    let helped = list.iter().filter(|vector| needs_null_space(vector)).count();
                    println!("{name} {kind:?}: {helped} need the null space");
                    // As many rotors as axes have no freedom.
                    let airframe = &compiled.airframe;
                    let is_free = airframe.rotors() > airframe.allocation.axes.len();
                    let expected = if is_free { 20 } else { 0 };
                    assert!(helped >= expected, "{name} {kind:?}: {helped}");
                }
                // Those outside are a third; of two steps inside, the lesser may be within the error of
                // the sides.
                VectorKind::Border => assert!(
                    (list.len() / 3..=2 * list.len() / 3).contains(&saturated),
                    "{name} {kind:?}: {saturated}"
                ),
                // A part of the random ones is attainable.
                VectorKind::Saturated => {
                    assert!(5 * saturated >= 4 * list.len(), "{name} {kind:?}: {saturated}")
                }
                // Thrust of 40 % of the ceiling and roll, pitch and yaw of next to nothing are
                // delivered.
                VectorKind::Faint => assert!(saturated >= 18, "{name} {kind:?}: {saturated}"),
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
