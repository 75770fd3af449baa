//! Rules on the pair's map and its idle.

use super::facts::Facts;
use crate::diagnostic::{Code, Diagnostic, number, rounded};

/// The range of Q over the largest f of one unit, m: 0.016 to 0.034 on maps of 11 to 22 inch. It is
/// about the propeller's diameter over 17, so that these limits stand for 4 to 40 inch. The nearest
/// unit that may be mistaken, pounds of force, is a factor of 4.4 away.
const RATIO_M: [f64; 2] = [0.005, 0.065];

/// Largest thrust of one unit that is taken for newtons. Beyond it both may be in gram-force.
const LARGEST_THRUST_N: f64 = 2000.0;

/// Units that benches record, with their size in N and in N m.
const THRUST_UNITS: [(&str, f64); 3] = [("gf", 0.009_806_65), ("kgf", 9.806_65), ("lbf", 4.448_222)];
const TORQUE_UNITS: [(&str, f64); 5] = [
    ("N mm", 0.001),
    ("N cm", 0.01),
    ("kgf m", 9.806_65),
    ("gf cm", 9.806_65e-5),
    ("lbf in", 0.112_984_8),
];

/// Thrust over torque tells the units of both.
pub(super) fn units(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let border: Vec<[f64; 2]> = facts
        .map
        .border(32)
        .into_iter()
        .map(|at| facts.map.efforts(at))
        .collect();
    let torques = border.iter().map(|[_, q]| *q);
    let span = torques.clone().fold(f64::NEG_INFINITY, f64::max) - torques.fold(f64::INFINITY, f64::min);
    let thrust = facts.scale[0];
    let ratio = span / thrust;
    let [low, high] = RATIO_M;
    if (low..=high).contains(&ratio) {
        if thrust > LARGEST_THRUST_N {
            found.push(facts.airframe.diagnostic(
                Code::PairUnits,
                "pair.thrust_n",
                format!("one unit gives up to {} N", rounded(thrust)),
                "expected newtons",
                "if thrust and torque were in gf and gf m, multiply all coefficients by 0.00980665",
            ));
        }
        return;
    }
    // Too much torque for the thrust: the thrust is in a larger unit, or the torque in a smaller
    // one.
    let plausible = |ratio: f64| (low..=high).contains(&ratio);
    let thrusts = THRUST_UNITS
        .iter()
        .filter(|(_, newtons)| plausible(ratio / newtons))
        .map(|(unit, newtons)| format!("thrust_n is in {unit} (multiply by {})", number(*newtons)));
    let torques = TORQUE_UNITS
        .iter()
        .filter(|(_, newton_metres)| plausible(ratio * newton_metres))
        .map(|(unit, size)| format!("torque_nm is in {unit} (multiply by {})", number(*size)));
    let candidates: Vec<String> = thrusts.chain(torques).collect();
    let help = if candidates.is_empty() {
        "check the units of thrust_n (N) and of torque_nm (N m)".to_owned()
    } else {
        format!("it would be plausible if {}", candidates.join(", or "))
    };
    found.push(facts.airframe.diagnostic(
        Code::PairUnits,
        if candidates.iter().any(|text| text.starts_with("thrust")) {
            "pair.thrust_n"
        } else {
            "pair.torque_nm"
        },
        format!(
            "the torque of one unit spans {} N m at {} N of thrust, a ratio of {} m; propellers of 4 to 40 inch have {} \
             to {} m",
            rounded(span),
            rounded(thrust),
            rounded(ratio),
            number(low),
            number(high)
        ),
        "in another unit?",
        help,
    ));
}

/// The wake costs thrust: both rotors give less than the sum of each alone. On real maps the share
/// is 0.77 to 0.92.
pub(super) fn sum_of_rotors(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let [low, high] = facts.map.range();
    let thrust = |u, l| facts.map.efforts([u, l])[0];
    let both = thrust(high, high);
    let alone = thrust(high, low) + thrust(low, high);
    if both <= alone {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::NotCoaxial,
        "pair.thrust_n",
        format!(
            "both rotors at full throttle give {} N, each alone {} N and {} N, the other at idle",
            rounded(both),
            rounded(thrust(high, low)),
            rounded(thrust(low, high))
        ),
        "more than the sum",
        "in a wake the sum falls; check the order of the coefficients, which that of the basis fixes",
    ));
}

