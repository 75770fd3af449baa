//! Rules on what the mixer is asked to keep: yaw, and the torque of least power.

use super::rule::{Facts, KindFacts, Rule};
use crate::airframe::{Airmode, Axis, Pair};
use crate::diagnostic::{Code, number, rounded};
use crate::model::effectiveness::Effectiveness;

/// Share of a frame's saving below which there is none: upper rotors that all turn alike leave
/// nothing to cancel torques with.
const NO_SHARE: f64 = 1e-6;

/// Where every unit gives its greatest yaw to one side: that yaw, N m, and the thrust, N.
fn furthest(facts: &Facts<'_>, effectiveness: &Effectiveness, sign: f64) -> [f64; 2] {
    let units = facts.airframe.units.len();
    let give = |unit: usize, [f, q]: &[f64; 2]| {
        let on = |axis: Axis| {
            let row = effectiveness.matrix.row(axis as usize);
            row[unit] * f + row[units + unit] * q
        };
        [sign * on(Axis::Yaw), on(Axis::Thrust)]
    };
    (0..units).fold([0.0; 2], |[yaw, thrust], unit| {
        let border = &facts.kinds[facts.airframe.units[unit].kind].border;
        let given = border.iter().map(|efforts| give(unit, efforts));
        let [y, t] = given.max_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default();
        [yaw + y, thrust + t]
    })
}

/// A reserve of yaw that no throttles give, whatever the thrust; and yaw that comes before thrust:
/// with as much yaw as there is, the thrust is what that yaw leaves.
pub(super) fn yaw(facts: &Facts<'_>) -> Vec<Rule> {
    let Some(effectiveness) = facts.effectiveness else {
        return Vec::new();
    };
    let allocation = &facts.airframe.allocation;
    let [right, left] = [1.0, -1.0].map(|sign| furthest(facts, effectiveness, sign));
    let authority = right[0].min(left[0]).max(0.0);
    let [yaw_nm, thrust_n] = if right[1] >= left[1] { right } else { left };
    let over_weight = match facts.airframe.weight_n() {
        Some(weight) => format!(", {:.2} times the weight", thrust_n / weight),
        None => String::new(),
    };
    let reserve = allocation.yaw_reserve_nm;
    let is_first = allocation.airmode == Airmode::RollPitchYaw && facts.controls(Axis::Yaw);
    vec![
        Rule::holds(
            Code::YawReserveBeyond,
            "allocation.yaw_reserve_nm",
            reserve == 0.0 || reserve <= authority,
        )
        .says(
            format!(
                "a yaw reserve of {} N m is beyond the authority of {} N m, at whatever thrust",
                number(reserve),
                rounded(authority)
            ),
            "never available",
            format!(
                "all of yaw then comes before thrust; a tenth of the authority is {} N m",
                rounded(0.1 * authority)
            ),
        ),
        Rule::holds(Code::YawBeforeThrust, "allocation.airmode", !is_first).says(
            format!(
                "the largest yaw, {} N m, makes the thrust {} N{over_weight}, whatever thrust is asked for",
                rounded(yaw_nm),
                rounded(thrust_n)
            ),
            "yaw comes before thrust",
            format!(
                "vehicles climb or sink while they yaw; \"roll-pitch\" keeps the thrust, and yaw_reserve_nm = {} with it a \
                 tenth of the yaw at full thrust",
                rounded(0.1 * yaw_nm)
            ),
        ),
    ]
}

const POWER_BIAS: &str = "allocation.power_bias_nm_per_n";

/// A bias that the pair cannot give at half of its largest thrust, about where vehicles hover.
pub(super) fn power_bias(facts: &KindFacts<'_>, _: &Pair) -> Vec<Rule> {
    let bias = facts.view.allocation.power_bias_nm_per_n;
    if bias == 0.0 {
        return Vec::new();
    }
    let thrust = 0.5 * facts.scale[0];
    let torque = bias * thrust;
    let [least, most] = torques(facts, thrust);
    let end = if torque < least { least } else { most };
    let [torque_nm, thrust_n, end_nm, limit] = [torque, thrust, end, end / thrust].map(rounded);
    let rule = Rule::within(Code::PowerBiasBeyond, POWER_BIAS, torque, [least, most]);
    vec![rule.says(
        format!(
            "a power bias of {} N m per N is {torque_nm} N m at {thrust_n} N, half of a unit's largest thrust, where \
             the pair gives at most {end_nm} N m",
            number(bias)
        ),
        "never wholly available",
        format!("the limit there is {limit} N m per N; `cargo mixer identify` finds what saves power"),
    )]
}

/// A bias on a frame whose upper rotors all turn alike.
pub(super) fn idle_power_bias(facts: &Facts<'_>) -> Vec<Rule> {
    let airframe = facts.airframe;
    let bias = airframe.allocation.power_bias_nm_per_n;
    if bias == 0.0 {
        return Vec::new();
    }
    let bias = number(bias);
    let why = match airframe.units.len() {
        1 => "the only unit has none to cancel its torque".to_owned(),
        units => {
            format!("the upper rotors of all {units} units turn alike, so that none cancels another's torque")
        }
    };
    vec![
        Rule::holds(
            Code::PowerBiasIdle,
            POWER_BIAS,
            airframe.power_bias_share() > NO_SHARE,
        )
        .says(
            format!("a power bias of {bias} N m per N saves nothing: {why}"),
            "no effect in hover",
            "remove it, or let half of the upper rotors turn the other way",
        ),
    ]
}

/// Least and most torque of a unit at a thrust, N m, by the border of its attainable set.
fn torques(facts: &KindFacts<'_>, thrust: f64) -> [f64; 2] {
    let next = facts.border.iter().cycle().skip(1);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for ([f0, q0], [f1, q1]) in facts.border.iter().zip(next) {
        if (f0 - thrust) * (f1 - thrust) <= 0.0 && f1 != f0 {
            let q = q0 + (q1 - q0) * (thrust - f0) / (f1 - f0);
            range = [range[0].min(q), range[1].max(q)];
        }
    }
    range
}
