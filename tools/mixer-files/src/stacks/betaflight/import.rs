//! The text of Betaflight's and INAV's `diff all` or `dump`: `mixer NAME` is one of Betaflight's
//! tables, `mmix N THROTTLE ROLL PITCH YAW` a motor of a table of one's own.
//!
//! A factor of roll is positive on the left, one of pitch at the rear, one of yaw where the rotor
//! turns counter-clockwise (Betaflight's `mixer_init.c`, INAV's `docs/Mixer.md`). They have no
//! metres, and roll and pitch have scales of their own: those that make all arms equal are taken.
//!
//! The lines are followed as the command line of the stack follows them: `mmix N` sets motor N (`cliMotorMix`), and
//! INAV's `mixer_profile` says which of its mixers is meant.

use std::collections::BTreeMap;

use mixer_compiler::Source;
use mixer_compiler::airframe::Spin;

use super::frames::TABLES;
use crate::import::outputs;
use crate::import::parameters::words;
use crate::import::rotors::{Imported, LeftOut, Own, Rotor, UPWARD};
use crate::stacks::ardupilot::frames::LAYER_M;

/// Factors that differ by less are one.
const SAME_FACTOR: f64 = 0.01;

/// Share by which squares of arms may differ that are equal.
const EQUAL_ARMS: f64 = 0.02;

/// Squares of scales below which all arms would lie on one line.
const LEAST_SQUARE: f64 = 0.01;

/// Weight of one scale for roll and pitch, which decides where equal arms leave them open.
const ONE_SCALE: f64 = 1e-6;

/// Largest less least factor of an axis in Betaflight's tables, and in what `params` writes.
const RANGE: f64 = 2.0;

/// Share by which a tune's factors may differ from that without a word.
const SAME_RANGE: f64 = 0.02;

/// INAV's `platform_type` of the vehicles that are meant here, its default.
const MULTIROTOR: &str = "MULTIROTOR";

/// A motor: its place in the text, and its factors of throttle, roll, pitch and yaw.
type Motor = (String, [f64; 4]);

/// A mixer of INAV; Betaflight has one.
#[derive(Default)]
struct Profile {
    motors: BTreeMap<usize, Motor>,
    /// Whether all motors turn the other way: where, and by which setting.
    reversed: Option<(String, String)>,
    /// `platform_type` with its place.
    platform: Option<(String, String)>,
}

/// What a text says.
#[derive(Default)]
struct Dump {
    /// By INAV's numbers; what stands before the first belongs to 1.
    profiles: BTreeMap<usize, Profile>,
    /// Of `mixer NAME`, which goes before `mmix`.
    table: Option<BTreeMap<usize, Motor>>,
    is_3d: bool,
    /// Whether the text is of INAV, whose default is no reversal on every board.
    is_inav: bool,
    /// Whether a line says which way the motors turn.
    has_direction: bool,
    /// Outputs of the motors, where they are in another order.
    reordering: Option<String>,
}

/// Whether a motor has a part in roll, pitch or yaw; the others keep an output free, or push.
fn is_rotor((_, [throttle, attitude @ ..]): &Motor) -> bool {
    *throttle > 0.0 && attitude.iter().any(|factor| *factor != 0.0)
}

impl Profile {
    fn rotors(&self) -> usize {
        self.motors.values().filter(|motor| is_rotor(motor)).count()
    }
}

/// One of Betaflight's tables, empty where it has no coaxial pairs.
fn table(name: &str, place: &str) -> BTreeMap<usize, Motor> {
    let known = TABLES.iter().find(|(known, _)| name.eq_ignore_ascii_case(known));
    let motors = known.map_or(&[][..], |(_, motors)| *motors).iter();
    let factors = motors.map(|[roll, pitch, yaw]| (place.to_owned(), [1.0, *roll, *pitch, *yaw]));
    (0..).zip(factors).collect()
}

