//! Every airframe compiles to its golden outputs, byte for byte.
#![allow(missing_docs)]

use std::collections::BTreeSet;
use std::fs;

use mixer_tests::{airframes, golden};

const MEND: &str =
    "if the change is meant, `cargo run -p mixer-tests --bin bless` and look at the difference";

#[test]
fn airframes_compile_to_their_golden_outputs() {
    let mut faults = Vec::new();
    let mut expected = BTreeSet::new();
    for name in airframes().expect("airframes/") {
        for (file, content) in golden::outputs(&name).unwrap_or_else(|e| panic!("{e}")) {
            match fs::read_to_string(golden::folder().join(&file)) {
                Ok(held) if held == content => {}
                Ok(held) => {
                    let place = held
                        .lines()
                        .zip(content.lines())
                        .position(|(held, now)| held != now);
                    let line = place.unwrap_or_else(|| held.lines().count().min(content.lines().count()));
                    faults.push(format!(
                        "{file}:{}: was `{}`, is `{}`",
                        line + 1,
                        held.lines().nth(line).unwrap_or(""),
                        content.lines().nth(line).unwrap_or("")
                    ));
                }
                Err(error) => faults.push(format!("{file}: {error}")),
            }
            expected.insert(file);
        }
    }
    for entry in fs::read_dir(golden::folder()).expect("tests/golden/") {
        let file = entry
            .expect("tests/golden/")
            .file_name()
            .to_string_lossy()
            .into_owned();
        if !expected.contains(&file) {
            faults.push(format!("{file}: an orphan, no airframe of that name"));
        }
    }
    assert!(faults.is_empty(), "{}\n{MEND}", faults.join("\n"));
}

/// The same text gives the same bytes, also in one process and whatever was compiled before.
#[test]
fn compilation_is_deterministic() {
    let once = golden::outputs("isae-x8").expect("isae-x8");
    let _ = golden::outputs("px4-y6").expect("px4-y6");
    assert_eq!(once, golden::outputs("isae-x8").expect("isae-x8"));
}

/// No vector is lost on the way into the table.
#[test]
fn golden_vectors_cover_what_they_should() {
    for name in airframes().expect("airframes/") {
        let compiled = golden::compile(&name).unwrap_or_else(|e| panic!("{e}"));
        let setpoints = mixer_tests::vectors::setpoints(&compiled);
        let saturated = setpoints
            .iter()
            .map(|(setpoint, v)| compiled.tables.mix(setpoint, *v).expect("finite").2.any_axis())
            .filter(|saturated| *saturated)
            .count();
        assert!(setpoints.len() >= 300, "{name}: {}", setpoints.len());
        let share = saturated as f64 / setpoints.len() as f64;
        assert!(
            (0.2..0.8).contains(&share),
            "{name}: {share} of the vectors saturate"
        );
    }
}
