//! What one unit of a normalised setpoint is: N m per unit of roll, pitch and yaw, N per unit of
//! thrust.
//!
//! Flight stacks speak [-1, 1] and [0, 1]. Each gives these numbers a meaning of its own by
//! normalising its mixing matrix, in which every rotor is isolated: it gives thrust and torque in
//! proportion to x, its share of the largest thrust. With the thrust c and the torque d of a rotor per
//! unit of x, its column of the effectiveness B is
//!
//! ```text
//! B_upper = c M_f - d M_Q,   B_lower = c M_f + d M_Q,   c = f(max, max) / 2
//! ```
//!
//! so that thrust 1 is all rotors at full throttle. The torque of a pair is not in proportion to x.
//! Where the mass is known, d is its slope at the throttle h of both rotors that carries the weight,
//!
//! ```text
//! d = (Q_l - Q_u) / 2 . du/dx,   du/dx = f(max, max) / (f_u + f_l)      at u = l = h
//! ```
//!
//! which is what a stack that makes the thrust linear (PX4's `THR_MDL_FAC`, ArduPilot's
//! `MOT_THST_EXPO`) gives there; otherwise it is half of the largest torque, (Q(min, max) - Q(max,
//! min)) / 2.
//!
//! PX4 (`ControlAllocationPseudoInverse::updateControlAllocationMatrixScale`) divides the columns of
//! B+ by
//!
//! ```text
//! roll, pitch   the larger of the two sqrt(sum of squares / (non-zero entries / 2))
//! yaw           the largest entry
//! thrust        the mean of the absolute entries
//! ```
//!
//! and one unit of a setpoint asks for the reciprocals. ArduPilot
//! (`AP_MotorsMatrix::normalise_rpy_factors`) multiplies a torque by a factor per motor, which is in
//! proportion to the motor's entry of B and 0.5 where that is largest; one unit asks for the sum of
//! B times factor. Hence a stack's gains keep their meaning on this frame.

use mixer_rt::Wrench;
use nalgebra::DMatrix;

use crate::airframe::{Airframe, Axis, Spin};
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::pseudo_inverse::PseudoInverse;

/// Below this share of a column's largest entry a rotor has no part in an axis: rounding of the
/// decomposition.
const NO_SHARE: f64 = 1e-9;

/// ArduPilot's factor of the motor with the largest part in an axis.
const LARGEST_FACTOR: f64 = 0.5;

/// Half the distance of a pair's rotors along their axis, m. Any will do: there a rotor has no lever.
const LAYER_M: f64 = 0.05;

/// Halvings of the throttle range in the search for hover: to the rounding of f64.
const HALVINGS: usize = 52;

/// Rotors as flight stacks see them, at one voltage.
pub(crate) struct Rotors<'a> {
    pub(crate) airframe: &'a Airframe,
    pub(crate) effectiveness: &'a Effectiveness,
    pub(crate) pair: &'a PairMap,
    /// V; the reference voltage where the airframe has no correction.
    pub(crate) voltage_v: f64,
}

