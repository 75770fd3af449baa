//! Authority: the largest torque about one axis that the mixer delivers in full, at a total thrust and with no other
//! torque asked. Found with the compiled mixer itself, not with a model of it.

use mixer_compiler::airframe::Axis;

use super::study::Study;

/// Authority about each served torque axis at one thrust.
#[derive(Clone, Debug, PartialEq)]
pub struct Authority {
    /// Total thrust, N.
    pub thrust_n: f64,
    /// Least and largest torque about roll, pitch and yaw, N m; NaN where the axis is not served.
    pub torque_nm: [[f64; 2]; 3],
}

/// Halvings of the bracket: a ten-thousandth of the largest torque.
const HALVINGS: usize = 14;

/// Torques tried on the way out, so that the first torque that is not delivered ends the search.
const STEPS: usize = 12;

/// Authority at `count` thrusts from the floor to the ceiling.
pub fn against_thrust(study: &Study<'_>, count: usize) -> Vec<Authority> {
    let [low, high] = study.compiled.thrust_range_n.map(f64::from);
    (0..count)
        .map(|k| low + (high - low) * k as f64 / (count - 1) as f64)
        .map(|thrust_n| at(study, thrust_n))
        .collect()
}

/// Authority at one thrust.
pub fn at(study: &Study<'_>, thrust_n: f64) -> Authority {
    let torque_nm = [Axis::Roll, Axis::Pitch, Axis::Yaw].map(|axis| {
        if study.serves(axis) {
            [-1.0, 1.0].map(|sign| sign * reach(study, axis, sign, thrust_n))
        } else {
            [f64::NAN; 2]
        }
    });
    Authority { thrust_n, torque_nm }
}

/// The largest delivered torque in one direction, N m; 0 where not even the bare thrust is delivered.
fn reach(study: &Study<'_>, axis: Axis, sign: f64, thrust_n: f64) -> f64 {
    let delivered = |torque: f64| {
        let mut wrench = [0.0, 0.0, 0.0, thrust_n];
        wrench[axis as usize] = sign * torque;
        study.mix(wrench).1
    };
    let largest = largest_torque(study, axis);
    let tried = (0..=STEPS).map(|k| largest * k as f64 / STEPS as f64);
    let Some(first_missed) = tried.clone().find(|&torque| !delivered(torque)) else {
        return largest;
    };
    let step = largest / STEPS as f64;
    let (mut good, mut bad) = ((first_missed - step).max(0.0), first_missed);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + bad);
        if delivered(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}

/// A torque that no throttles exceed: all units at their largest thrust and torque.
fn largest_torque(study: &Study<'_>, axis: Axis) -> f64 {
    let [f, q] = study.pair.scale();
    let row = study.compiled.effectiveness.matrix.row(axis as usize);
    let n = row.len() / 2;
    (0..n).map(|i| row[i].abs() * f + row[n + i].abs() * q).sum()
}
