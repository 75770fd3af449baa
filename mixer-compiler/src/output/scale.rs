//! What one unit of a normalised setpoint is: N m per unit of roll, pitch and yaw, N per unit of
//! thrust.
//!
//! Flight stacks speak [-1, 1] and [0, 1]. PX4 gives these numbers their meaning by normalising its
//! mixing matrix (`ControlAllocationPseudoInverse::updateControlAllocationMatrixScale`). A rotor is
//! taken as isolated there; with the largest thrust c and the largest torque d of each rotor, its
//! columns of the effectiveness B are
//!
//! ```text
//! B_upper = c M_f - d M_Q,   B_lower = c M_f + d M_Q,   c = f(max, max) / 2,   d = (Q(min, max) - Q(max, min)) / 2
//! ```
//!
//! so that thrust 1 is all rotors at full throttle. The columns of B+ are divided by
//!
//! ```text
//! roll, pitch   the larger of the two sqrt(sum of squares / (non-zero entries / 2))
//! yaw           the largest entry
//! thrust        the mean of the absolute entries
//! ```
//!
//! Hence one unit of a setpoint asks for the reciprocals, and a stack's gains keep their meaning on
//! this frame.

use mixer_rt::Wrench;
use nalgebra::DMatrix;

use crate::airframe::{Airframe, Axis};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::pseudo_inverse::PseudoInverse;

/// Below this share of a column's largest entry a rotor has no part in an axis: rounding of the
/// decomposition.
const NO_SHARE: f64 = 1e-9;

/// Wrench that one unit of a normalised setpoint asks for at the reference voltage; zero on axes
/// that are not served.
pub(crate) fn scale(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> Wrench {
    let axes = &airframe.allocation.axes;
    // The rotors' columns are combinations of those of M, which has full rank.
    let rotors = rotor_columns(airframe, effectiveness, pair);
    let Ok(mixing) = PseudoInverse::new(&rotors, &vec![1.0; rotors.ncols()]) else {
        return Wrench::default();
    };
    // The entries of a column that are not zero, by magnitude.
    let shares = |axis: Axis| -> Vec<f64> {
        let Some(column) = axes.iter().position(|served| *served == axis) else {
            return Vec::new();
        };
        let column = mixing.matrix.column(column);
        let least = NO_SHARE * column.amax();
        column
            .iter()
            .map(|share| share.abs())
            .filter(|share| *share > least)
            .collect()
    };
    let torque = |axis| {
        let shares = shares(axis);
        let squares: f64 = shares.iter().map(|share| share * share).sum();
        (squares / (0.5 * shares.len().max(1) as f64)).sqrt()
    };
    let roll_pitch = torque(Axis::Roll).max(torque(Axis::Pitch));
    let yaw = shares(Axis::Yaw).into_iter().fold(0.0, f64::max);
    let thrust = shares(Axis::Thrust).iter().sum::<f64>() / shares(Axis::Thrust).len().max(1) as f64;
    let per_unit = [roll_pitch, roll_pitch, yaw, thrust];
    Wrench::from_array(Axis::ALL.map(|axis| {
        if airframe.allocation.controls(axis) {
            (1.0 / per_unit[axis as usize]) as f32
        } else {
            0.0
        }
    }))
}

/// B, a row per served axis, 2n columns: upper rotors, then lower ones.
fn rotor_columns(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> DMatrix<f64> {
    let [min, max] = pair.range();
    let most_thrust = 0.5 * pair.efforts([max, max])[0];
    let most_torque = 0.5 * (pair.efforts([min, max])[1] - pair.efforts([max, min])[1]);
    let n = airframe.units.len();
    let axes = &airframe.allocation.axes;
    DMatrix::from_fn(axes.len(), 2 * n, |row, rotor| {
        let (axis, i) = (axes[row] as usize, rotor % n);
        let by_thrust = most_thrust * effectiveness.matrix[(axis, i)];
        let by_torque = most_torque * effectiveness.matrix[(axis, n + i)];
        if rotor < n {
            by_thrust - by_torque
        } else {
            by_thrust + by_torque
        }
    })
}

#[cfg(test)]
mod tests {
    use crate::{Source, compile};

    use super::*;

    fn file(name: &str) -> Wrench {
        let path = format!("{}/airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        compile(&Source::new(name, text)).unwrap().scale()
    }

    #[track_caller]
    fn assert_near(value: f32, expected: f64) {
        assert!(
            (f64::from(value) / expected - 1.0).abs() < 1e-6,
            "{value}, not {expected}"
        );
    }

    /// By hand, from PX4's formulas: with eight rotors at (+-a, +-a), every entry of B+ is 1/(8 c
    /// a), 1/(8 d), 1/(8 c).
    #[test]
    fn an_x8_has_the_scales_of_px4() {
        let scale = file("isae-x8");
        let (full, arm) = (24.787_7, 0.318_2);
        let rotor = 0.5 * full;
        assert!(
            (scale.thrust_n / (8.0 * rotor as f32) - 1.0).abs() < 1e-3,
            "{scale:?}"
        );
        assert_near(scale.roll_nm, f64::from(scale.thrust_n) * arm / 2.0_f64.sqrt());
        assert_eq!(scale.roll_nm, scale.pitch_nm);
        // Q(0.1, 1) - Q(1, 0.1) of the four units.
        let [upper, lower] = [[1.0, 0.1], [0.1, 1.0]].map(|[u, l]: [f64; 2]| {
            let terms = [u * u * l * l, u * u * l, u * u, u * l * l, u * l, u, l * l, l];
            let torque = [-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720];
            terms.iter().zip(torque).map(|(term, c)| term * c).sum::<f64>()
        });
        assert_near(scale.yaw_nm, 4.0 * (lower - upper));
    }

    #[test]
    fn axes_that_are_not_served_have_none() {
        let scale = file("single-pair");
        assert_eq!([scale.roll_nm, scale.pitch_nm], [0.0, 0.0]);
        assert!(scale.yaw_nm > 0.0 && scale.thrust_n > 0.0, "{scale:?}");
    }
}
