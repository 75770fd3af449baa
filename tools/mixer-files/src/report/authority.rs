//! Authority: the largest torque about one axis that the mixer delivers in full, at a total thrust
//! and with no other torque asked. Found with the compiled mixer itself, not with a model of it.

use mixer_compiler::airframe::Axis;
use mixer_compiler::hover::Search;
use mixer_compiler::model::scales;
use mixer_rt::Health;

use crate::report::study::{Condition, Study};

/// Authority about each served torque axis at one thrust.
#[derive(Clone, Debug, PartialEq)]
pub struct Authority {
    /// Total thrust, N.
    pub thrust_n: f64,
    /// Least and largest torque about roll, pitch and yaw, N m; NaN where the axis is not served.
    pub torque_nm: [[f64; 2]; 3],
}

/// To a thousandth: every rotor is out in turn.
const COARSE: Search = Search {
    steps: 16,
    halvings: 6,
};

/// Authority at `count` thrusts from the floor to the ceiling of the reference voltage.
pub fn against_thrust(study: &Study<'_>, condition: &Condition, count: usize) -> Vec<Authority> {
    let thrusts = study.thrusts(count);
    thrusts.map(|thrust_n| at(study, condition, thrust_n)).collect()
}

/// Authority at one thrust.
pub fn at(study: &Study<'_>, condition: &Condition, thrust_n: f64) -> Authority {
    Authority {
        thrust_n,
        torque_nm: about_axes(study, |axis, sign| {
            reach(study, condition, Search::FINE, axis, sign, thrust_n)
        }),
    }
}

/// Authority that is left with any one rotor out, at `count` thrusts and the reference voltage.
pub fn with_a_rotor_out(study: &Study<'_>, count: usize) -> Vec<Authority> {
    let rotors = study.compiled.airframe.rotors() as u8;
    let without = |channel| Condition {
        health: Health::GOOD.with_failed(channel),
        ..study.reference()
    };
    let conditions: Vec<Condition> = (0..rotors).map(without).collect();
    let at = |thrust_n| Authority {
        thrust_n,
        torque_nm: about_axes(study, |axis, sign| {
            let reach = |condition| reach(study, condition, COARSE, axis, sign, thrust_n);
            conditions.iter().map(reach).fold(f64::INFINITY, f64::min)
        }),
    };
    study.thrusts(count).map(at).collect()
}

/// `[least, largest]` about each torque axis.
fn about_axes(study: &Study<'_>, reach: impl Fn(Axis, f64) -> f64) -> [[f64; 2]; 3] {
    [Axis::Roll, Axis::Pitch, Axis::Yaw].map(|axis| {
        if study.serves(axis) {
            [-1.0, 1.0].map(|sign| sign * reach(axis, sign))
        } else {
            [f64::NAN; 2]
        }
    })
}

/// The largest delivered torque in one direction, N m; 0 where not even the bare thrust is
/// delivered.
fn reach(
    study: &Study<'_>,
    condition: &Condition,
    search: Search,
    axis: Axis,
    sign: f64,
    thrust_n: f64,
) -> f64 {
    let delivered = |torque: f64| {
        let mut wrench = [0.0, 0.0, 0.0, thrust_n];
        wrench[axis as usize] = sign * torque;
        study.mix(wrench, condition).1
    };
    // No throttles exceed the torque of all units at their largest thrust and torque.
    let scales = scales(&study.compiled.airframe, [1.0; 2]);
    let most = study.compiled.effectiveness.largest(axis as usize, &scales);
    search.largest(most, delivered)
}

#[cfg(test)]
mod tests {
    use super::{COARSE, Search};

    /// A torque that is missed does not hide those beyond it.
    #[test]
    fn the_search_looks_on_after_a_miss() {
        for search in [Search::FINE, COARSE] {
            let found = search.largest(2.0, |torque| torque <= 1.3 && !(0.4..0.6).contains(&torque));
            assert!((1.298..=1.3).contains(&found), "{found}");
            assert_eq!(search.largest(2.0, |_| true), 2.0);
            assert_eq!(search.largest(2.0, |_| false), 0.0);
        }
    }
}
