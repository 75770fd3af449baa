//! The units: where they are, where they push, how they turn and which channels drive them.

use super::pair::Spin;
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::spec::keys::{ValueKind, keys};
use crate::spec::{Fields, Places, Spanned, place_in};

keys! { TABLE = "[[unit]]":
    POSITION_M "position_m" = "[0.3182, 0.3182, 0.0]", ValueKind::Numbers([3, 3]),
        "Forward, right and down from the centre of gravity, m.".required();
    UPPER_SPIN "upper_spin" = "\"cw\"", ValueKind::Word(&Spin::WORDS),
        "How this unit's upper rotor, or its single rotor, turns, seen from above.".required();
    CHANNELS "channels" = "[0, 4]", ValueKind::Channels,
        "Outputs of the upper and of the lower rotor, of a single rotor its one; all units together have 0 to the number of rotors less 1.".required();
    PAIR "pair" = "\"front\"", ValueKind::Text,
        "Name of its `[[pair]]`, where there are several.";
    ROTOR "rotor" = "\"tail\"", ValueKind::Text,
        "Name of its `[[rotor]]`, where the unit is a single rotor and no pair.";
    AXIS "axis" = "[0.0, 0.0, -1.0]", ValueKind::Numbers([3, 3]),
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
    /// Output that drives the lower rotor; `None` of a single rotor.
    pub lower_channel: Option<usize>,
    /// Where it stands in [`super::Airframe::pairs`], or past these in `single_rotors`.
    pub kind: usize,
}

/// A rotor of a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rotor {
    /// The output that drives it.
    pub channel: usize,
    /// How it turns, seen from above.
    pub spin: Spin,
    /// `upper`, `lower` or `single`.
    pub layer: &'static str,
}

impl Unit {
    /// Its rotors, the upper one first.
    pub fn rotors(&self) -> impl Iterator<Item = Rotor> + use<> {
        let layer = if self.lower_channel.is_some() {
            "upper"
        } else {
            "single"
        };
        let spin = self.upper_spin;
        let upper = Rotor {
            channel: self.upper_channel,
            spin,
            layer,
        };
        let lower = self.lower_channel.map(|channel| Rotor {
            channel,
            spin: spin.reversed(),
            layer: "lower",
        });
        std::iter::once(upper).chain(lower)
    }

    /// The outputs of its rotors, the upper one first.
    pub fn channels(&self) -> impl Iterator<Item = usize> + use<> {
        self.rotors().map(|rotor| rotor.channel)
    }

    /// Its rotors in words: `upper rotor cw: channel 0 upper, 4 lower`, `single rotor ccw: channel 2`.
    pub fn in_words(&self) -> String {
        let (spin, upper) = (self.upper_spin.name(), self.upper_channel);
        match self.lower_channel {
            Some(lower) => format!("upper rotor {spin}: channel {upper} upper, {lower} lower"),
            None => format!("single rotor {spin}: channel {upper}"),
        }
    }

    /// The outputs of both rotors as `mixer-rt` has them.
    pub(crate) fn channel_table(&self) -> [u8; 2] {
        [Some(self.upper_channel), self.lower_channel]
            .map(|channel| channel.map_or(mixer_rt::tables::NO_CHANNEL, |channel| channel as u8))
    }

    /// The throttles `[u, l]` of its rotors in a list with one per output; 0 of a rotor that does not exist, or that the
    /// list does not have.
    pub fn throttles<T: Copy + Into<f64>>(&self, outputs: &[T]) -> [f64; 2] {
        [Some(self.upper_channel), self.lower_channel].map(|channel| {
            let throttle = channel.and_then(|channel| outputs.get(channel));
            throttle.map_or(0.0, |throttle| (*throttle).into())
        })
    }
}