impl Dump {
    fn read(source: &Source) -> Result<Dump, String> {
        let (mut dump, mut number) = (Dump::default(), 1);
        for (line, of_file) in source.text.lines().zip(1..) {
            dump.is_inav |= line.starts_with("# INAV/");
            let content = line.split('#').next().unwrap_or_default();
            let content = content.split("//").next().unwrap_or_default().trim();
            let place = format!("{}:{of_file}", source.name);
            let profile = dump.profiles.entry(number).or_default();
            match words(content)[..] {
                ["mixer_profile", profile] => {
                    number = profile.parse().unwrap_or(number);
                    dump.is_inav = true;
                }
                ["mixer", name] => {
                    let is_table = !name.eq_ignore_ascii_case("custom");
                    dump.table = is_table.then(|| table(name, &place));
                }
                ["mmix", "reset"] => profile.motors.clear(),
                // As an older wiki has it; no stack follows it.
                ["mmix", "custom"] => {}
                ["mmix", "load", name] => profile.motors = table(name, &place),
                ["mmix", ref rest @ ..] => {
                    let (motor, factors) = mmix(rest).ok_or_else(|| {
                        format!("{place}: `{content}` is not `mmix MOTOR THROTTLE ROLL PITCH YAW`")
                    })?;
                    profile.motors.insert(motor, (place, factors));
                }
                ["feature", "3D"] => dump.is_3d = true,
                ["feature", "-3D"] => dump.is_3d = false,
                ["set", "platform_type", platform] => profile.platform = Some((place, platform.to_owned())),
                ["set", "motor_output_reordering", ref order @ ..] => {
                    let is_usual = order.iter().zip(0..).all(|(motor, k)| motor.parse() == Ok(k));
                    dump.reordering = (!is_usual).then(|| order.join(","));
                }
                ["set", setting, value] if DIRECTIONS.contains(&setting) => {
                    let is_reversed = value.eq_ignore_ascii_case("ON") || value == "-1";
                    profile.reversed = is_reversed.then(|| (setting.to_owned(), value.to_owned()));
                    dump.has_direction = true;
                }
                _ => {}
            }
        }
        Ok(dump)
    }

    /// The mixer of a multirotor with the most rotors, and what is left out.
    ///
    /// # Errors
    /// Motors of other vehicles alone.
    fn multirotor(&mut self) -> Result<(Profile, Vec<String>), String> {
        if let Some(motors) = self.table.take() {
            let profile = self.profiles.remove(&1).unwrap_or_default();
            return Ok((Profile { motors, ..profile }, Vec::new()));
        }
        let foreign = |profile: &Profile| {
            let (place, platform) = profile.platform.clone()?;
            (!platform.eq_ignore_ascii_case(MULTIROTOR)).then_some((place, platform))
        };
        let with_motors = || {
            self.profiles
                .iter()
                .filter(|(_, profile)| !profile.motors.is_empty())
        };
        let of_multirotors = with_motors().filter(|(_, profile)| foreign(profile).is_none());
        // The first of several that have as many.
        let best = of_multirotors.rev().max_by_key(|(_, profile)| profile.rotors());
        let best = best.filter(|(_, profile)| profile.rotors() > 0);
        let platform = with_motors().find_map(|(_, profile)| foreign(profile));
        if let (None, Some((place, platform))) = (best, platform) {
            return Err(format!(
                "{place}: platform_type is {platform}, no {MULTIROTOR}: its motors are not rotors in pairs"
            ));
        }
        let number = best.map_or(1, |(number, _)| *number);
        let others = with_motors().filter(|(other, _)| **other != number);
        let left_out = others.map(|(other, profile)| {
            let platform = foreign(profile).map_or_else(String::new, |(_, platform)| {
                format!(", of a vehicle of type {platform},")
            });
            format!(
                "the rotors are those of mixer_profile {number}; mixer_profile {other}{platform} is left out"
            )
        });
        let left_out = left_out.collect();
        Ok((self.profiles.remove(&number).unwrap_or_default(), left_out))
    }
}

/// The motor and its factors of the words behind `mmix`.
fn mmix(words: &[&str]) -> Option<(usize, [f64; 4])> {
    let [motor, factors @ ..] = words else { return None };
    let numbers = factors
        .iter()
        .map(|word| word.parse().ok().filter(|number: &f64| number.is_finite()));
    Some((
        motor.parse().ok()?,
        numbers.collect::<Option<Vec<_>>>()?.try_into().ok()?,
    ))
}

