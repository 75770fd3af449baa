//! The units: where they are, where they push, how they turn and which channels drive them.

use super::pair::Spin;
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::spec::keys::{Kind, keys};
use crate::spec::{Fields, Places, place_in};

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
pub(super) const UPWARD: [f64; 3] = [0.0, 0.0, -1.0];

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

/// The parts of a unit that could be read, or that a layout stands for.
pub(super) struct Written {
    pub(super) position_m: Option<[f64; 3]>,
    pub(super) axis: Option<[f64; 3]>,
    pub(super) upper_spin: Option<Spin>,
    /// Outputs of the upper and of the lower rotor.
    pub(super) channels: Option<[usize; 2]>,
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Written {
    Written {
        position_m: position(table),
        upper_spin: table.word(&UPPER_SPIN, &Spin::ALL),
        channels: table.array(&CHANNELS),
        axis: axis(table),
    }
}

fn position(table: &mut Fields<'_, '_>) -> Option<[f64; 3]> {
    let [x, y, z] = table.array(&POSITION_M)?;
    let distance = libm::hypot(libm::hypot(x, y), z);
    if distance <= FARTHEST_M {
        return Some([x, y, z]);
    }
    let message = format!(
        "`{}` is {} m from the centre of gravity",
        table.path(),
        rounded(distance)
    );
    let label = format!("expected metres, at most {FARTHEST_M}");
    let [x, y, z] = [x, y, z].map(|x| number(x / 1000.0));
    let help = format!("if millimetres were meant, write [{x}, {y}, {z}]");
    table.refuse(&POSITION_M, Code::FarUnit, message, label, help)
}

fn axis(table: &mut Fields<'_, '_>) -> Option<[f64; 3]> {
    if table.key_place(&AXIS).is_none() {
        return Some(UPWARD);
    }
    let axis: [f64; 3] = table.array(&AXIS)?;
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    if (length - 1.0).abs() > AXIS_TOLERANCE {
        let help = if length > 0.0 && length.is_finite() {
            let [x, y, z] = axis.map(|x| rounded(x / length));
            format!("divide by the length: axis = [{x}, {y}, {z}]")
        } else {
            "leave the key out for a thrust straight up, or write its direction".to_string()
        };
        let length = rounded(length);
        let message = format!("the axis of `{}` has length {length}, not 1", table.path());
        return table.refuse(&AXIS, Code::AxisLength, message, "expected a unit vector", help);
    }
    let [x, y, z] = axis;
    if z < 0.0 {
        return Some(axis.map(|x| x / length + 0.0));
    }
    let help = if z > 0.0 {
        let [x, y, z] = [x, y, -z].map(number);
        format!("if z was meant upward, write axis = [{x}, {y}, {z}]")
    } else {
        "leave the key out for a thrust straight up; a tilted arm keeps z below 0".to_string()
    };
    let (path, z) = (table.path(), number(z));
    let message = format!("the thrust of `{path}` does not point upward: axis z = {z}");
    let label = "forward, right, down: upward is negative";
    table.refuse(&AXIS, Code::AxisNotUpward, message, label, help)
}

/// Checks the units together, and gives them where all are complete.
pub(super) fn check(units: &[Written], places: &Places, faults: &mut Vec<Diagnostic>) -> Option<Vec<Unit>> {
    if units.len() > MOST_UNITS {
        let key = format!("unit[{MOST_UNITS}]");
        let message = format!("{} units are more than {MOST_UNITS}", units.len());
        let fault = Diagnostic::new(Code::TooManyUnits, key.as_str(), place_in(places, &key), message);
        faults.push(fault.label("one too many").help("a unit is one pair of rotors"));
        return None;
    }
    check_places(units, places, faults);
    check_channels(units, places, faults);
    let complete = |unit: &Written| {
        let [upper_channel, lower_channel] = unit.channels?;
        Some(Unit {
            position_m: unit.position_m?,
            axis: unit.axis?,
            upper_spin: unit.upper_spin?,
            upper_channel,
            lower_channel,
        })
    };
    units.iter().map(complete).collect()
}

/// No two units are in one place.
fn check_places(units: &[Written], places: &Places, faults: &mut Vec<Diagnostic>) {
    let placed = || {
        units
            .iter()
            .enumerate()
            .filter_map(|(k, unit)| Some((k, unit.position_m?)))
    };
    for (k, [x, y, z]) in placed() {
        let distance = |[ox, oy, oz]: [f64; 3]| libm::hypot(libm::hypot(x - ox, y - oy), z - oz);
        let mut before = placed().take_while(|(other, _)| *other < k);
        let Some((other, place)) = before.find(|(_, place)| distance(*place) < SAME_PLACE_M) else {
            continue;
        };
        let apart = rounded(distance(place) * 1000.0);
        let key = format!("unit[{k}].position_m");
        let message = format!("`unit[{other}]` and `unit[{k}]` are in one place, {apart} mm apart");
        let fault = Diagnostic::new(Code::SamePlace, key.as_str(), place_in(places, &key), message);
        faults.push(
            fault
                .label(format!("where `unit[{other}]` is"))
                .help("one `[[unit]]` stands for both rotors of a pair; give each pair its own place"),
        );
    }
}

/// Every output from 0 to 2n - 1 drives exactly one rotor.
fn check_channels(units: &[Written], places: &Places, faults: &mut Vec<Diagnostic>) {
    let rotors = 2 * units.len();
    let last = rotors.saturating_sub(1);
    // Who drives each output.
    let mut driven: Vec<Option<String>> = vec![None; rotors];
    let mut bad = Vec::new();
    for (k, channels) in units.iter().enumerate() {
        let rotors = ["upper", "lower"]
            .into_iter()
            .zip(channels.channels.into_iter().flatten());
        for (index, (rotor, output)) in rotors.enumerate() {
            let here = format!("the {rotor} rotor of `unit[{k}]`");
            let (code, message, label) = match driven.get_mut(output) {
                Some(slot @ None) => {
                    *slot = Some(here);
                    continue;
                }
                Some(Some(other)) => {
                    let message = format!("output {output} drives {other} and {here}");
                    (Code::DuplicateChannel, message, "already taken".to_owned())
                }
                None => {
                    let message = format!("output {output} of {here} is beyond {last}");
                    let label = format!("{} units have outputs 0 to {last}", units.len());
                    (Code::ChannelRange, message, label)
                }
            };
            let key = format!("unit[{k}].channels");
            let place = place_in(places, &format!("{key}[{index}]"));
            bad.push(Diagnostic::new(code, key, place, message).label(label));
        }
    }
    let free = driven.iter().enumerate().filter(|(_, slot)| slot.is_none());
    let free: Vec<_> = free.map(|(output, _)| output.to_string()).collect();
    let is_complete = units.iter().all(|unit| unit.channels.is_some());
    let help = match free.as_slice() {
        [output] if is_complete => format!("outputs count from 0; output {output} drives no rotor yet"),
        [first @ .., last] if is_complete => {
            let first = first.join(", ");
            format!("outputs count from 0; outputs {first} and {last} drive no rotor yet")
        }
        _ => "outputs count from 0, two for each unit, without a gap".to_string(),
    };
    faults.extend(bad.into_iter().map(|fault| fault.help(help.as_str())));
}
