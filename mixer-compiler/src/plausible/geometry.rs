//! Rules on where the units are and what drives them.

use super::rule::{Facts, Rule};
use super::symmetry;
use crate::airframe::{Axis, Unit};
use crate::diagnostic::{Code, number, rounded};
use crate::model::scales;

/// Units of the largest frames whose costs were counted.
const MOST_COUNTED_UNITS: usize = 8;

/// Longest plausible arm per root of a unit's largest thrust, m / sqrt(N). Thrust grows with the
/// square of the diameter and arms with the diameter; PX4's X12, the longest in `airframes/`, has
/// 0.2, arms in decimetres 0.6 and more.
const ARM_PER_ROOT_THRUST: f64 = 0.5;

/// Shortest arm that rotors side by side leave, m / sqrt(N): real frames have 0.07 and more, rotors
/// of an X8 overlap below about 0.045.
const SHORT_ARM_PER_ROOT_THRUST: f64 = 0.03;

/// Angles of frames are multiples of this, degrees.
const FRAME_STEP_DEG: f64 = 7.5;

/// How far radians that are written to two digits are from such an angle, degrees.
const WRITTEN_DEG: f64 = 0.3;

/// Least share of the units' thrust that must be left without roll and pitch. Without an offset it
/// is 0.95 to 1 on real maps: what a torque of zero costs.
const BALANCED_SHARE: f64 = 0.65;

/// A place that breaks the symmetry of all others.
pub(super) fn odd_place(facts: &Facts<'_>) -> Vec<Rule> {
    let units = &facts.airframe.units;
    let places: Vec<[f64; 3]> = units.iter().map(|unit| unit.position_m).collect();
    let Some((unit, told)) = symmetry::broken(&places) else {
        return Vec::new();
    };
    let key = facts.place("layout", format!("unit[{unit}].position_m"));
    vec![Rule::holds(Code::OddPlace, key, false).says(
        told,
        "unlike its mirror image",
        "check the sign and the decimal point; a frame that is meant so flies as it is written",
    )]
}

/// Arms in another unit, or with a decimal point that slipped.
pub(super) fn arms(facts: &Facts<'_>) -> Vec<Rule> {
    const LABEL: &str = "expected metres";
    const HELP: &str = "write the distance of each mast from the centre of gravity in metres";
    let units = &facts.airframe.units;
    let root = facts.scale[0].sqrt();
    let (longest, shortest) = (ARM_PER_ROOT_THRUST * root, SHORT_ARM_PER_ROOT_THRUST * root);
    let arms: Vec<f64> = units
        .iter()
        .map(|unit| libm::hypot(unit.position_m[0], unit.position_m[1]))
        .collect();
    let furthest = (0..units.len())
        .max_by(|a, b| arms[*a].total_cmp(&arms[*b]))
        .unwrap_or(0);
    let arm = arms[furthest];
    let key = |unit: usize| facts.place("layout.arm_m", format!("unit[{unit}].position_m"));
    let [x, y, z] = units[furthest].position_m.map(|x| rounded(x / 100.0));
    let help = match facts.airframe.states("layout") {
        _ if arm / 100.0 < shortest => HELP.to_owned(),
        true => format!(
            "if centimetres were meant, write arm_m = {}",
            rounded(arm / 100.0)
        ),
        false => format!("if centimetres were meant, write position_m = [{x}, {y}, {z}]"),
    };
    let others = match arms.iter().filter(|arm| **arm > longest).count() {
        0 | 1 => String::new(),
        count => format!("; {count} units are beyond that"),
    };
    // What is controlled needs an arm: x makes pitch, y makes roll. An arm of 0 leaves an axis without
    // control, which is an error.
    let reach = [(Axis::Pitch, 0), (Axis::Roll, 1)]
        .into_iter()
        .filter(|(axis, _)| facts.controls(*axis))
        .flat_map(|(_, k)| units.iter().map(move |unit| unit.position_m[k].abs()))
        .fold(0.0, f64::max);
    let [arm_m, thrust_n, longest_m, reach_m, shortest_m] =
        [arm, facts.scale[0], longest, reach, shortest].map(rounded);
    vec![
        Rule::at_most(Code::LongArm, key(furthest), arm, longest).says(
            format!(
                "an arm of {arm_m} m is long for rotors of {thrust_n} N a unit, which take {longest_m} m at most{others}"
            ),
            LABEL,
            help,
        )
        .unless_explained(&[Code::OddPlace]),
        Rule::holds(Code::ShortArm, key(0), reach == 0.0 || reach >= shortest)
            .says(
                format!(
                    "no unit is further than {reach_m} m from the centre of gravity forward or to a side; rotors of \
                     {thrust_n} N a unit overlap below {shortest_m} m"
                ),
                LABEL,
                HELP,
            )
            .unless_explained(&[Code::PairUnits, Code::LopsidedPair]),
    ]
}

