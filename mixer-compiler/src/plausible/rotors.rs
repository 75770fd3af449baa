//! Rules on the two rotors of a pair against each other, and each alone.

use super::rule::{KindFacts, Rule};
use crate::airframe::{Pair, Spin};
use crate::diagnostic::{Code, rounded};
use crate::model::wake::{self, Wake};

/// Idle over full throttle above which the mean torque is not looked at: the paper's own pair is
/// beyond the limit there. Real maps that begin at 0.42 of full throttle are well within.
const WHOLE_MAP: f64 = 0.45;

/// Largest ratios of thrust and of torque of the two rotors, each at full throttle with the other at
/// idle: 0.74 to 1.26 and 0.9 to 1.5 on real maps, the former in the paper too.
const RATIOS: [f64; 2] = [2.0, 2.2];

/// Limits of what a rotor gives alone over what the pair gives with the other rotor at idle, both
/// at full throttle: 0.79 to 1.23 for the thrust of real runs.
const ALONE: [f64; 2] = [0.5, 2.0];

/// Keys and units of thrust and torque.
const EFFORTS: [(&str, &str); 2] = [("thrust", "N"), ("torque", "N m")];
const KEYS: [&str; 2] = ["thrust_n", "torque_nm"];

/// Which rotor is the upper one, and which way it turned.
///
/// Torque falls with the upper throttle and rises with the lower one. Where both are exchanged, det
/// J is negative and the file is refused; the corner of the fold tells nothing: real maps fold at
/// (full, idle), the paper's at (idle, full). The rotor in the wake takes less torque:
/// [`wake`]. The lower rotor of a bench whose upper one turned counter-clockwise
/// turns clockwise: it yaws to the left, but the torque counts it positive.
pub(super) fn order(facts: &KindFacts<'_>, pair: &Pair) -> Vec<Rule> {
    let rule =
        |key: &str, is_plausible| Rule::holds(Code::RotorsExchanged, format!("pair.{key}"), is_plausible);
    let [by_upper, by_lower] = [facts.upper, facts.lower].map(|at| at[1] - facts.idle[1]);
    let (upper, lower) = (rounded(by_upper), rounded(by_lower));
    let is_refused = facts.is_refused;
    let [low, high] = facts.map.range();
    let mean = wake::mean_torque(|at| facts.map.efforts(at)[1], [low, high]);
    let is_above = low <= WHOLE_MAP * high && Wake::of_torque(mean) == Wake::Above;
    vec![
        rule("torque_nm", is_refused || (by_upper < 0.0 && by_lower > 0.0)).says(
            format!("from idle to full the upper throttle changes the torque by {upper} N m, the lower one by {lower} N m"),
            "expected a fall by the upper rotor, a rise by the lower one",
            "check which rotor is the upper one (identify --swap exchanges them) and the sign of the torque",
        ),
        rule("upper_spin", pair.upper_spin == Spin::Cw).says(
            format!(
                "at full throttle the lower rotor adds {lower} N m clockwise, but it turns clockwise itself where the upper \
                 one turned \"ccw\": yaw would go to the wrong side"
            ),
            "expected \"cw\"",
            "write upper_spin = \"cw\" under [pair], whichever way the bench turned; those of the units are the real ones",
        ),
        rule("torque_nm", is_refused || !is_above || pair.lower_is_stronger)
            .says(
                format!(
                    "the lower rotor takes more torque than the upper one at equal throttles: the mean torque over the box is \
                     {:+.1} % of the largest",
                    100.0 * mean
                ),
                "expected less of the rotor in the wake, where both are alike",
                "either the rotors are exchanged: run identify again with --swap; or the lower one is the stronger (more pitch, KV or \
                 diameter): write stronger = \"lower\" under [pair]",
            )
            .unless_explained(&[Code::RotorsExchanged]),
    ]
}

/// Two rotors of one pair give about the same, and each alone about what it gives in the pair. A
/// coefficient ten times off shows here.
pub(super) fn sizes(facts: &KindFacts<'_>, pair: &Pair) -> Vec<Rule> {
    let mut rules = Vec::new();
    for (k, (what, unit)) in EFFORTS.into_iter().enumerate() {
        let (upper, lower, most) = (facts.upper[k], facts.lower[k], RATIOS[k]);
        let ratio = (upper / lower).abs();
        rules.push(
            Rule::within(Code::LopsidedPair, format!("pair.{}", KEYS[k]), ratio, [1.0 / most, most])
                .says(
                    format!(
                        "the upper rotor alone at full throttle gives a {what} of {} {unit}, the lower one {} {unit}, the \
                         other at idle",
                        rounded(upper),
                        rounded(lower)
                    ),
                    format!("expected within a factor of {most}"),
                    "one coefficient may be off by a factor of ten, or out of the order that the basis fixes",
                )
                .unless_explained(&[Code::PairUnits, Code::RotorsExchanged, Code::NotCoaxial]),
        );
    }
    let [_, full] = facts.map.range();
    let tables = [
        ("lower_out", &pair.lower_out, facts.upper),
        ("upper_out", &pair.upper_out, facts.lower),
    ];
    for (table, alone, of_pair) in tables {
        let Some(alone) = alone else { continue };
        let own = alone.efforts(full);
        rules.extend(EFFORTS.into_iter().enumerate().map(|(k, (_, unit))| {
            Rule::within(Code::RotorAloneScale, format!("pair.{table}.{}", KEYS[k]), own[k] / of_pair[k], ALONE).says(
                format!(
                    "at full throttle the rotor alone gives {} {unit}, the pair with the other rotor at idle {} {unit}",
                    rounded(own[k]),
                    rounded(of_pair[k])
                ),
                format!("expected {} to {} times that", ALONE[0], ALONE[1]),
                "check the unit and that the run is of this pair's rotor; both curves hold at the reference voltage",
            )
        }));
    }
    rules
}
