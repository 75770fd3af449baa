//! Rules on where the units are and what drives them.

use super::facts::Facts;
use crate::airframe::Axis;
use crate::diagnostic::{Code, Diagnostic, number, rounded};

/// Units of the largest frames whose costs were counted.
const MOST_COUNTED_UNITS: usize = 8;

/// Longest plausible arm per root of a unit's largest thrust, m / sqrt(N). Thrust grows with the
/// square of the diameter and arms with the diameter; PX4's X12, the longest in `airframes/`, has
/// 0.2, arms in decimetres 0.6 and more.
const ARM_PER_ROOT_THRUST: f64 = 0.5;

/// Shortest arm that rotors side by side leave, m / sqrt(N): real frames have 0.07 and more, rotors
/// of an X8 overlap below about 0.045.
const SHORT_ARM_PER_ROOT_THRUST: f64 = 0.03;

/// Arms in centimetres.
pub(super) fn arms(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let longest = ARM_PER_ROOT_THRUST * facts.scale[0].sqrt();
    let airframe = facts.airframe;
    let arms = airframe.units.iter().enumerate().map(|(index, unit)| {
        let [x, y, _] = unit.position_m;
        (index, (x * x + y * y).sqrt())
    });
    let too_long = arms.clone().filter(|(_, arm)| *arm > longest).count();
    let Some((index, arm)) = arms.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return;
    };
    if too_long == 0 {
        return;
    }
    let (key, written) = if airframe.states("layout") {
        (
            "layout.arm_m".to_owned(),
            format!("arm_m = {}", rounded(arm / 100.0)),
        )
    } else {
        let [x, y, z] = airframe.units[index].position_m.map(|x| rounded(x / 100.0));
        (
            format!("unit[{index}].position_m"),
            format!("position_m = [{x}, {y}, {z}]"),
        )
    };
    let others = match too_long {
        1 => String::new(),
        count => format!("; {count} units are beyond that"),
    };
    found.push(airframe.diagnostic(
        Code::LongArm,
        &key,
        format!(
            "an arm of {} m is long for rotors of {} N a unit, which take {} m at most{others}",
            rounded(arm),
            rounded(facts.scale[0]),
            rounded(longest)
        ),
        "expected metres",
        if arm / 100.0 < SHORT_ARM_PER_ROOT_THRUST * facts.scale[0].sqrt() {
            "write the distance of each mast from the centre of gravity in metres".to_owned()
        } else {
            format!("if centimetres were meant, write {written}")
        },
    ));
}

/// Arms in another unit, or a decimal point that slipped.
pub(super) fn short_arms(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let [x, y] = [0, 1].map(|k| {
        let places = airframe.units.iter().map(|unit| unit.position_m[k]);
        places.fold(0.0, |most: f64, place| most.max(place.abs()))
    });
    // What is controlled needs an arm.
    let arm = [(Axis::Pitch, x), (Axis::Roll, y)]
        .into_iter()
        .filter(|(axis, _)| airframe.allocation.controls(*axis))
        .map(|(_, arm)| arm)
        .reduce(f64::max);
    let shortest = SHORT_ARM_PER_ROOT_THRUST * facts.scale[0].sqrt();
    // An arm of 0 leaves an axis without control, which is an error; a wrong thrust is told already.
    let Some(arm) = arm.filter(|arm| *arm > 0.0 && *arm < shortest) else {
        return;
    };
    if found
        .iter()
        .any(|warning| matches!(warning.code, Code::PairUnits | Code::LopsidedPair))
    {
        return;
    }
    let key = if airframe.states("layout") {
        "layout.arm_m"
    } else {
        "unit[0].position_m"
    };
    found.push(airframe.diagnostic(
        Code::ShortArm,
        key,
        format!(
            "no unit is further than {} m from the centre of gravity forward or to a side; rotors of {} N a unit overlap below {} m",
            rounded(arm),
            rounded(facts.scale[0]),
            rounded(shortest)
        ),
        "expected metres",
        "write the distance of each mast from the centre of gravity in metres",
    ));
}

/// Angles of frames are multiples of this, degrees.
const FRAME_STEP_DEG: f64 = 7.5;

/// How far radians that are written to two digits are from such an angle, degrees.
const WRITTEN_DEG: f64 = 0.3;