pub(crate) fn read(source: &Source, arm: Option<f64>) -> Result<Imported, String> {
    let file = &source.name;
    let mut dump = Dump::read(source)?;
    let (profile, mut notes) = dump.multirotor()?;
    let mut warnings = Vec::new();
    let motors = || profile.motors.iter().filter(|(_, motor)| is_rotor(motor));
    let places: Vec<[f64; 2]> = motors()
        .map(|(_, (_, [_, roll, pitch, _]))| [*roll, *pitch])
        .collect();
    if places.is_empty() {
        return Err(format!(
            "{file}: no coaxial pairs: those are `mixer OCTOX8`, `mixer OCTOX8P`, `mixer Y6`, `mixer Y4`, and lines `mmix MOTOR THROTTLE ROLL PITCH \
             YAW` with two motors in one place"
        ));
    }
    if let (Some((_, (place, _))), true) = (motors().next(), places.iter().all(|place| *place == [0.0; 2])) {
        return Err(format!(
            "{place}: no motor has a factor of roll or pitch: those are engines side by side; of a single coaxial pair \
             `cargo mixer new --frame single` makes an airframe"
        ));
    }
    let arm = outputs::arm(arm, &format!("{file}: the factors of `mmix`"))?;
    let scales = scales(&places).map(|square| arm * square.sqrt());
    let is_reversed = profile.reversed.is_some();
    let mut rotors = Vec::new();
    for (index, (channel, (place, [throttle, roll, pitch, yaw]))) in motors().enumerate() {
        let is_same = |other: &[f64; 2]| {
            (roll - other[0]).abs() < SAME_FACTOR && (pitch - other[1]).abs() < SAME_FACTOR
        };
        let is_alone = places.iter().filter(|place| is_same(place)).count() == 1;
        if *yaw == 0.0 && is_alone {
            warnings.push(format!(
                "the yaw of motor {channel} is 0, which leaves its spin open: as in Betaflight's Y4 a rotor on the right turns ccw, one on \
                 the left cw; check upper_spin"
            ));
        } else if *yaw == 0.0 {
            return Err(format!(
                "{place}: the yaw of motor {channel} is 0: its sign says how the rotor turns"
            ));
        }
        let is_lower = places[..index].iter().any(is_same);
        // To a tenth of a millimetre.
        let [x, y] = [-pitch * scales[1], -roll * scales[0]].map(|x| (x * 1e4).round() / 1e4 + 0.0);
        let down = match (is_alone, is_lower) {
            (true, _) => 0.0,
            (_, true) => LAYER_M,
            (_, false) => -LAYER_M,
        };
        rotors.push(Rotor {
            channel: *channel,
            place: place.clone(),
            position_m: [x, y, down],
            axis: UPWARD,
            spin: if (*yaw > 0.0 || *yaw == 0.0 && y > 0.0) == is_reversed {
                Spin::Cw
            } else {
                Spin::Ccw
            },
            own: Own {
                thrust: *throttle,
                yaw: yaw.abs(),
                is_reversible: dump.is_3d,
                ..Own::NONE
            },
        });
    }
    notes.extend([
        format!(
            "arms of {arm} m are assumed, shorter where the factors of roll and pitch say so: compare position_m with the vehicle"
        ),
        "of two motors in one place the first is taken for the upper rotor; --upper says otherwise".to_owned(),
        "the idle is throttle.min, 0.1 unless the pair's file has another; the stack's own, and its pulse widths, are not read"
            .to_owned(),
    ]);
    let told = direction(&dump, profile.reversed.as_ref());
    if is_reversed { &mut notes } else { &mut warnings }.extend(told);
    notes.extend(dump.reordering.as_ref().map(|order| {
        format!(
            "motor_output_reordering is {order}: `channels` counts the motors of `mmix`, from 0, and that setting, which stays, says \
             which output each has"
        )
    }));
    notes.extend(gains(&profile));
    let last = profile.motors.keys().next_back().copied().unwrap_or_default();
    let others = (0..=last).filter(|motor| !profile.motors.get(motor).is_some_and(is_rotor));
    let left_out = others.map(|channel| {
        let (place, why) = match profile.motors.get(&channel) {
            Some((place, _)) => (place, "has no part in roll, pitch and yaw, so it is no rotor"),
            None => (file, "is missing"),
        };
        let place = place.clone();
        LeftOut { channel, place, why }
    });
    Ok(Imported {
        origin: format!("{} motors of Betaflight or INAV", places.len()),
        left_out: left_out.collect(),
        first_motors: "move it to the end (Betaflight: `set motor_output_reordering`), and give the rotors the first numbers of `mmix`",
        rotors,
        airmode: Some(("roll-pitch", "the nearest to Betaflight's airmode")),
        warnings,
        notes,
        ..Imported::default()
    })
}

