//! Rules on the two rotors of a pair against each other, and each alone.

use super::facts::Facts;
use crate::airframe::{RotorAlone, Spin};
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::model::wake::{self, Wake};

/// Torque that the upper and that the lower rotor add from idle to full throttle, the other at idle,
/// N m.
fn torque_added(facts: &Facts<'_>) -> [f64; 2] {
    let [low, high] = facts.map.range();
    let torque = |u, l| facts.map.efforts([u, l])[1];
    [torque(high, low), torque(low, high)].map(|at| at - torque(low, low))
}

/// Torque falls with the upper throttle and rises with the lower one. Where both are exchanged, det
/// J is negative and the file is refused. The corner of the fold tells nothing: real maps fold at
/// (full, idle), the paper's at (idle, full).
pub(super) fn slopes(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let [by_upper, by_lower] = torque_added(facts);
    let is_refused = facts.effectiveness.is_none();
    if is_refused || (by_upper < 0.0 && by_lower > 0.0) {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::RotorsExchanged,
        "pair.torque_nm",
        format!(
            "from idle to full the upper throttle changes the torque by {} N m, the lower one by {} N m",
            rounded(by_upper),
            rounded(by_lower)
        ),
        "expected a fall by the upper rotor, a rise by the lower one",
        "check which rotor is the upper one (identify --swap exchanges them) and the sign of the torque",
    ));
}

/// The lower rotor of a bench whose upper one turned counter-clockwise turns clockwise: it yaws to the
/// left, but the torque counts it positive.
pub(super) fn bench_spin(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    if facts.airframe.pair.upper_spin == Spin::Cw {
        return;
    }
    let [_, by_lower] = torque_added(facts);
    found.push(facts.airframe.diagnostic(
        Code::RotorsExchanged,
        "pair.upper_spin",
        format!(
            "at full throttle the lower rotor adds {} N m clockwise, but it turns clockwise itself where the upper one turned \"ccw\": yaw \
             would go to the wrong side",
            rounded(by_lower)
        ),
        "expected \"cw\"",
        "write upper_spin = \"cw\" under [pair], whichever way the bench turned; those of the units are the real ones",
    ));
}

/// Idle over full throttle above which the mean torque is not looked at: the paper's own pair is
/// beyond the limit there. Real maps that begin at 0.42 of full throttle are well within.
const WHOLE_MAP: f64 = 0.45;

/// The rotor in the wake takes less torque: [`wake`](crate::model::wake). Wrong slopes are told
/// already.
pub(super) fn wake(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let [low, high] = facts.map.range();
    let is_told = found.iter().any(|warning| warning.code == Code::RotorsExchanged);
    if facts.effectiveness.is_none() || is_told || low > WHOLE_MAP * high {
        return;
    }
    let mean = wake::mean_torque(|at| facts.map.efforts(at)[1], [low, high]);
    if Wake::told_by(mean) != Wake::Above {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::RotorsExchanged,
        "pair.torque_nm",
        format!(
            "the lower rotor takes more torque than the upper one at equal throttles: the mean torque over the box is {:+.1} % of the \
             largest",
            100.0 * mean
        ),
        "expected less of the rotor in the wake",
        "the rotors look exchanged: run identify again with --swap, or exchange u and l in both polynomials and negate torque_nm",
    ));
}

/// Largest ratio of the thrusts of the two rotors, each at full throttle with the other at idle:
/// 0.74 to 1.26 on real maps and in the paper.
const THRUSTS: f64 = 2.0;

/// Largest ratio of their torques: 0.9 to 1.5 on real maps.
const TORQUES: f64 = 2.2;

/// Two rotors of one pair give about the same. A coefficient ten times off shows here.
pub(super) fn lopsided(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    // Units and order are told first: they may be why.
    if !found.is_empty() {
        return;
    }
    let [low, high] = facts.map.range();
    let [upper, lower] = [[high, low], [low, high]].map(|at| facts.map.efforts(at));
    for (k, (key, what, unit, most)) in [
        ("pair.thrust_n", "thrust", "N", THRUSTS),
        ("pair.torque_nm", "torque", "N m", TORQUES),
    ]
    .into_iter()
    .enumerate()
    {
        let ratio = (upper[k] / lower[k]).abs();
        if (1.0 / most..=most).contains(&ratio) {
            continue;
        }
        found.push(facts.airframe.diagnostic(
            Code::LopsidedPair,
            key,
            format!(
                "the upper rotor alone at full throttle gives a {what} of {} {unit}, the lower one {} {unit}, the other at idle",
                rounded(upper[k]),
                rounded(lower[k])
            ),
            format!("expected within a factor of {}", number(most)),
            "one coefficient may be off by a factor of ten, or out of the order that the basis fixes",
        ));
    }
}

/// Limits of what a rotor gives alone over what the pair gives with the other rotor at idle, both
/// at full throttle: 0.79 to 1.23 for the thrust of real runs.
const ALONE: [f64; 2] = [0.5, 2.0];

/// `[pair.lower_out]` and `[pair.upper_out]` are of the same rotors as the pair.
pub(super) fn alone(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let pair = &facts.airframe.pair;
    let [low, high] = facts.map.range();
    one_alone(facts, "lower_out", pair.lower_out.as_ref(), [high, low], found);
    one_alone(facts, "upper_out", pair.upper_out.as_ref(), [low, high], found);
}

fn one_alone(
    facts: &Facts<'_>,
    table: &str,
    alone: Option<&RotorAlone>,
    at: [f64; 2],
    found: &mut Vec<Diagnostic>,
) {
    let Some(alone) = alone else { return };
    let [_, full] = facts.map.range();
    let (own, of_pair) = (alone.efforts(full), facts.map.efforts(at));
    let keys = [("thrust_n", "N"), ("torque_nm", "N m")];
    for (k, (key, unit)) in keys.into_iter().enumerate() {
        let ratio = own[k] / of_pair[k];
        if (ALONE[0]..=ALONE[1]).contains(&ratio) {
            continue;
        }
        found.push(facts.airframe.diagnostic(
            Code::RotorAloneScale,
            &format!("pair.{table}.{key}"),
            format!(
                "at full throttle the rotor alone gives {} {unit}, the pair with the other rotor at idle {} {unit}",
                rounded(own[k]),
                rounded(of_pair[k])
            ),
            format!("expected {} to {} times that", ALONE[0], ALONE[1]),
            "check the unit and that the run is of this pair's rotor; both curves hold at the reference voltage",
        ));
    }
}
