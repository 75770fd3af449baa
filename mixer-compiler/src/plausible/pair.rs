//! Rules on the map of a unit, its idle and its power.

use super::rule::{Facts, KindFacts, Rule};
use crate::airframe::Pair;
use crate::diagnostic::{Code, number, rounded};
use crate::model::{GROWTH, TORQUE_SPAN_M};

/// Largest thrust of one unit that is taken for newtons. Beyond it both may be in gram-force.
const LARGEST_THRUST_N: f64 = 2000.0;

/// Units that benches record in the place of N and of N m: key, unit, its size.
const UNITS: [(&str, &str, f64); 8] = [
    ("thrust_n", "gf", 0.009_806_65),
    ("thrust_n", "kgf", 9.806_65),
    ("thrust_n", "lbf", 4.448_222),
    ("torque_nm", "N mm", 0.001),
    ("torque_nm", "N cm", 0.01),
    ("torque_nm", "kgf m", 9.806_65),
    ("torque_nm", "gf cm", 9.806_65e-5),
    ("torque_nm", "lbf in", 0.112_984_8),
];

/// Largest share of a unit's thrust that is on at idle. Idles at which real maps begin to be
/// invertible have up to 0.09; maps that were measured from a throttle of 0.4 on have 0.2 to 0.26.
const IDLE_SHARE: f64 = 0.15;

/// ArduPilot does not arm with a larger `MOT_SPIN_MIN` (`AP_MotorsMulticopter::arming_checks`).
pub const ARDUPILOT_MOST_SPIN_MIN: f64 = 0.3;

/// The range of f over the power of one pair at full throttle, N/W: 0.041 to 0.099 on maps of 11 to
/// 22 inch.
const THRUST_PER_POWER: [f64; 2] = [0.01, 0.5];

/// Units of power in place of watts, with their size in W.
const POWER_UNITS: [(&str, f64); 2] = [("mW", 0.001), ("kW", 1000.0)];

/// Largest ratio of the powers of the two rotors, each at full throttle with the other at idle:
/// 0.97 to 1.31 on real maps.
const POWERS: f64 = 2.0;

/// The power of the throttle that electrical power follows from idle to full: 1.7 to 2.6 on real
/// maps; standby takes some at a low idle.
const POWER_GROWTH: [f64; 2] = [1.2, 3.5];

/// Thrust over torque tells the units of both.
pub(super) fn units(facts: &KindFacts<'_>) -> Vec<Rule> {
    let torques = facts.border.iter().map(|[_, q]| *q);
    let span = torques.clone().fold(f64::NEG_INFINITY, f64::max) - torques.fold(f64::INFINITY, f64::min);
    let thrust = facts.scale[0];
    let ratio = span / thrust;
    let [low, high] = TORQUE_SPAN_M;
    // Too much torque for the thrust: the thrust is in a larger unit, or the torque in a smaller one.
    let would_do = |key: &str, size: f64| match key {
        "thrust_n" => (low..=high).contains(&(ratio / size)),
        _ => (low..=high).contains(&(ratio * size)),
    };
    let candidates = UNITS.iter().filter(|(key, _, size)| would_do(key, *size));
    let key = candidates.clone().next().map_or("torque_nm", |(key, ..)| key);
    let words: Vec<String> = candidates
        .map(|(key, unit, size)| format!("{key} is in {unit} (multiply by {})", number(*size)))
        .collect();
    let help = match words.as_slice() {
        [] => "check the units of thrust_n (N) and of torque_nm (N m)".to_owned(),
        words => format!("it would be plausible if {}", words.join(", or ")),
    };
    let message = format!(
        "the torque of one unit spans {} N m at {} N of thrust, a ratio of {} m; propellers of 4 to 40 inch have {low} \
         to {high} m",
        rounded(span),
        rounded(thrust),
        rounded(ratio)
    );
    vec![
        Rule::within(Code::PairUnits, format!("pair.{key}"), ratio, TORQUE_SPAN_M).says(
            message,
            "in another unit?",
            help,
        ),
        Rule::at_most(Code::PairUnits, "pair.thrust_n", thrust, LARGEST_THRUST_N)
            .says(
                format!("one unit gives up to {} N", rounded(thrust)),
                "expected newtons",
                "if thrust and torque were in gf and gf m, multiply all coefficients by 0.00980665",
            )
            .unless_explained(&[Code::PairUnits]),
    ]
}

