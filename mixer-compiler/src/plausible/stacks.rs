//! Rules on what a flight stack makes of an airframe.

use super::facts::Facts;
use super::pair::{self, ARDUPILOT_MOST_SPIN_MIN};
use crate::airframe::{Airmode, Axis};
use crate::diagnostic::{Code, Diagnostic, number, rounded};

/// Points on every edge of the throttle box on which the largest yaw is looked for. It is at a corner
/// for pairs as benches give them.
const POINTS: usize = 32;

/// An idle that ArduPilot does not take for its `MOT_SPIN_MIN`, where nothing else is wrong with it.
pub(super) fn spin_min(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let idle = facts.airframe.throttle.min;
    if idle <= ARDUPILOT_MOST_SPIN_MIN || pair::idle_share(facts) > pair::IDLE_SHARE {
        return;
    }
    let most = number(ARDUPILOT_MOST_SPIN_MIN);
    found.push(facts.airframe.diagnostic(
        Code::SpinMin,
        "throttle.min",
        format!(
            "an idle of {}: ArduPilot does not arm with a MOT_SPIN_MIN above {most}",
            number(idle)
        ),
        "above ArduPilot's limit",
        format!(
            "where the map inverts from {most} on, set throttle.min = {most}: `cargo mixer check` states the least idle; with \
             ArduPilot the motors otherwise idle at {most} on the ground and step up at take-off"
        ),
    ));
}

/// Yaw that comes before thrust: with as much yaw as there is, the thrust is what that yaw leaves.
pub(super) fn yaw_before_thrust(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let airframe = facts.airframe;
    let Some(effectiveness) = facts.effectiveness else {
        return;
    };
    if airframe.allocation.airmode != Airmode::RollPitchYaw || !airframe.allocation.controls(Axis::Yaw) {
        return;
    }
    let units = airframe.units.len();
    let row = |axis: Axis, unit: usize, [f, q]: [f64; 2]| {
        let row = effectiveness.matrix.row(axis as usize);
        row[unit] * f + row[units + unit] * q
    };
    let efforts: Vec<[f64; 2]> = facts
        .map
        .border(POINTS)
        .into_iter()
        .map(|at| facts.map.efforts(at))
        .collect();
    // Yaw and thrust where every unit yaws as far as it can to one side.
    let furthest = |sign: f64| -> [f64; 2] {
        let mut sum = [0.0, 0.0];
        for unit in 0..units {
            let by_yaw = |a: &&[f64; 2], b: &&[f64; 2]| {
                let [a, b] = [a, b].map(|efforts| sign * row(Axis::Yaw, unit, **efforts));
                a.total_cmp(&b)
            };
            if let Some(efforts) = efforts.iter().max_by(by_yaw) {
                sum[0] += row(Axis::Yaw, unit, *efforts).abs();
                sum[1] += row(Axis::Thrust, unit, *efforts);
            }
        }
        sum
    };
    let [right, left] = [1.0, -1.0].map(furthest);
    let [yaw_nm, thrust_n] = if right[1] >= left[1] { right } else { left };
    let over_weight = match airframe.weight_n() {
        Some(weight) => format!(", {:.2} times the weight", thrust_n / weight),
        None => String::new(),
    };
    found.push(airframe.diagnostic(
        Code::YawBeforeThrust,
        "allocation.airmode",
        format!(
            "the largest yaw, {} N m, makes the thrust {} N{over_weight}, whatever thrust is asked for",
            rounded(yaw_nm),
            rounded(thrust_n)
        ),
        "yaw comes before thrust",
        format!(
            "vehicles climb or sink while they yaw; \"roll-pitch\" keeps the thrust, and yaw_reserve_nm = {} with it a tenth of \
             the yaw at full thrust",
            rounded(0.1 * yaw_nm)
        ),
    ));
}