/// `first_angle_deg = 0.7854`.
pub(super) fn radians(facts: &Facts<'_>) -> Vec<Rule> {
    let Some(angle) = facts.airframe.first_angle_deg else {
        return Vec::new();
    };
    let degrees = angle.to_degrees();
    let meant = (degrees / FRAME_STEP_DEG).round() * FRAME_STEP_DEG;
    let is_plain = (2.0 * angle).fract() == 0.0;
    let is_far = degrees.abs() > 361.0 || (degrees - meant).abs() > WRITTEN_DEG;
    vec![
        Rule::holds(Code::Radians, "layout.first_angle_deg", is_plain || is_far).says(
            format!(
                "an angle of {} degrees is {} degrees if it is in radians",
                number(angle),
                rounded(degrees)
            ),
            "expected degrees",
            format!("if radians were meant, write first_angle_deg = {}", number(meant)),
        ),
    ]
}

/// A centre of gravity so far off that most of the thrust is only there with roll or pitch.
pub(super) fn centre_of_gravity(facts: &Facts<'_>) -> Vec<Rule> {
    let units = &facts.airframe.units;
    // Only what is controlled must balance: x makes pitch, y makes roll.
    let counts = [Axis::Pitch, Axis::Roll].map(|axis| facts.controls(axis));
    let (Some([_, ceiling]), true) = (facts.thrust_range_n, counts != [false; 2]) else {
        return Vec::new();
    };
    let sizes = scales(facts.airframe, [1.0; 2]).into_iter();
    let whole: f64 = units
        .iter()
        .zip(sizes)
        .map(|(unit, size)| -unit.axis[2] * size[0])
        .sum();
    let middle = |k: usize| units.iter().map(|unit| unit.position_m[k]).sum::<f64>() / units.len() as f64;
    let sides: Vec<String> = [("in front of", "behind"), ("right of", "left of")]
        .into_iter()
        .enumerate()
        .filter(|(k, _)| counts[*k] && middle(*k).abs() > 1e-3)
        .map(|(k, (positive, negative))| {
            let side = if middle(k) > 0.0 { positive } else { negative };
            format!("{} m {side} it", rounded(middle(k).abs()))
        })
        .collect();
    let why = match sides.as_slice() {
        [] => "the units do not balance each other".to_owned(),
        sides => format!("the middle of the units is {}", sides.join(" and ")),
    };
    let share = ceiling / whole;
    let key = facts.place("layout", "unit[0].position_m".to_owned());
    vec![
        Rule::holds(Code::CentreOfGravity, key, share >= BALANCED_SHARE).says(
            format!(
                "balanced about the centre of gravity, {} N of {} N of thrust can be used, {:.0} %: {why}",
                rounded(ceiling),
                rounded(whole),
                100.0 * share
            ),
            "",
            "positions count from the centre of gravity, x forward and y right; check signs and origin",
        )
        .unless_explained(&[Code::OddPlace]),
    ]
}

/// A single unit whose outputs are in the reverse of the others' order; more units than costs are
/// known for.
pub(super) fn outputs(facts: &Facts<'_>) -> Vec<Rule> {
    let units = &facts.airframe.units;
    let count = units.len();
    let is_reversed = |unit: usize| {
        let Unit {
            upper_channel,
            lower_channel,
            ..
        } = &units[unit];
        lower_channel.is_some_and(|lower| *upper_channel > lower)
    };
    let reversed = (0..count).filter(|unit| is_reversed(*unit)).count();
    let odd = match reversed {
        // A single rotor has no order.
        _ if units.iter().any(|unit| unit.lower_channel.is_none()) => None,
        1 if count > 2 => (0..count).find(|unit| is_reversed(*unit)),
        _ if count > 2 && reversed + 1 == count => (0..count).find(|unit| !is_reversed(*unit)),
        _ => None,
    };
    let exchanged = odd.and_then(|odd| {
        let (upper, lower) = (units[odd].upper_channel, units[odd].lower_channel?);
        let key = facts.place("layout.channels", format!("unit[{odd}].channels"));
        Some(Rule::holds(Code::RotorsExchanged, key, false).says(
            format!(
                "the upper rotor of `unit[{odd}]` has output {upper} and the lower one {lower}, in the reverse of the order \
                 of all other units"
            ),
            "upper rotor first",
            format!("if they are exchanged, write [{lower}, {upper}]"),
        ))
    });
    let most = MOST_COUNTED_UNITS;
    let key = facts.place("layout.units", format!("unit[{most}]"));
    let many = Rule::holds(Code::ManyUnits, key, count <= most).says(
        format!("{count} units are more than the {most} up to which a mix's instructions are counted"),
        "",
        "measure the longest mix on your target before you rely on a deadline",
    );
    exchanged.into_iter().chain([many]).collect()
}