/// Both rotors together: in a wake they give less thrust than the sum of each alone, 0.77 to 0.92 of
/// it on real maps.
pub(super) fn wake(facts: &KindFacts<'_>, _: &Pair) -> Vec<Rule> {
    let alone = facts.upper[0] + facts.lower[0];
    let [both, upper, lower] = [facts.full, facts.upper, facts.lower].map(|efforts| rounded(efforts[0]));
    vec![
        Rule::at_most(Code::NotCoaxial, "pair.thrust_n", facts.full[0], alone).says(
            format!(
                "both rotors at full throttle give {both} N, each alone {upper} N and {lower} N, the other at idle"
            ),
            "more than the sum",
            "in a wake the sum falls; check the order of the coefficients, which that of the basis fixes",
        ),
    ]
}

/// At idle a unit leaves most of its thrust to control with.
pub(super) fn idle(facts: &KindFacts<'_>) -> Vec<Rule> {
    let (idle, most) = (facts.view.throttle.min, ARDUPILOT_MOST_SPIN_MIN);
    let (floor, share) = (rounded(facts.idle[0]), facts.idle[0] / facts.scale[0]);
    let ardupilot = match idle > most {
        true => format!("; ArduPilot does not arm with a MOT_SPIN_MIN above {most}"),
        false => String::new(),
    };
    vec![
        Rule::at_most(Code::HighIdle, "throttle.min", share, IDLE_SHARE).says(
            format!("at idle one unit gives {floor} N, {:.0} % of its largest thrust", 100.0 * share),
            "always on",
            format!(
                "an idle is typically 0.05 to 0.15; where the bench only began here, measure further down{ardupilot}"
            ),
        ),
    ]
}

/// An idle with which ArduPilot does not arm.
pub(super) fn spin_min(facts: &Facts<'_>) -> Vec<Rule> {
    let (idle, most) = (facts.airframe.throttle.min, ARDUPILOT_MOST_SPIN_MIN);
    vec![
        Rule::at_most(Code::SpinMin, "throttle.min", idle, most)
            .says(
                format!("an idle of {}: ArduPilot does not arm with a MOT_SPIN_MIN above {most}", number(idle)),
                "above ArduPilot's limit",
                format!(
                    "where the map inverts from {most} on, set throttle.min = {most}: `cargo mixer check` states the least \
                     idle; with ArduPilot the motors otherwise idle at {most} on the ground and step up at take-off"
                ),
            )
            .unless_explained(&[Code::HighIdle]),
    ]
}

/// The power of the throttle with which a value grows from the first throttle to the second.
fn power_law([from, to]: [f64; 2], [low, high]: [f64; 2]) -> f64 {
    libm::log(to / from) / libm::log(high / low)
}

/// The thrust that a rotor adds with the other at full throttle, over what it adds with the other at idle:
/// less in a wake, 0.75 to 0.94 on real maps.
const LEFT: [f64; 2] = [0.65, 1.0];

/// Warnings that say more than one of [`Code::PairShape`].
const OF_SHAPE: &[Code] = &[
    Code::PairUnits,
    Code::RotorsExchanged,
    Code::NotCoaxial,
    Code::LopsidedPair,
    Code::PairShape,
];

/// A rule on the shape of a map. Programs write a deviation beside their coefficients, which are then right as such.
fn of_shape(facts: &KindFacts<'_>, holds: bool, message: String) -> Rule {
    let (label, mend) = match &facts.view.of.measured().uncertainty {
        None => (
            "a coefficient off?",
            "check each coefficient and their order, which that of the basis fixes",
        ),
        Some(_) => (
            "the bench's throttle or load cells?",
            "see what identify or predict say of the bench file: pulses of another range, a linearised throttle, a load cell off",
        ),
    };
    let rule = Rule::holds(Code::PairShape, "pair.thrust_n", holds);
    rule.says(message, label, mend).unless_explained(OF_SHAPE)
}

