//! The text of Betaflight's and INAV's `diff all` or `dump`: `mixer NAME` is one of Betaflight's
//! tables, `mmix N THROTTLE ROLL PITCH YAW` a motor of a table of one's own.
//!
//! A factor of roll is positive on the left, one of pitch at the rear, one of yaw where the rotor
//! turns counter-clockwise (Betaflight's `mixer_init.c`, INAV's `docs/Mixer.md`). They have no
//! metres, and roll and pitch have scales of their own: those that make all arms equal are taken.

use mixer_compiler::Source;
use mixer_compiler::airframe::Spin;

use super::outputs;
use super::parameters::words;
use super::rotors::{Imported, Own, Rotor, UPWARD};
use crate::params::frames::LAYER_M;

/// Betaflight's coaxial tables (`mixerOctoX8`, `mixerY6`): roll, pitch, yaw; throttle is 1. The
/// second half of the motors is under the first.
#[rustfmt::skip]
pub(crate) const TABLES: [(&str, &[[f64; 3]]); 2] = [
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

/// Share by which squares of arms may differ that are equal.
const EQUAL_ARMS: f64 = 0.02;

/// Squares of scales below which all arms would lie on one line.
const LEAST_SQUARE: f64 = 0.01;

/// Weight of one scale for roll and pitch, which decides where equal arms leave them open.
const ONE_SCALE: f64 = 1e-6;

/// A motor: its place in the text, and its factors of throttle, roll, pitch and yaw.
type Motor = (String, [f64; 4]);

/// Whether a text is one: by lines that no file of parameters has. PX4's older scripts load a mixer.
pub(super) fn is_dump(text: &str) -> bool {
    text.lines().any(|line| match words(line)[..] {
        ["mmix" | "board_name" | "mixer_profile", ..] => true,
        ["mixer", name] => name != "load",
        _ => false,
    })
}

/// The motors, and whether all turn the other way.
fn motors(source: &Source) -> Result<(Vec<Motor>, bool), String> {
    let (mut motors, mut table, mut is_reversed) = (Vec::new(), None, false);
    for (line, number) in source.text.lines().zip(1..) {
        let content = line.split('#').next().unwrap_or_default();
        let content = content.split("//").next().unwrap_or_default().trim();
        let place = format!("{}:{number}", source.name);
        match words(content)[..] {
            // Of INAV's mixer profiles the first is read.
            ["mixer_profile", profile] if profile != "1" => break,
            ["mixer", name] if !name.eq_ignore_ascii_case("custom") => {
                let known = TABLES.iter().find(|(known, _)| name.eq_ignore_ascii_case(known));
                let motors = known.map_or(&[][..], |(_, motors)| *motors).iter();
                let factors = motors.map(|[roll, pitch, yaw]| [1.0, *roll, *pitch, *yaw]);
                table = Some(factors.map(|factors| (place.clone(), factors)).collect());
            }
            ["mmix", "reset"] => motors.clear(),
            ["mmix", ref rest @ ..] => {
                let numbers = rest.iter().filter_map(|word| word.parse().ok());
                let numbers: Vec<f64> = numbers.filter(|number: &f64| number.is_finite()).collect();
                match numbers[..] {
                    [motor, throttle, roll, pitch, yaw]
                        if rest.len() == numbers.len() && motor == motors.len() as f64 =>
                    {
                        if throttle > 0.0 {
                            motors.push((place, [throttle, roll, pitch, yaw]));
                        }
                    }
                    _ => {
                        return Err(format!(
                            "{place}: `{content}` is not `mmix {} THROTTLE ROLL PITCH YAW`, the next motor",
                            motors.len()
                        ));
                    }
                }
            }
            ["set", "yaw_motors_reversed" | "motor_direction_inverted", value] => {
                is_reversed = value.eq_ignore_ascii_case("ON");
            }
            _ => {}
        }
    }
    Ok((table.unwrap_or(motors), is_reversed))
}

pub(super) fn read(source: &Source, arm: Option<f64>) -> Result<Imported, String> {
    let file = &source.name;
    let (motors, is_reversed) = motors(source)?;
    if motors.is_empty() {
        return Err(format!(
            "{file}: no coaxial pairs: those are `mixer OCTOX8`, `mixer Y6`, and lines `mmix MOTOR THROTTLE ROLL PITCH YAW` \
             with two motors in one place"
        ));
    }
    let arm = outputs::arm(arm, &format!("{file}: the factors of `mmix`"))?;
    let places: Vec<[f64; 2]> = motors
        .iter()
        .map(|(_, [_, roll, pitch, _])| [*roll, *pitch])
        .collect();
    let scales = scales(&places).map(|square| arm * square.sqrt());
    let mut rotors = Vec::new();
    let is_3d = source
        .text
        .lines()
        .any(|line| words(line)[..] == ["feature", "3D"]);
    for (channel, (place, [throttle, roll, pitch, yaw])) in motors.iter().enumerate() {
        let is_same = |other: &[f64; 2]| {
            (roll - other[0]).abs() < SAME_FACTOR && (pitch - other[1]).abs() < SAME_FACTOR
        };
        // A rotor that is alone is told of later.
        if *yaw == 0.0 && places.iter().filter(|place| is_same(place)).count() > 1 {
            return Err(format!(
                "{place}: the yaw of motor {channel} is 0: its sign says how the rotor turns"
            ));
        }
        let is_lower = places[..channel].iter().any(is_same);
        // To a tenth of a millimetre.
        let [x, y] = [-pitch * scales[1], -roll * scales[0]].map(|x| (x * 1e4).round() / 1e4 + 0.0);
        rotors.push(Rotor {
            channel,
            place: place.clone(),
            position_m: [x, y, if is_lower { LAYER_M } else { -LAYER_M }],
            axis: UPWARD,
            spin: if (*yaw > 0.0) == is_reversed {
                Spin::Cw
            } else {
                Spin::Ccw
            },
            own: Own {
                thrust: *throttle,
                yaw: yaw.abs(),
                is_reversible: is_3d,
                ..Own::NONE
            },
        });
    }
    let notes = [
        format!(
            "arms of {arm} m are assumed, shorter where the factors of roll and pitch say so: compare position_m with the vehicle"
        ),
        "of two motors in one place the first is taken for the upper rotor; --upper says otherwise".to_owned(),
        "the idle is throttle.min, 0.1 unless the pair's file has another; the stack's own, and its pulse widths, are not read"
            .to_owned(),
    ];
    Ok(Imported {
        origin: format!("{} motors of Betaflight or INAV", motors.len()),
        rotors,
        airmode: Some(("roll-pitch", "the nearest to Betaflight's airmode")),
        notes: notes.into(),
        ..Imported::default()
    })
}

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
