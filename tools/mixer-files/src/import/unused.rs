//! Notes on settings of each rotor in a stack's parameters that the airframe file, with one pair for all, does not have.

use super::rotors::{Own, Rotor, Unit};

/// Relative difference of settings that are one.
const SAME: f64 = 0.01;

/// Pulse widths that differ by less are one, us.
const SAME_US: f64 = 2.0;

/// A note for each setting that differs between rotors and is not used.
///
/// # Errors
/// A rotor that the stack leaves out.
pub(super) fn notes(rotors: &[Rotor], units: &[Unit]) -> Result<Vec<String>, String> {
    let of = |channel: usize| rotors.iter().find(|rotor| rotor.channel == channel);
    let (mut layers, mut notes): ([Vec<&Rotor>; 3], _) = (Default::default(), Vec::new());
    for unit in units {
        let (first, lower) = unit.channels;
        layers[if lower.is_some() { 0 } else { 2 }].extend(of(first));
        layers[1].extend(lower.and_then(of));
    }
    if let Some(rotor) = rotors.iter().find(|rotor| rotor.own.thrust == 0.0) {
        return Err(format!(
            "{}: rotor {} has no thrust, and the stack leaves it out: every rotor of the airframe file turns",
            rotor.place, rotor.channel
        ));
    }
    for (name, layer) in ["upper", "lower", "single"].into_iter().zip(&layers) {
        notes.extend(different(name, layer, "thrusts", |own| own.thrust).map(|differ| {
            format!(
                "{differ}, and the file gives all of them one map: if they differ, name a `[[pair]]` or a `[[rotor]]` for each kind and \
                 write its name in every `[[unit]]`"
            )
        }));
        notes.extend(different(name, layer, "yaw factors", |own| own.yaw).map(|differ| {
            format!(
                "{differ}, which are not used: all of them get one torque, unless a `[[pair]]` or a `[[rotor]]` is named for each kind"
            )
        }));
    }
    let first = |k: usize| layers[k].first().map(|rotor| rotor.own);
    if let (Some(upper), Some(lower)) = (first(0), first(1))
        && (differ(upper.thrust, lower.thrust) || differ(upper.yaw, lower.yaw))
    {
        notes.push(format!(
            "thrust and yaw factors of upper and lower rotors differ ({}, {} and {}, {}) and are not used: the pair's map has the difference",
            upper.thrust, upper.yaw, lower.thrust, lower.yaw
        ));
    }
    let reversible: Vec<String> = rotors
        .iter()
        .filter(|rotor| rotor.own.is_reversible)
        .map(|rotor| rotor.channel.to_string())
        .collect();
    if !reversible.is_empty() {
        notes.push(format!(
            "rotors {} may turn backwards in the stack (CA_R_REV, feature 3D); in the mixer a rotor turns one way: switch that off",
            reversible.join(", ")
        ));
    }
    notes.extend(pulses(rotors));
    Ok(notes)
}

fn differ(a: f64, b: f64) -> bool {
    (a - b).abs() > SAME * a.abs().max(b.abs())
}

/// That two rotors of a layer differ in a setting.
fn different(layer: &str, rotors: &[&Rotor], setting: &str, of: fn(&Own) -> f64) -> Option<String> {
    let one = rotors.first()?;
    let other = rotors.iter().find(|other| differ(of(&one.own), of(&other.own)))?;
    Some(format!(
        "the {layer} rotors {} and {} have {setting} of {} and {}",
        one.channel,
        other.channel,
        of(&one.own),
        of(&other.own)
    ))
}

/// That outputs have several ranges of pulses.
fn pulses(rotors: &[Rotor]) -> Option<String> {
    let mut ranges: Vec<([f64; 2], Vec<usize>)> = Vec::new();
    for rotor in rotors {
        let us = rotor.own.pulses_us?;
        let is_same =
            |other: &[f64; 2]| (us[0] - other[0]).abs() < SAME_US && (us[1] - other[1]).abs() < SAME_US;
        match ranges.iter_mut().find(|(other, _)| is_same(other)) {
            Some((_, channels)) => channels.push(rotor.channel),
            None => ranges.push((us, vec![rotor.channel])),
        }
    }
    if ranges.len() < 2 {
        return None;
    }
    let told = ranges.iter().map(|([low, high], channels)| {
        let channels: Vec<String> = channels.iter().map(usize::to_string).collect();
        format!("{low} to {high} us of channels {}", channels.join(", "))
    });
    Some(format!(
        "the outputs have several ranges of pulses: {}; the pair was measured with one for both rotors",
        itertools::join(told, "; ")
    ))
}
