//! The units: where they are, where they push, how they turn and which channels drive them.

use std::ops::Range;

use super::pair::Spin;
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::spec::keys::{Kind, keys};
use crate::spec::{Channels, Fields, Spanned, Triple};

keys! { TABLE = "[[unit]]":
    POSITION_M "position_m" = "[0.3182, 0.3182, 0.0]", Kind::Numbers([3, 3]),
        "Forward, right and down from the centre of gravity, m.".required();
    UPPER_SPIN "upper_spin" = "\"cw\"", Kind::Word(&Spin::WORDS),
        "How this unit's upper rotor turns, seen from above.".required();
    CHANNELS "channels" = "[0, 4]", Kind::Channels,
        "Outputs of the upper and of the lower rotor; all units together have 0 to 2n - 1.".required();
    AXIS "axis" = "[0.0, 0.0, -1.0]", Kind::Numbers([3, 3]),
        "Unit vector of the thrust, straight up without it.";
}

/// Most units of an airframe.
pub(super) const MOST_UNITS: usize = 32;

/// Units nearer than this are one and the same, m.
const SAME_PLACE_M: f64 = 1e-3;

/// Farther out than this, millimetres were meant, m.
pub(super) const FARTHEST_M: f64 = 100.0;

/// An axis written to two or three digits is taken and normalised.
const AXIS_TOLERANCE: f64 = 1e-2;

/// Thrust axis of a unit that is not tilted: up, in axes forward, right, down.
const UPWARD: [f64; 3] = [0.0, 0.0, -1.0];

/// One coaxial unit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Unit {
    /// Position from the centre of gravity, m, forward, right, down; each at most 100 m away.
    pub position_m: [f64; 3],
    /// Direction of the thrust, a unit vector with a negative (upward) third component.
    pub axis: [f64; 3],
    /// Spin of the upper rotor, seen from above.
    pub upper_spin: Spin,
    /// Output that drives the upper rotor.
    pub upper_channel: usize,
    /// Output that drives the lower rotor.
    pub lower_channel: usize,
}

impl Unit {
    /// Sign s of the unit's torque in yaw: +1 where its upper rotor spins as on the bench, else -1.
    pub fn spin_sign(&self, pair_upper_spin: Spin) -> f64 {
        if self.upper_spin == pair_upper_spin {
            1.0
        } else {
            -1.0
        }
    }
}