/// Largest share of a unit's thrust that is on at idle. Idles at which real maps begin to be
/// invertible have up to 0.09; maps that were measured from a throttle of 0.4 on have 0.2 to 0.26.
pub(super) const IDLE_SHARE: f64 = 0.15;

/// ArduPilot does not arm with a larger `MOT_SPIN_MIN` (`AP_MotorsMulticopter::arming_checks`).
pub const ARDUPILOT_MOST_SPIN_MIN: f64 = 0.3;

/// Thrust of one unit with both rotors at idle, N.
fn idle_thrust(facts: &Facts<'_>) -> f64 {
    let [low, _] = facts.map.range();
    facts.map.efforts([low, low])[0]
}

/// The same over the largest thrust.
pub(super) fn idle_share(facts: &Facts<'_>) -> f64 {
    idle_thrust(facts) / facts.scale[0]
}

/// A high idle leaves little thrust to control with.
pub(super) fn idle(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let (floor, share) = (idle_thrust(facts), idle_share(facts));
    if share <= IDLE_SHARE {
        return;
    }
    let most = ARDUPILOT_MOST_SPIN_MIN;
    let ardupilot = if facts.airframe.throttle.min > most {
        format!(
            "; ArduPilot does not arm with a MOT_SPIN_MIN above {}",
            number(most)
        )
    } else {
        String::new()
    };
    found.push(facts.airframe.diagnostic(
        Code::HighIdle,
        "throttle.min",
        format!(
            "at idle one unit gives {} N, {:.0} % of its largest thrust",
            rounded(floor),
            100.0 * share
        ),
        "always on",
        format!(
            "an idle is typically 0.05 to 0.15; where the bench only began here, measure the pair further down{ardupilot}"
        ),
    ));
}

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

/// Thrust over power tells the unit of the power, unless that of the thrust is in doubt.
pub(super) fn power(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let Some(power) = &facts.airframe.pair.power else {
        return;
    };
    if found.iter().any(|warning| warning.code == Code::PairUnits) {
        return;
    }
    let [idle, full] = facts.map.range();
    let [thrust, _] = facts.map.efforts([full; 2]);
    let watts = power.at([full; 2]);
    let [low, high] = THRUST_PER_POWER;
    let plausible = |watts: f64| (low..=high).contains(&(thrust / watts));
    let (key, code) = ("pair.power.power_w", Code::PowerUnits);
    if !plausible(watts) {
        let unit = POWER_UNITS.iter().find(|(_, size)| plausible(watts * size));
        let help = match unit {
            Some((unit, size)) => format!(
                "it would be plausible if power_w is in {unit} (multiply by {})",
                number(*size)
            ),
            None => "check the unit of power_w (W, of both rotors)".to_owned(),
        };
        found.push(facts.airframe.diagnostic(
            code,
            key,
            format!(
                "at full throttle one unit takes {} W for {} N, {} N/W; pairs of 4 to 40 inch give {} to {} N/W",
                rounded(watts),
                rounded(thrust),
                rounded(thrust / watts),
                number(low),
                number(high)
            ),
            "in another unit?",
            help,
        ));
        return;
    }
    let [upper, lower] = [[full, idle], [idle, full]].map(|at| power.at(at));
    let growth = libm::log(watts / power.at([idle; 2])) / libm::log(full / idle);
    let [least, most] = POWER_GROWTH;
    if (1.0 / POWERS..=POWERS).contains(&(upper / lower)) && (least..=most).contains(&growth) {
        return;
    }
    found.push(facts.airframe.diagnostic(
        code,
        key,
        format!(
            "the power grows with the throttle to the power {}, and is {} W with the upper rotor alone at full throttle, {} W with \
             the lower one",
            rounded(growth),
            rounded(upper),
            rounded(lower)
        ),
        format!(
            "expected a power of {} to {} and rotors within a factor of {}",
            number(least),
            number(most),
            number(POWERS)
        ),
        "one coefficient may be off, or out of order: those of the quartic basis and a constant at the end",
    ));
}
