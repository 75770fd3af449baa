//! A short soak: every answer of some frames of the zoo is held to the physics, as `cargo
//! soak` does for hours. And what a soak must find is found.
#![allow(missing_docs)]

use mixer_compiler::Compiled;
use mixer_tests::frames;
use mixer_tests::frames::zoo::{Specimen, Zoo};
use mixer_tests::request::Frame;
use mixer_tests::soak::limits::Check;
use mixer_tests::soak::{Failure, Soak};

const SEED: u64 = 1;

/// Each class at least once.
const FRAMES: u64 = 12;

#[test]
fn answers_of_the_zoo_are_those_of_the_physics() {
    answers_are_those_of_the_physics(SEED, frames::zoo(SEED).expect("airframes/"));
}

#[test]
fn answers_of_unlike_pairs_are_those_of_the_physics() {
    const OTHERS: u64 = 4;
    answers_are_those_of_the_physics(OTHERS, frames::zoo(OTHERS).expect("airframes/").unlike());
}

#[test]
fn answers_with_single_rotors_are_those_of_the_physics() {
    const OTHERS: u64 = 5;
    let zoo = frames::zoo(OTHERS).expect("airframes/").with_single_rotors();
    answers_are_those_of_the_physics(OTHERS, zoo);
}

fn answers_are_those_of_the_physics(seed: u64, zoo: Zoo) {
    let mut soak = Soak::new(zoo, seed);
    let mut failures = Vec::new();
    for index in 0..FRAMES {
        failures.extend(soak.frame(index).expect("solved"));
    }
    failures.extend(soak.misses().cloned());
    println!("{soak}");
    for Failure {
        check,
        index,
        said,
        requests,
        ..
    } in &failures
    {
        println!("{check}, frame {index}: {said}, {requests:?}");
    }
    assert!(failures.is_empty(), "{} failures", failures.len());
    assert!(soak.mixes() > 20_000, "{} mixes", soak.mixes());
}

/// A regular frame without a closed form.
fn specimen() -> (Specimen, Compiled) {
    let zoo = frames::zoo(SEED).expect("airframes/");
    let specimens = (0..).map(|index| zoo.specimen(12 * index));
    let compiled = specimens.filter_map(|specimen| {
        let compiled = frames::compile_text(&specimen.text).ok()?;
        Some((specimen, compiled))
    });
    let mut whole = compiled.filter(|(_, compiled)| {
        let airframe = &compiled.airframe;
        airframe.units.len() == 6 && airframe.allocation.axes.len() == 4 && airframe.voltage.is_some()
    });
    whole.next().expect("endless")
}

/// What a soak of the frame finds after `spoil`.
fn found(spoil: impl FnOnce(&mut Compiled)) -> Vec<Check> {
    let (specimen, mut compiled) = specimen();
    spoil(&mut compiled);
    let mut soak = Soak::new(frames::zoo(SEED).expect("airframes/"), SEED);
    // Linear programmes judge every fourth index: not this one.
    let failures = soak.mix(&specimen, 1, &Frame::new(compiled)).expect("solved");
    let rare = soak.misses().map(|failure| failure.check);
    let mut checks: Vec<Check> = failures.iter().map(|failure| failure.check).chain(rare).collect();
    checks.dedup();
    checks
}

#[test]
fn planted_faults_are_found() {
    assert_eq!(found(|_| {}), []);
    let wrong_share = found(|compiled| {
        compiled.effectiveness.pseudo_inverse *= 1.0 + 1e-9;
    });
    assert_eq!(wrong_share, [Check::PseudoInverse]);
    let short = found(|compiled| {
        for unit in &mut compiled.tables.units {
            let shares = unit.allocation.iter_mut().flatten();
            shares.for_each(|share| *share *= 0.95);
        }
    });
    assert!(short.contains(&Check::Delivered), "{short:?}");
    // The tables against another file is the same as other tables against the file.
    let wrong_place = found(|compiled| compiled.airframe.units[0].position_m[0] += 1e-4);
    assert!(wrong_place.contains(&Check::Effectiveness), "{wrong_place:?}");
    assert!(wrong_place.contains(&Check::Truth), "{wrong_place:?}");
    let wrong_spin = found(|compiled| {
        let unit = &mut compiled.airframe.units[1];
        unit.upper_spin = unit.upper_spin.reversed();
    });
    assert!(wrong_spin.contains(&Check::Truth), "{wrong_spin:?}");
    let wrong_channel = found(|compiled| {
        let unit = &mut compiled.airframe.units[2];
        let lower = unit.lower_channel.expect("a pair");
        unit.lower_channel = Some(std::mem::replace(&mut unit.upper_channel, lower));
    });
    assert!(wrong_channel.contains(&Check::Truth), "{wrong_channel:?}");
    let wrong_range = found(|compiled| compiled.airframe.throttle.max -= 0.05);
    assert!(wrong_range.contains(&Check::Throttle), "{wrong_range:?}");
    let wrong_flag = found(|compiled| {
        let voltage = compiled.airframe.voltage.as_mut().expect("a law");
        voltage.range[0] -= 1.0;
    });
    assert!(wrong_flag.contains(&Check::Flag), "{wrong_flag:?}");
}

/// A failure says how to see it again.
#[test]
fn failures_are_reported_with_what_reproduces_them() {
    let (specimen, mut compiled) = specimen();
    compiled.airframe.throttle.max -= 0.05;
    let mut soak = Soak::new(frames::zoo(SEED).expect("airframes/"), SEED);
    let failures = soak.mix(&specimen, 7, &Frame::new(compiled)).expect("solved");
    let failure = failures.iter().find(|failure| failure.check == Check::Throttle);
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("soak");
    let report = failure
        .expect("a throttle above the limit")
        .report(&folder)
        .expect("written");
    let file = folder.join("7.toml");
    assert!(report.starts_with("throttle: "), "{report}");
    assert!(
        report.contains(&format!("| cargo mixer mix {}\n", file.display())),
        "{report}"
    );
    assert_eq!(
        std::fs::read_to_string(file).expect("the airframe"),
        specimen.text
    );
}
