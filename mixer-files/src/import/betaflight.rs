//! The text of Betaflight's and INAV's `diff all` or `dump`: `mixer NAME` is one of Betaflight's
//! tables, `mmix N THROTTLE ROLL PITCH YAW` a motor of a table of one's own.
//!
//! A factor of roll is positive on the left, one of pitch at the rear, one of yaw where the rotor
//! turns counter-clockwise (Betaflight's `mixer_init.c`, INAV's `docs/Mixer.md`). They have no
//! metres, and roll and pitch have scales of their own: those that make all arms equal are taken.

use std::collections::BTreeMap;

use mixer_compiler::Source;
use mixer_compiler::airframe::Spin;

use super::outputs;
use super::parameters::numbers;
use super::rotors::{Imported, Pulses, Rotor};
use crate::frames::LAYER_M;

/// Betaflight's coaxial tables (`mixerOctoX8`, `mixerY6`): throttle is 1, then roll, pitch, yaw. The
/// second half of the motors is under the first.
#[rustfmt::skip]
const TABLES: [(&str, &[[f64; 3]]); 2] = [
    ("OCTOX8", &[
        [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, -1.0],
        [-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0],
    ]),
    ("Y6", &[
        [0.0, 1.333_333, 1.0], [-1.0, -0.666_667, -1.0], [1.0, -0.666_667, -1.0],
        [0.0, 1.333_333, -1.0], [-1.0, -0.666_667, 1.0], [1.0, -0.666_667, 1.0],
    ]),
];

/// Factors that differ by less are one.
const SAME_FACTOR: f64 = 0.01;

/// Share by which arms may differ that are equal.
const EQUAL_ARMS: f64 = 0.02;

/// What of such a text matters.
#[derive(Default)]
struct Dump<'a> {
    mixer: Option<(String, u32)>,
    /// Factors of roll, pitch, yaw and their line, by motor.
    motors: BTreeMap<usize, ([f64; 3], u32)>,
    settings: BTreeMap<&'a str, &'a str>,
    notes: Vec<String>,
}

/// Whether a text is one: by lines that no file of parameters has. PX4's older scripts load a mixer.
pub(super) fn is_dump(text: &str) -> bool {
    let mut lines = text.lines().map(|line| line.split_whitespace());
    lines.any(|mut words| match (words.next(), words.next()) {
        (Some("mmix" | "board_name" | "mixer_profile"), _) => true,
        (Some("mixer"), Some(name)) => name != "load" && words.next().is_none(),
        _ => false,
    })
}

impl<'a> Dump<'a> {
    fn read(file: &str, text: &'a str) -> Result<Self, String> {
        let mut dump = Dump::default();
        let mut is_first_profile = true;
        for (line, number) in text.lines().zip(1..) {
            let content = line.split('#').next().unwrap_or_default();
            let content = content.split("//").next().unwrap_or_default();
            let separated = |c: char| c.is_whitespace() || matches!(c, ',' | '=');
            let words: Vec<&str> = content.split(separated).filter(|word| !word.is_empty()).collect();
            match words[..] {
                ["mixer_profile", profile] => {
                    is_first_profile = profile == "1";
                    let note = "of the mixer profiles the first is read";
                    if !is_first_profile && !dump.notes.iter().any(|told| told == note) {
                        dump.notes.push(note.to_owned());
                    }
                }
                _ if !is_first_profile => {}
                ["mixer", name] => dump.mixer = Some((name.to_uppercase(), number)),
                ["mmix", "reset"] => dump.motors.clear(),
                ["mmix", "load", name] => dump.load(&name.to_uppercase(), number),
                ["mmix", motor, ref factors @ ..] => {
                    let factors = numbers(factors);
                    let (Ok(motor), Some([throttle, roll, pitch, yaw])) = (motor.parse(), factors) else {
                        return Err(format!(
                            "{file}:{number}: `{}` is not `mmix MOTOR THROTTLE ROLL PITCH YAW`",
                            content.trim()
                        ));
                    };
                    if throttle > 0.0 {
                        dump.motors.insert(motor, ([roll, pitch, yaw], number));
                    }
                }
                ["set", name, value] => {
                    dump.settings.insert(name, value);
                }
                _ => {}
            }
        }
        Ok(dump)
    }

    /// Betaflight's table of this name, if it has such a frame of pairs.
    fn load(&mut self, name: &str, line: u32) {
        let table = TABLES.iter().find(|(known, _)| *known == name);
        let motors = table.map_or(&[][..], |(_, motors)| motors);
        self.motors = motors
            .iter()
            .map(|factors| (*factors, line))
            .enumerate()
            .collect();
    }

    /// Betaflight and INAV.
    fn is_reversed(&self) -> bool {
        let is = |name: &str, on: &[&str]| {
            let value = self.settings.get(name);
            value.is_some_and(|value| on.iter().any(|on| value.eq_ignore_ascii_case(on)))
        };
        is("yaw_motors_reversed", &["ON", "1"])
            || is("motor_direction_inverted", &["ON", "1"])
            || is("yaw_motor_direction", &["-1"])
    }

    /// Where the protocol has pulses.
    fn pulses(&self) -> Option<Pulses> {
        let is_digital = |protocol: &&str| {
            protocol.to_uppercase().contains("SHOT") && !protocol.to_uppercase().starts_with("ONE")
        };
        if self.settings.get("motor_pwm_protocol").is_some_and(is_digital) {
            return None;
        }
        let ends = ["min_command", "max_throttle"].map(|name| {
            let value = self.settings.get(name)?.parse().ok()?;
            Some((value, name.to_owned()))
        });
        ends.iter().any(Option::is_some).then_some(Pulses { ends })
    }
}

