//! Airframes side by side.

use super::*;

#[test]
fn airframes_are_compared_side_by_side() {
    let output = run(&[
        "compare",
        X8,
        "airframes/coaxial-bicopter.toml",
        "airframes/single-pair.toml",
    ]);
    assert_status(&output, 0);
    let text = stdout(&output);
    let row = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name));
        line.unwrap_or_else(|| panic!("no {name} in {text}"))
    };
    assert_eq!(
        text.lines()
            .next()
            .unwrap()
            .split_whitespace()
            .collect::<Vec<_>>(),
        ["isae-x8", "coaxial-bicopter", "single-pair"]
    );
    assert_eq!(
        row("rotors").split_whitespace().collect::<Vec<_>>(),
        ["rotors", "8", "4", "2"]
    );
    assert_eq!(row("  pitch (N m)").matches("not served").count(), 2, "{text}");
    assert!(
        row("warnings")
            .split_whitespace()
            .skip(1)
            .all(|count| count == "0"),
        "{text}"
    );
    // All rows are aligned.
    let width = row("rotors").chars().count();
    assert!(text.lines().all(|line| line.chars().count() == width), "{text}");
}

#[test]
fn compare_needs_two_good_files() {
    assert_status(&run(&["compare", X8]), 2);
    assert_status(&run(&["compare", X8, FAULTY]), 1);
}
