//! Rules on the torque of least power.

use super::facts::Facts;
use crate::diagnostic::{Code, Diagnostic, number, rounded};

const KEY: &str = "allocation.power_bias_nm_per_n";

/// Share of a frame's saving below which there is none: upper rotors that all turn alike leave
/// nothing to cancel torques with.
const NO_SHARE: f64 = 1e-6;

/// A bias that the pair cannot give at half of its largest thrust, about where vehicles hover.
pub(super) fn beyond(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let bias = facts.airframe.allocation.power_bias_nm_per_n;
    let thrust = 0.5 * facts.scale[0];
    let torque = bias * thrust;
    let [least, most] = torques(facts, thrust);
    if bias == 0.0 || (least..=most).contains(&torque) {
        return;
    }
    let end = if torque < least { least } else { most };
    found.push(facts.airframe.diagnostic(
        Code::PowerBiasBeyond,
        KEY,
        format!(
            "a power bias of {} N m per N is {} N m at {} N, half of a unit's largest thrust, where the pair gives at most {} N m",
            number(bias),
            rounded(torque),
            rounded(thrust),
            rounded(end)
        ),
        "never wholly available",
        format!("the limit there is {} N m per N; `cargo mixer identify` finds what saves power", rounded(end / thrust)),
    ));
}

/// A bias on a frame whose upper rotors all turn alike.
pub(super) fn idle(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let bias = airframe.allocation.power_bias_nm_per_n;
    let share = airframe.power_bias_share();
    if bias == 0.0 || share > NO_SHARE {
        return;
    }
    let units = airframe.units.len();
    let what = if units == 1 {
        "the only unit has none to cancel its torque".to_owned()
    } else {
        format!("the upper rotors of all {units} units turn alike, so that none cancels another's torque")
    };
    found.push(airframe.diagnostic(
        Code::PowerBiasIdle,
        KEY,
        format!("a power bias of {} N m per N saves nothing: {what}", number(bias)),
        "no effect in hover",
        "remove it, or let half of the upper rotors turn the other way",
    ));
}

/// Least and most torque of a unit at a thrust, N m, by the border of its attainable set.
fn torques(facts: &Facts<'_>, thrust: f64) -> [f64; 2] {
    let border = facts.map.border(128);
    let efforts: Vec<[f64; 2]> = border.into_iter().map(|at| facts.map.efforts(at)).collect();
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for (k, [f0, q0]) in efforts.iter().enumerate() {
        let [f1, q1] = efforts[(k + 1) % efforts.len()];
        if (f0 - thrust) * (f1 - thrust) <= 0.0 && f1 != *f0 {
            let q = q0 + (q1 - q0) * (thrust - f0) / (f1 - f0);
            range = [range[0].min(q), range[1].max(q)];
        }
    }
    range
}