/// A unit as written, or as a layout stands for it.
pub(super) struct Written {
    /// Path, like `unit[3]`.
    pub(super) path: String,
    /// Place of the header.
    pub(super) place: Range<usize>,
    pub(super) position_m: Option<Spanned<Triple>>,
    pub(super) upper_spin: Option<Spin>,
    pub(super) channels: Option<Spanned<Channels>>,
    pub(super) axis: Option<Spanned<Triple>>,
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Written {
    Written {
        path: table.path().to_owned(),
        place: table.place(),
        position_m: table.read(&POSITION_M),
        upper_spin: table.word(&UPPER_SPIN, &Spin::ALL),
        channels: table.read(&CHANNELS),
        axis: table.read(&AXIS),
    }
}

/// Checks every unit, and the units together.
pub(super) fn check(units: &[Written], faults: &mut Vec<Diagnostic>) -> Option<Vec<Unit>> {
    if let Some(extra) = units.get(MOST_UNITS) {
        faults.push(
            Diagnostic::new(
                Code::TooManyUnits,
                extra.path.as_str(),
                extra.place.clone(),
                format!("{} units are more than {MOST_UNITS}", units.len()),
            )
            .label("one too many")
            .help("a unit is one pair of rotors"),
        );
        return None;
    }
    same_places(units, faults);
    channels(units, faults);
    let checked: Vec<_> = units.iter().map(|unit| check_one(unit, faults)).collect();
    checked.into_iter().collect()
}

fn check_one(unit: &Written, faults: &mut Vec<Diagnostic>) -> Option<Unit> {
    let position_m = unit
        .position_m
        .as_ref()
        .and_then(|field| position(unit, field, faults));
    let axis = match &unit.axis {
        None => Some(UPWARD),
        Some(field) => axis(unit, field, faults),
    };
    let [upper, lower] = unit.channels.as_ref()?.get_ref();
    Some(Unit {
        position_m: position_m?,
        axis: axis?,
        upper_spin: unit.upper_spin?,
        upper_channel: *upper.get_ref(),
        lower_channel: *lower.get_ref(),
    })
}

fn numbers(triple: &Spanned<Triple>) -> [f64; 3] {
    triple.get_ref().each_ref().map(|x| *x.get_ref())
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

fn position(unit: &Written, field: &Spanned<Triple>, faults: &mut Vec<Diagnostic>) -> Option<[f64; 3]> {
    let position = numbers(field);
    let distance = length(position);
    if distance <= FARTHEST_M {
        // No negative zeros: they would show in the generated code.
        return Some(position.map(|x| x + 0.0));
    }
    // The root of a sum of squares may overflow where the coordinates do not.
    let distance = if distance.is_finite() {
        distance
    } else {
        position.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
    };
    let [x, y, z] = position.map(|x| number(x / 1000.0));
    faults.push(
        Diagnostic::new(
            Code::FarUnit,
            format!("{}.position_m", unit.path),
            field.span(),
            format!(
                "`{}` is {} m from the centre of gravity",
                unit.path,
                rounded(distance)
            ),
        )
        .label(format!("expected metres, at most {FARTHEST_M}"))
        .help(format!("if millimetres were meant, write [{x}, {y}, {z}]")),
    );
    None
}

fn axis(unit: &Written, field: &Spanned<Triple>, faults: &mut Vec<Diagnostic>) -> Option<[f64; 3]> {
    let axis = numbers(field);
    let length = length(axis);
    let key = format!("{}.axis", unit.path);
    if (length - 1.0).abs() > AXIS_TOLERANCE {
        let help = if length > 0.0 && length.is_finite() {
            let [x, y, z] = axis.map(|x| rounded(x / length));
            format!("divide by the length: axis = [{x}, {y}, {z}]")
        } else {
            "leave the key out for a thrust straight up, or write its direction".to_string()
        };
        faults.push(
            Diagnostic::new(
                Code::AxisLength,
                key,
                field.span(),
                format!(
                    "the axis of `{}` has length {}, not 1",
                    unit.path,
                    rounded(length)
                ),
            )
            .label("expected a unit vector")
            .help(help),
        );
        return None;
    }
    let [x, y, z] = axis;
    if z >= 0.0 {
        let help = if z > 0.0 {
            let [x, y, z] = [x, y, -z].map(number);
            format!("if z was meant upward, write axis = [{x}, {y}, {z}]")
        } else {
            "leave the key out for a thrust straight up; a tilted arm keeps z below 0".to_string()
        };
        faults.push(
            Diagnostic::new(
                Code::AxisNotUpward,
                key,
                field.span(),
                format!(
                    "the thrust of `{}` does not point upward: axis z = {}",
                    unit.path,
                    number(z)
                ),
            )
            .label("forward, right, down: upward is negative")
            .help(help),
        );
        return None;
    }
    Some(axis.map(|x| x / length + 0.0))
}

fn same_places(units: &[Written], faults: &mut Vec<Diagnostic>) {
    let placed: Vec<_> = units
        .iter()
        .filter_map(|unit| {
            unit.position_m
                .as_ref()
                .map(|field| (unit, field, numbers(field)))
        })
        .collect();
    for (index, (unit, field, [x, y, z])) in placed.iter().enumerate() {
        let near = placed[..index].iter().find_map(|(other, _, [ox, oy, oz])| {
            let distance = length([x - ox, y - oy, z - oz]);
            (distance < SAME_PLACE_M).then_some((other, distance))
        });
        if let Some((other, distance)) = near {
            let apart = rounded(distance * 1000.0);
            faults.push(
                Diagnostic::new(
                    Code::SamePlace,
                    format!("{}.position_m", unit.path),
                    field.span(),
                    format!(
                        "`{}` and `{}` are in one place, {apart} mm apart",
                        other.path, unit.path
                    ),
                )
                .label(format!("where `{}` is", other.path))
                .help("one `[[unit]]` stands for both rotors of a pair; give each pair its own place"),
            );
        }
    }
}

/// Every output from 0 to 2n - 1 must drive exactly one rotor.
fn channels(units: &[Written], faults: &mut Vec<Diagnostic>) {
    let rotors = 2 * units.len();
    // Who drives each output, and where that is written.
    let mut driven: Vec<Option<String>> = vec![None; rotors];
    let mut bad = Vec::new();
    for unit in units {
        let Some(channels) = &unit.channels else { continue };
        for (rotor, channel) in ["upper", "lower"].into_iter().zip(channels.get_ref()) {
            let here = format!("the {rotor} rotor of `{}`", unit.path);
            let key = format!("{}.channels", unit.path);
            let output = *channel.get_ref();
            match driven.get_mut(output) {
                Some(slot @ None) => *slot = Some(here),
                Some(Some(other)) => bad.push(
                    Diagnostic::new(
                        Code::DuplicateChannel,
                        key,
                        channel.span(),
                        format!("output {output} drives {other} and {here}"),
                    )
                    .label("already taken"),
                ),
                None => bad.push(
                    Diagnostic::new(
                        Code::ChannelRange,
                        key,
                        channel.span(),
                        format!("output {output} of {here} is beyond {}", rotors.saturating_sub(1)),
                    )
                    .label(format!(
                        "{} units have outputs 0 to {}",
                        units.len(),
                        rotors.saturating_sub(1)
                    )),
                ),
            }
        }
    }
    let complete = units.iter().all(|unit| unit.channels.is_some());
    let free: Vec<_> = driven
        .iter()
        .enumerate()
        .filter(|(_, slot)| slot.is_none())
        .map(|(output, _)| output.to_string())
        .collect();
    let help = match free.as_slice() {
        [output] if complete => format!("outputs count from 0; output {output} drives no rotor yet"),
        [first @ .., last] if complete => {
            format!(
                "outputs count from 0; outputs {} and {last} drive no rotor yet",
                first.join(", ")
            )
        }
        _ => "outputs count from 0, two for each unit, without a gap".to_string(),
    };
    faults.extend(bad.into_iter().map(|fault| fault.help(help.as_str())));
}