/// How thrust grows: a coefficient that is off or out of order shows there, whatever its size.
pub(super) fn growth(facts: &KindFacts<'_>) -> Vec<Rule> {
    let [idle, full] = facts.map.range();
    let middle = 0.5 * (idle + full);
    let half = facts.map.efforts([middle; 2])[0];
    let growth = power_law([half, facts.full[0]], [middle, full]);
    let [least, most] = GROWTH;
    let message = format!(
        "from throttles of {} to {} the thrust grows with their power {growth:.2}; rotors have {least} to {most}",
        rounded(middle),
        number(full)
    );
    vec![of_shape(facts, (least..=most).contains(&growth), message)]
}

/// What either rotor leaves of the other.
pub(super) fn left(facts: &KindFacts<'_>, _: &Pair) -> Vec<Rule> {
    let left = |own: [f64; 2], other: [f64; 2]| (facts.full[0] - other[0]) / (own[0] - facts.idle[0]);
    let both = [left(facts.upper, facts.lower), left(facts.lower, facts.upper)];
    let holds = both.iter().all(|share| (LEFT[0]..=LEFT[1]).contains(share));
    let [upper, lower, least, most] = [both[0], both[1], LEFT[0], LEFT[1]].map(|share| 100.0 * share);
    let message = format!(
        "with the other rotor at full throttle the upper one adds {upper:.0} % of the thrust that it adds with the other \
         at idle, the lower one {lower:.0} %; pairs have {least:.0} to {most:.0} %"
    );
    vec![of_shape(facts, holds, message)]
}

/// A pair that stands in.
pub(super) fn borrowed(_: &KindFacts<'_>, pair: &Pair) -> Vec<Rule> {
    let from = &pair.borrowed_from;
    let rule = Rule::holds(Code::BorrowedPair, "pair.borrowed_from", from.is_empty());
    vec![rule.says(
        format!("the pair is that of {from}, not of this vehicle: its thrust, torque and hover are not yours"),
        "stands in",
        "replace [pair] by what `cargo mixer identify` makes of your bench file, or `cargo mixer predict` of a data sheet",
    )]
}

/// Thrust over power tells the unit of the power; its growth and its two rotors, coefficients that
/// are off.
pub(super) fn power(facts: &KindFacts<'_>, pair: &Pair) -> Vec<Rule> {
    let Some(power) = &pair.power else {
        return Vec::new();
    };
    let [idle, full] = facts.map.range();
    let watts = power.at([full; 2]);
    let per_watt = |watts: f64| facts.full[0] / watts;
    let [low, high] = THRUST_PER_POWER;
    let unit = POWER_UNITS
        .iter()
        .find(|(_, size)| (low..=high).contains(&per_watt(watts * size)));
    let help = match unit {
        Some((unit, size)) => format!("it would be plausible if power_w is in {unit} (multiply by {size})"),
        None => "check the unit of power_w (W, of both rotors)".to_owned(),
    };
    let [upper, lower] = [[full, idle], [idle, full]].map(|at| power.at(at));
    let growth = power_law([power.at([idle; 2]), watts], [idle, full]);
    let [least, most] = POWER_GROWTH;
    let is_even = (1.0 / POWERS..=POWERS).contains(&(upper / lower));
    let key = "pair.power.power_w";
    vec![
        Rule::within(Code::PowerUnits, key, per_watt(watts), THRUST_PER_POWER)
            .says(
                format!(
                    "at full throttle one unit takes {} W for {} N, {} N/W; pairs of 4 to 40 inch give {low} to {high} N/W",
                    rounded(watts),
                    rounded(facts.full[0]),
                    rounded(per_watt(watts))
                ),
                "in another unit?",
                help,
            )
            .unless_explained(&[Code::PairUnits]),
        Rule::holds(Code::PowerUnits, key, is_even && (least..=most).contains(&growth))
            .says(
                format!(
                    "the power grows with the throttle to the power {}, and is {} W with the upper rotor alone at full \
                     throttle, {} W with the lower one",
                    rounded(growth),
                    rounded(upper),
                    rounded(lower)
                ),
                format!("expected a power of {least} to {most} and rotors within a factor of {POWERS}"),
                "one coefficient may be off, or out of order: those of the quartic basis and a constant at the end",
            )
            .unless_explained(&[Code::PairUnits, Code::PowerUnits]),
    ]
}