pub(super) fn read(source: &Source, arm: Option<f64>) -> Result<Imported, String> {
    let file = &source.name;
    let mut dump = Dump::read(file, &source.text)?;
    let (origin, place) = match dump.mixer.take() {
        Some((name, line)) if name != "CUSTOM" => {
            dump.load(&name, line);
            (
                format!("Betaflight's {name}"),
                format!("{file}:{line}: mixer {name}"),
            )
        }
        custom => {
            if custom.is_none() && source.text.contains("Betaflight") {
                let note =
                    "there is no line `mixer CUSTOM`, without which Betaflight does not use its `mmix` lines";
                dump.notes.push(note.to_owned());
            }
            ("`mmix` of Betaflight or INAV".to_owned(), format!("{file}: mmix"))
        }
    };
    let count = dump.motors.len();
    if count == 0 {
        return Err(format!(
            "{place}: no coaxial pairs: those are `mixer OCTOX8`, `mixer Y6`, and lines `mmix MOTOR THROTTLE ROLL PITCH YAW` \
             with two motors in one place"
        ));
    }
    if let Some(gap) = (0..count).find(|motor| !dump.motors.contains_key(motor)) {
        return Err(format!(
            "{place}: motor {gap} is missing: the stack ends its motors there"
        ));
    }
    let factors: Vec<[f64; 3]> = dump.motors.values().map(|(factors, _)| *factors).collect();
    let arm = outputs::arm(arm, &format!("{place}: its factors"))?;
    let (scale, is_equal) = scale(&factors, arm);
    let mut notes = vec![match is_equal {
        true => format!("arms of {arm} m are assumed for all pairs"),
        false => format!(
            "the longest arm is taken for {arm} m, and places in proportion to the factors: compare position_m with the \
             vehicle, as roll and pitch may have scales of their own"
        ),
    }];
    let is_under = |motor: usize| {
        let [roll, pitch, _] = factors[motor % (count / 2).max(1)];
        let [other_roll, other_pitch, _] = factors[motor];
        (roll - other_roll).abs() < SAME_FACTOR && (pitch - other_pitch).abs() < SAME_FACTOR
    };
    let in_halves = count % 2 == 0 && (count / 2..count).all(is_under);
    if in_halves {
        let note = "the second half of the motors is taken for the lower rotors, as in Betaflight's tables; --upper says otherwise";
        notes.push(note.to_owned());
    }
    notes.append(&mut dump.notes);
    notes.push("the idle is throttle.min, 0.1 unless the pair's file has another; the stack's own is not added to it".to_owned());
    let is_reversed = dump.is_reversed();
    let mut rotors = Vec::new();
    for (channel, ([roll, pitch, yaw], line)) in &dump.motors {
        let place = format!("{file}:{line}");
        let spin = match *yaw {
            0.0 => {
                return Err(format!(
                    "{place}: the yaw of motor {channel} is 0: its sign says how the rotor turns"
                ));
            }
            yaw if (yaw > 0.0) != is_reversed => Spin::Ccw,
            _ => Spin::Cw,
        };
        let layer = match in_halves {
            false => 0.0,
            true if *channel < count / 2 => -LAYER_M,
            true => LAYER_M,
        };
        let [x, y] = [-pitch * scale[1], -roll * scale[0]].map(|x| (x * 1e4).round() / 1e4 + 0.0);
        rotors.push(Rotor {
            channel: *channel,
            place,
            position_m: [x, y, layer],
            axis: [0.0, 0.0, -1.0],
            spin,
        });
    }
    Ok(Imported {
        origin: format!("{origin}, {count} motors"),
        rotors,
        pulses: dump.pulses(),
        airmode: Some(("roll-pitch", "the nearest to Betaflight's airmode")),
        notes,
        ..Imported::default()
    })
}

/// Metres per factor of roll and of pitch, and whether all arms have the same length by them: the
/// least squares of (roll s)^2 + (pitch t)^2 = arm^2; where that leaves them open, or is not so, one
/// scale for both.
fn scale(factors: &[[f64; 3]], arm: f64) -> ([f64; 2], bool) {
    let squares: Vec<[f64; 2]> = factors
        .iter()
        .map(|[roll, pitch, _]| [roll * roll, pitch * pitch])
        .collect();
    let sum = |of: fn(&[f64; 2]) -> f64| squares.iter().map(of).sum::<f64>();
    let [rr, rp, pp] = [sum(|[r, _]| r * r), sum(|[r, p]| r * p), sum(|[_, p]| p * p)];
    let (r, p) = (sum(|[r, _]| *r), sum(|[_, p]| *p));
    let determinant = rr * pp - rp * rp;
    let both = [(r * pp - p * rp) / determinant, (p * rr - r * rp) / determinant];
    let arms = |scale: [f64; 2]| squares.iter().map(move |[r, p]| r * scale[0] + p * scale[1]);
    let is_equal = |scale: [f64; 2]| arms(scale).all(|square| (square - 1.0).abs() < EQUAL_ARMS);
    if determinant > 1e-6 * rr * pp && both.iter().all(|square| *square > 0.0) && is_equal(both) {
        return (both.map(|square| arm * square.sqrt()), true);
    }
    let longest = arms([1.0; 2]).fold(0.0, f64::max);
    let one = if longest > 0.0 { 1.0 / longest } else { 0.0 };
    let is_square = squares.iter().all(|[r, p]| (r - p).abs() < SAME_FACTOR);
    ([arm * one.sqrt(); 2], is_square && is_equal([one; 2]))
}