impl Rotors<'_> {
    /// Wrench that one unit of PX4's normalised setpoints asks for; zero on axes that are not served.
    pub(crate) fn px4(&self) -> Wrench {
        let axes = &self.airframe.allocation.axes;
        // The rotors' columns are combinations of those of M, which has full rank.
        let rotors = self.columns();
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
            if self.airframe.allocation.controls(axis) {
                (1.0 / per_unit[axis as usize]) as f32
            } else {
                0.0
            }
        }))
    }

    /// Wrench that one unit of ArduPilot's inputs asks for; zero on axes that are not served.
    pub(crate) fn ardupilot(&self) -> Wrench {
        let columns = self.columns();
        let axes = &self.airframe.allocation.axes;
        Wrench::from_array(Axis::ALL.map(|axis| {
            let Some(row) = axes.iter().position(|served| *served == axis) else {
                return 0.0;
            };
            let entries = columns.row(row);
            (match axis {
                Axis::Thrust => entries.sum(),
                _ => LARGEST_FACTOR * entries.norm_squared() / entries.amax(),
            }) as f32
        }))
    }

    /// ArduPilot's factors of roll, pitch and yaw, by channel; zero on axes that are not served.
    pub(crate) fn ardupilot_factors(&self) -> Vec<[f64; 3]> {
        let columns = self.columns();
        let axes = &self.airframe.allocation.axes;
        let units = &self.airframe.units;
        let channels = units.iter().map(|unit| unit.upper_channel);
        let channels = channels.chain(units.iter().map(|unit| unit.lower_channel));
        let mut rotors: Vec<(usize, usize)> = channels.zip(0..).collect();
        rotors.sort_unstable();
        let factor = |axis: Axis, rotor: usize| {
            let row = axes.iter().position(|served| *served == axis);
            row.map_or(0.0, |row| {
                let entries = columns.row(row);
                LARGEST_FACTOR * entries[rotor] / entries.amax()
            })
        };
        let factors = |(_, rotor)| [Axis::Roll, Axis::Pitch, Axis::Yaw].map(|axis| factor(axis, rotor));
        rotors.into_iter().map(factors).collect()
    }

    /// Place (m), axis, thrust (N) and torque over thrust (m, positive where it turns counter-clockwise)
    /// of the rotor on each channel, each isolated and both of a pair alike.
    pub(crate) fn px4_rotors(&self) -> Vec<[f64; 8]> {
        let [thrust, torque] = self.per_rotor();
        let mut rotors = vec![[0.0; 8]; self.airframe.rotors()];
        for unit in &self.airframe.units {
            let upper = (unit.upper_channel, unit.upper_spin, LAYER_M);
            let lower = (unit.lower_channel, unit.upper_spin.reversed(), -LAYER_M);
            for (channel, spin, layer_m) in [upper, lower] {
                let sign = if spin == Spin::Ccw { 1.0 } else { -1.0 };
                let [ax, ay, az] = unit.axis;
                let [px, py, pz] = std::array::from_fn(|k| unit.position_m[k] + layer_m * unit.axis[k]);
                rotors[channel] = [px, py, pz, ax, ay, az, thrust, sign * torque / thrust];
            }
        }
        rotors
    }

    /// B, a row per served axis, 2n columns: upper rotors, then lower ones.
    fn columns(&self) -> DMatrix<f64> {
        let [thrust, torque] = self.per_rotor();
        let matrix = &self.effectiveness.matrix;
        let n = self.airframe.units.len();
        let axes = &self.airframe.allocation.axes;
        DMatrix::from_fn(axes.len(), 2 * n, |row, rotor| {
            let (axis, i) = (axes[row] as usize, rotor % n);
            let (by_thrust, by_torque) = (thrust * matrix[(axis, i)], torque * matrix[(axis, n + i)]);
            if rotor < n {
                by_thrust - by_torque
            } else {
                by_thrust + by_torque
            }
        })
    }

    /// c and d, N and N m.
    pub(crate) fn per_rotor(&self) -> [f64; 2] {
        let [min, max] = self.pair.range();
        let [k_f, k_q] = self.airframe.voltage_factors(self.voltage_v);
        let full = self.pair.efforts([max, max])[0];
        let torque = match self.hover_throttle() {
            Some(h) => {
                let [[f_u, f_l], [q_u, q_l]] = self.pair.jacobian([h, h]);
                (q_l - q_u) * full / (f_u + f_l)
            }
            None => self.pair.efforts([min, max])[1] - self.pair.efforts([max, min])[1],
        };
        [0.5 * full * k_f, 0.5 * torque * k_q]
    }

    /// Throttle of all rotors that carries the weight; `None` without a mass, or where none does.
    pub(crate) fn hover_throttle(&self) -> Option<f64> {
        let weight_n = self.airframe.weight_n()?;
        let [k_f, k_q] = self.airframe.voltage_factors(self.voltage_v);
        let matrix = &self.effectiveness.matrix;
        let (row, n) = (Axis::Thrust as usize, self.airframe.units.len());
        let sum = |first: usize| {
            (first..first + n)
                .map(|column| matrix[(row, column)])
                .sum::<f64>()
        };
        let (by_thrust, by_torque) = (k_f * sum(0), k_q * sum(n));
        let lift = |throttle: f64| {
            let [f, q] = self.pair.efforts([throttle, throttle]);
            by_thrust * f + by_torque * q
        };
        let [mut low, mut high] = self.pair.range();
        if !(lift(low) < weight_n && weight_n < lift(high)) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if lift(middle) < weight_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }
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