/// The parts of a unit that could be read, or that a layout stands for.
pub(super) struct Written {
    pub(super) position_m: Option<[f64; 3]>,
    pub(super) axis: Option<[f64; 3]>,
    pub(super) upper_spin: Option<Spin>,
    /// Outputs of the upper and of the lower rotor; none of the lower one of a single rotor.
    pub(super) channels: Option<(usize, Option<usize>)>,
    /// The name of its pair.
    pub(super) pair: Option<String>,
    /// The name of its single rotor.
    pub(super) rotor: Option<String>,
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Written {
    let rotor = table.read::<String>(&ROTOR).map(Spanned::into_inner);
    Written {
        position_m: position(table),
        upper_spin: table.word(&UPPER_SPIN, &Spin::ALL),
        channels: match rotor {
            Some(_) => single_channel(table).map(|channel| (channel, None)),
            None => table.array(&CHANNELS).map(|[upper, lower]| (upper, Some(lower))),
        },
        rotor,
        pair: table.read::<String>(&PAIR).map(Spanned::into_inner),
        axis: axis(table),
    }
}

/// The output of a single rotor.
fn single_channel(table: &mut Fields<'_, '_>) -> Option<usize> {
    let list = table.read::<Vec<Spanned<usize>>>(&CHANNELS)?.into_inner();
    if let [channel] = list.as_slice() {
        return Some(*channel.get_ref());
    }
    let message = format!(
        "`{}.channels` has {} outputs, and its single rotor one",
        table.path(),
        list.len()
    );
    let help =
        "write it like `channels = [3]`; two rotors on one mast are a pair, with `pair` in place of `rotor`";
    table.refuse(&CHANNELS, Code::WrongLength, message, "expected one output", help)
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

/// Checks the units together, and gives them where all are complete; `names` are those of the file's pairs and of its
/// single rotors.
pub(super) fn check(
    units: &[Written],
    names: [&[String]; 2],
    places: &Places,
    faults: &mut Vec<Diagnostic>,
) -> Option<Vec<Unit>> {
    if units.len() > MOST_UNITS {
        let key = format!("unit[{MOST_UNITS}]");
        let message = format!("{} units are more than {MOST_UNITS}", units.len());
        let fault = Diagnostic::new(Code::TooManyUnits, key.as_str(), place_in(places, &key), message);
        faults.push(fault.label("one too many").help("a unit is one pair of rotors"));
        return None;
    }
    check_places(units, places, faults);
    check_channels(units, places, faults);
    let kinds = check_kinds(units, names, places, faults);
    let complete = |(unit, kind): (&Written, Option<usize>)| {
        let (upper_channel, lower_channel) = unit.channels?;
        Some(Unit {
            position_m: unit.position_m?,
            axis: unit.axis?,
            upper_spin: unit.upper_spin?,
            upper_channel,
            lower_channel,
            kind: kind?,
        })
    };
    units.iter().zip(kinds).map(complete).collect()
}

/// Every unit has one of the file's pairs or single rotors, by name where there are several, and each of these a unit.
fn check_kinds(
    units: &[Written],
    names: [&[String]; 2],
    places: &Places,
    faults: &mut Vec<Diagnostic>,
) -> Vec<Option<usize>> {
    // Tables at fault are told of.
    let rotors_are_whole = !faults.iter().any(|fault| fault.key.starts_with("rotor"));
    let mut tell = |code, key: String, message: String, label: &str, help: String| {
        let fault = Diagnostic::new(code, key.as_str(), place_in(places, &key), message);
        faults.push(fault.label(label).help(help));
    };
    let listed = |names: &[String]| -> String {
        let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        quoted.join(", ")
    };
    let [pairs, rotors] = names;
    // One pair alone needs no name.
    let is_one = pairs.len() == 1;
    let is_clear =
        (0..pairs.len()).all(|k| is_one || !pairs[k].is_empty() && !pairs[..k].contains(&pairs[k]));
    let is_named = |unit: &Written| unit.pair.is_some() || unit.rotor.is_some();
    let is_complete = is_clear && !units.is_empty() && units.iter().all(|unit| is_one || is_named(unit));
    for (word, names, is_lone) in [("pair", pairs, is_one), ("rotor", rotors, false)] {
        let of = |unit: &Written| {
            if word == "pair" {
                unit.pair.clone()
            } else {
                unit.rotor.clone()
            }
        };
        let has = |unit: &Written, name: &String| match is_lone {
            true => unit.rotor.is_none(),
            false => of(unit).as_ref() == Some(name),
        };
        for (k, name) in names.iter().enumerate() {
            let key = format!("{word}[{k}]");
            if name.is_empty() && !is_lone {
                let (message, help) = (
                    format!("`{key}` has no name"),
                    "add name = \"..\", by which units have it",
                );
                tell(Code::MissingKey, key, message, "one of several", help.to_owned());
            } else if names[..k].contains(name) {
                let message = format!("two `[[{word}]]` are called \"{name}\"");
                tell(
                    Code::Conflict,
                    key + ".name",
                    message,
                    "the second one",
                    "rename one of them".to_owned(),
                );
            } else if is_complete && !units.iter().any(|unit| has(unit, name)) {
                let in_layout = if word == "pair" {
                    " or in `pairs` of `[layout]`"
                } else {
                    ""
                };
                let (message, help) = match is_lone {
                    true => (
                        "no unit has the pair".to_owned(),
                        "remove it, or `rotor` from a unit that is a pair".to_owned(),
                    ),
                    false => (
                        format!("no unit has the {word} \"{name}\""),
                        format!("write {word} = \"{name}\" in a `[[unit]]`{in_layout}, or remove it"),
                    ),
                };
                tell(Code::Conflict, key + ".name", message, "not used", help);
            }
        }
    }
    let is_silent = !units.iter().any(is_named);
    if places.contains_key("layout") && is_silent && pairs.len() > 1 && is_clear {
        let message = "`layout` does not say which unit has which pair".to_owned();
        let help = format!(
            "add pairs = [..] with one of {} for each unit, clockwise from the first",
            listed(pairs)
        );
        tell(Code::MissingKey, "layout".to_owned(), message, "no `pairs`", help);
        return vec![None; units.len()];
    }
    let in_layout = places.contains_key("layout.pairs");
    let find = |(k, unit): (usize, &Written)| {
        let key = |word: &str| match in_layout {
            true => format!("layout.pairs[{k}]"),
            false => format!("unit[{k}].{word}"),
        };
        let (word, name, names, first) = match (&unit.pair, &unit.rotor) {
            (Some(_), Some(_)) => {
                let message = format!("`unit[{k}]` has a pair and a single rotor");
                let help = "remove `pair` or `rotor`".to_owned();
                tell(Code::Conflict, key("rotor"), message, "one of them", help);
                return None;
            }
            (None, Some(name)) if rotors_are_whole => ("rotor", name, rotors, pairs.len()),
            (None, Some(_)) => return None,
            _ if pairs.is_empty() || !is_clear => return None,
            (None, None) if is_one => return Some(0),
            (None, None) => {
                let message = format!("`unit[{k}]` has no pair, and the file has several");
                let help = format!("write pair = one of {}", listed(pairs));
                tell(Code::MissingKey, key("pair"), message, "which one?", help);
                return None;
            }
            (Some(name), None) => ("pair", name, pairs, 0),
        };
        let found = names.iter().position(|known| known == name && !name.is_empty());
        if let Some(found) = found {
            return Some(first + found);
        }
        let whose = format!("`unit[{k}]` has the {word} \"{name}\"");
        let (message, help) = match names {
            [] => (
                format!("{whose}, of which the file has none"),
                format!("add a table `[[{word}]]` with name = \"{name}\""),
            ),
            [lone] if lone.is_empty() => (
                format!("{whose}, and the file's pair has no name"),
                format!("remove it, or write name = \"{name}\" under `[pair]`"),
            ),
            names => (
                format!("{whose}, of which the file has none"),
                format!("write one of {}", listed(names)),
            ),
        };
        tell(
            Code::UnknownWord,
            key(word),
            message,
            &format!("no such {word}"),
            help,
        );
        None
    };
    units.iter().enumerate().map(find).collect()
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

/// Every output from 0 on drives exactly one rotor.
fn check_channels(units: &[Written], places: &Places, faults: &mut Vec<Diagnostic>) {
    let rotors = units
        .iter()
        .map(|unit| if unit.rotor.is_some() { 1 } else { 2 })
        .sum::<usize>();
    let last = rotors.saturating_sub(1);
    // Who drives each output.
    let mut driven: Vec<Option<String>> = vec![None; rotors];
    let mut bad = Vec::new();
    for (k, channels) in units.iter().enumerate() {
        let Some((upper, lower)) = channels.channels else {
            continue;
        };
        let rotors = [Some(("upper ", upper)), lower.map(|lower| ("lower ", lower))];
        for (index, (rotor, output)) in rotors.into_iter().flatten().enumerate() {
            let rotor = if lower.is_none() { "" } else { rotor };
            let here = format!("the {rotor}rotor of `unit[{k}]`");
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
        _ => "outputs count from 0, two for each pair, without a gap".to_string(),
    };
    faults.extend(bad.into_iter().map(|fault| fault.help(help.as_str())));
}