/// What is to be known of the direction of the motors: which way they turn is in the airframe file, so the setting
/// is the one that reverses nothing.
fn direction(dump: &Dump, reversed: Option<&(String, String)>) -> Option<String> {
    match reversed {
        Some((setting, value)) => Some(format!(
            "{setting} is {value}: upper_spin has it, and `cargo mixer params` writes factors for `yaw_motors_reversed = OFF` (Betaflight up \
             to 3.1 and INAV up to 2: `yaw_motor_direction = 1`)"
        )),
        None if dump.has_direction || dump.is_inav => None,
        None => Some(
            "the file does not say yaw_motors_reversed, so OFF is taken, the default of most boards, not of all: compare with `get \
             yaw_motors_reversed`"
                .to_owned(),
        ),
    }
}

/// The note on gains that were tuned with other factors than those that `params` writes and the header's units are of:
/// their range per axis is 2.
fn gains(profile: &Profile) -> Option<String> {
    let motors = || profile.motors.values().filter(|motor| is_rotor(motor));
    let shares = [1, 2, 3].map(|axis| {
        let of = || motors().map(move |(_, factors)| factors[axis]);
        (of().fold(f64::MIN, f64::max) - of().fold(f64::MAX, f64::min)) / RANGE
    });
    let axes = ["roll", "pitch", "yaw"].into_iter().zip(shares);
    let others = axes.filter(|(_, share)| *share > 0.0 && (share - 1.0).abs() > SAME_RANGE);
    let told: Vec<String> = others
        .map(|(axis, share)| format!("those of {axis} by {share:.3}"))
        .collect();
    (!told.is_empty()).then(|| {
        format!(
            "PID gains that were tuned with this `mmix` are multiplied, {}: `cargo mixer params` writes factors that reach from -1 to 1, \
             and the units of the generated code are of those",
            told.join(", ")
        )
    })
}

/// The settings that turn the sign of yaw, of Betaflight, of INAV, and of Cleanflight and versions before 3.2 of
/// Betaflight: `motor = .. - yaw_motor_direction * yaw`.
const DIRECTIONS: [&str; 4] = [
    "yaw_motors_reversed",
    "motor_direction_inverted",
    "yaw_motor_direction",
    "yaw_direction",
];

/// Squares s and t of the scales of roll and pitch: the least squares of roll^2 s + pitch^2 t = 1, arms of one
/// length; where no scales make them so, one scale, with which the longest is 1.
fn scales(places: &[[f64; 2]]) -> [f64; 2] {
    let squares: Vec<[f64; 2]> = places.iter().map(|place| place.map(|x| x * x)).collect();
    let sum = |of: fn(&[f64; 2]) -> f64| squares.iter().map(of).sum::<f64>();
    let weight = ONE_SCALE * sum(|[r, p]| r * r + p * p);
    let [rr, pp] = [sum(|[r, _]| r * r) + weight, sum(|[_, p]| p * p) + weight];
    let rp = sum(|[r, p]| r * p) - weight;
    let [r, p] = [sum(|[r, _]| *r), sum(|[_, p]| *p)];
    let both = [r * pp - p * rp, p * rr - r * rp].map(|x| x / (rr * pp - rp * rp));
    let is_equal = |[r, p]: &[f64; 2]| (r * both[0] + p * both[1] - 1.0).abs() < EQUAL_ARMS;
    if both.iter().all(|square| *square > LEAST_SQUARE) && squares.iter().all(is_equal) {
        return both;
    }
    let longest = squares
        .iter()
        .map(|[r, p]| r + p)
        .fold(f64::MIN_POSITIVE, f64::max);
    [1.0 / longest; 2]
}