/// `first_angle_deg = 0.7854`.
pub(super) fn radians(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let Some(angle) = facts.airframe.first_angle_deg else {
        return;
    };
    let in_degrees = angle.abs().to_degrees();
    let from_step =
        (in_degrees / FRAME_STEP_DEG - (in_degrees / FRAME_STEP_DEG).round()).abs() * FRAME_STEP_DEG;
    let is_plain = (2.0 * angle).fract() == 0.0;
    if is_plain || in_degrees > 361.0 || from_step > WRITTEN_DEG {
        return;
    }
    let meant = (in_degrees / FRAME_STEP_DEG).round() * FRAME_STEP_DEG * angle.signum();
    found.push(facts.airframe.diagnostic(
        Code::Radians,
        "layout.first_angle_deg",
        format!(
            "an angle of {} degrees is {} degrees if it is in radians",
            number(angle),
            rounded(in_degrees * angle.signum())
        ),
        "expected degrees",
        format!("if radians were meant, write first_angle_deg = {}", number(meant)),
    ));
}

/// Least share of the units' thrust that must be left without roll and pitch. Without an offset it
/// is 0.95 to 1 on real maps: what a torque of zero costs.
const BALANCED_SHARE: f64 = 0.65;

/// A centre of gravity so far off that most of the thrust is only there with roll or pitch.
pub(super) fn centre_of_gravity(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let controls = |axis| airframe.allocation.controls(axis);
    let Some([_, ceiling]) = facts.thrust_range_n else {
        return;
    };
    let upward: f64 = airframe.units.iter().map(|unit| -unit.axis[2]).sum();
    let whole = upward * facts.scale[0];
    let share = ceiling / whole;
    if share >= BALANCED_SHARE || !(controls(Axis::Roll) || controls(Axis::Pitch)) {
        return;
    }
    let count = airframe.units.len() as f64;
    let middle: [f64; 2] =
        [0, 1].map(|k| airframe.units.iter().map(|unit| unit.position_m[k]).sum::<f64>() / count);
    // Only what is controlled must balance: x makes pitch, y makes roll.
    let counts = [controls(Axis::Pitch), controls(Axis::Roll)];
    let [x, y] = [0, 1].map(|k| if counts[k] { middle[k] } else { 0.0 });
    let words = [(x, "in front of", "behind"), (y, "right of", "left of")];
    let sides: Vec<String> = words
        .into_iter()
        .filter(|(offset, ..)| offset.abs() > 1e-3)
        .map(|(offset, positive, negative)| {
            let side = if offset > 0.0 { positive } else { negative };
            format!("{} m {side} it", rounded(offset.abs()))
        })
        .collect();
    let where_ = if sides.is_empty() {
        "the units do not balance each other".to_owned()
    } else {
        format!("the middle of the units is {}", sides.join(" and "))
    };
    let key = if airframe.states("layout") {
        "layout"
    } else {
        "unit[0].position_m"
    };
    found.push(airframe.diagnostic(
        Code::CentreOfGravity,
        key,
        format!(
            "balanced about the centre of gravity, {} N of {} N of thrust can be used, {:.0} %: {where_}",
            rounded(ceiling),
            rounded(whole),
            100.0 * share
        ),
        "",
        "positions count from the centre of gravity, x forward and y right; check signs and origin",
    ));
}

/// A single unit whose outputs are in the reverse of the others' order.
pub(super) fn channels(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let reversed: Vec<usize> = airframe
        .units
        .iter()
        .enumerate()
        .filter(|(_, unit)| unit.upper_channel > unit.lower_channel)
        .map(|(index, _)| index)
        .collect();
    let count = airframe.units.len();
    let odd = match (count, reversed.as_slice()) {
        (3.., [only]) => *only,
        (3.., most) if most.len() == count - 1 => match (0..count).find(|index| !most.contains(index)) {
            Some(other) => other,
            None => return,
        },
        _ => return,
    };
    let Some(unit) = airframe.units.get(odd) else {
        return;
    };
    let (upper, lower) = (unit.upper_channel, unit.lower_channel);
    let key = if airframe.states("layout.channels") {
        "layout.channels".to_owned()
    } else {
        format!("unit[{odd}].channels")
    };
    found.push(airframe.diagnostic(
        Code::RotorsExchanged,
        &key,
        format!(
            "the upper rotor of `unit[{odd}]` has output {upper} and the lower one {lower}, in the reverse of the order of \
             all other units"
        ),
        "upper rotor first",
        format!("if they are exchanged, write [{lower}, {upper}]"),
    ));
}

/// More units than costs are known for.
pub(super) fn many_units(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let counted = MOST_COUNTED_UNITS;
    let units = airframe.units.len();
    if units <= counted {
        return;
    }
    let key = if airframe.states("layout.units") {
        "layout.units".to_owned()
    } else {
        format!("unit[{counted}]")
    };
    found.push(airframe.diagnostic(
        Code::ManyUnits,
        &key,
        format!("{units} units are more than the {counted} up to which a mix's instructions are counted"),
        "",
        "measure the longest mix on your target before you rely on a deadline",
    ));
}
