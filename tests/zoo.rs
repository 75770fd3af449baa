//! The zoo of frames: what it has, and that the compiler takes it.
#![allow(missing_docs)]

use std::collections::BTreeMap;

use mixer_compiler::Source;
use mixer_compiler::diagnostic::Severity;
use mixer_tests::frames;
use mixer_tests::frames::zoo::REFUSALS;

/// Frames that are drawn: each class a dozen times at least.
const COUNT: u64 = 144;

/// At most one frame in so many may be refused.
const REFUSED: usize = 20;

/// Frames are what users have: the compiler takes nearly all, and refuses the others with a code
/// that says why.
#[test]
fn nearly_all_frames_compile_and_the_others_are_refused_for_a_reason() {
    let zoo = frames::zoo(number("MIXER_SEED", 1)).expect("airframes/");
    let mut refused = BTreeMap::new();
    let count = number("MIXER_COUNT", COUNT);
    for index in 0..count {
        let specimen = zoo.specimen(index);
        let source = Source::new("zoo.toml", specimen.text.as_str());
        let Err(faults) = mixer_compiler::compile(&source) else {
            continue;
        };
        for fault in faults
            .faults()
            .iter()
            .filter(|fault| fault.code.severity() == Severity::Error)
        {
            if std::env::var_os("MIXER_MISSES").is_some() {
                println!("{index}, {}: {} {}", specimen.class, fault.code, fault.message);
            }
            let is_expected = REFUSALS.contains(&fault.code);
            assert!(is_expected, "{faults}\n{}", specimen.text);
            *refused.entry(fault.code).or_insert(0) += 1;
        }
    }
    println!("of {count} frames: {refused:?}");
    let sum: usize = REFUSALS.iter().filter_map(|code| refused.get(code)).sum();
    assert!(sum * REFUSED <= count as usize, "{refused:?} of {count}");
}

/// A frame follows from the seed and its index alone.
#[test]
fn frames_are_drawn_by_index() {
    let [zoo, again, other] = [1, 1, 2].map(|seed| frames::zoo(seed).expect("airframes/"));
    let third = zoo.specimen(3).text;
    let _ = again.specimen(7);
    assert_eq!(again.specimen(3).text, third);
    assert_ne!(other.specimen(3).text, third);
    assert_ne!(zoo.specimen(15).text, third);
}

/// The number that an environment variable is set to, else `default`.
fn number(variable: &str, default: u64) -> u64 {
    let set = std::env::var(variable);
    set.map_or(default, |text| {
        text.parse().unwrap_or_else(|_| panic!("{variable} is a number"))
    })
}
