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
//!
//! Betaflight (`mixTable`) adds to each motor's output its factors of `mmix` times the PID sums over 1000, as shares of the
//! range from idle to the largest throttle (`motor_output_limit`), and makes no thrust linear. Its tables (`mixerOctoX8`, `mixerY6`) have factors in
//! proportion to the entries of B, whose largest less least is 2; a PID sum of 1000 asks for the sum of B times factor,
//! times the slope of thrust over output in hover. Its throttle stick has no unit of thrust: here it has the curve
//!
//! ```text
//! thrust / largest thrust = (1 - e) throttle + e throttle^2               e from 0 to 1, as ArduPilot's
//!                           (2 - e) throttle^2 + (e - 1) throttle^3       e from 1 to 2
//! ```
//!
//! with the e for which the stick in hover is that of Betaflight's own mixer. It rises all the way. The largest thrust is that at the
//! highest voltage, so heavy vehicles have an e above 1.

use mixer_rt::Wrench;
use nalgebra::DMatrix;

use crate::airframe::{Airframe, Axis, Spin};
use crate::model::effectiveness::Effectiveness;
use crate::model::pseudo_inverse::PseudoInverse;
use crate::model::{PairMap, equal_throttle};

/// Below this share of a column's largest entry a rotor has no part in an axis: rounding of the
/// decomposition.
const NO_SHARE: f64 = 1e-9;

/// ArduPilot's factor of the motor with the largest part in an axis.
const LARGEST_FACTOR: f64 = 0.5;

/// Largest less least of Betaflight's factors of an axis.
const BETAFLIGHT_RANGE: f64 = 2.0;

/// Half the distance of a pair's rotors along their axis, m. Any will do: there a rotor has no lever.
const LAYER_M: f64 = 0.05;

/// Rotors as flight stacks see them, at one voltage.
pub(crate) struct Rotors<'a> {
    pub(crate) airframe: &'a Airframe,
    pub(crate) effectiveness: &'a Effectiveness,
    /// The map of each unit.
    pub(crate) maps: &'a [PairMap],
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
        let (columns, alike) = (self.columns(), self.columns_alike());
        let axes = &self.airframe.allocation.axes;
        Wrench::from_array(Axis::ALL.map(|axis| {
            let Some(row) = axes.iter().position(|served| *served == axis) else {
                return 0.0;
            };
            let (entries, alike) = (columns.row(row), alike.row(row));
            (match axis {
                Axis::Thrust => entries.sum(),
                _ => LARGEST_FACTOR * entries.dot(&alike) / alike.amax(),
            }) as f32
        }))
    }

    /// ArduPilot's factors of roll, pitch and yaw, by channel; zero on axes that are not served.
    pub(crate) fn ardupilot_factors(&self) -> Vec<[f64; 3]> {
        let columns = self.columns_alike();
        let axes = &self.airframe.allocation.axes;
        let units = &self.airframe.units;
        let channels = units.iter().map(|unit| Some(unit.upper_channel));
        let channels = channels.chain(units.iter().map(|unit| unit.lower_channel));
        let rotors = channels
            .zip(0..)
            .filter_map(|(channel, rotor)| Some((channel?, rotor)));
        let mut rotors: Vec<(usize, usize)> = rotors.collect();
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

    /// Torques that PID sums of 1000 ask Betaflight for; zero on axes that are not served.
    pub(crate) fn betaflight(&self) -> Wrench {
        let alike = self.columns_alike();
        let axes = &self.airframe.allocation.axes;
        let [min, max] = self.range();
        // Over Betaflight's output, from idle to the largest throttle; 1 without a hover.
        let slope = self.slope_in_hover().map_or(1.0, |slope| (max - min) * slope);
        let share = |unit: usize| match (self.slope_of(unit), self.slope_in_hover()) {
            (Some(own), Some(slope)) => own / slope,
            _ => 1.0,
        };
        let columns = self.columns_of(|unit| self.per_rotor(unit).map(|effort| effort * share(unit)));
        Wrench::from_array(Axis::ALL.map(|axis| {
            let row = axes.iter().position(|served| *served == axis);
            row.filter(|_| axis != Axis::Thrust).map_or(0.0, |row| {
                let (entries, alike) = (columns.row(row), alike.row(row));
                let range = alike.max() - alike.min();
                (slope * BETAFLIGHT_RANGE * entries.dot(&alike) / range) as f32
            })
        }))
    }

    /// e of the throttle stick's curve, from 0 to 2; 1 without a hover. The full stick has `full_n`.
    pub(crate) fn betaflight_expo(&self, full_n: f64) -> f64 {
        let [min, max] = self.range();
        let hover = self.hover_throttle().zip(self.airframe.weight_n());
        let expo = hover.map_or(1.0, |(h, weight_n)| {
            let (stick, share) = ((h - min) / (max - min), weight_n / full_n);
            // By the square of the stick alone the share would be this.
            let square = stick * stick;
            if share > square {
                (stick - share) / (stick - square)
            } else {
                1.0 + (square - share) / (square - square * stick)
            }
        });
        expo.clamp(0.0, 2.0)
    }

    /// Betaflight's factors of roll, pitch and yaw, by channel, in its signs; zero on axes that are not served.
    pub(crate) fn betaflight_factors(&self) -> Vec<[f64; 3]> {
        // Its pitch is positive nose down.
        let mut factors = self.ardupilot_factors();
        for axis in 0..3 {
            let of = || factors.iter().map(|factors| factors[axis]);
            let range = of().fold(0.0, f64::max) - of().fold(0.0, f64::min);
            let scale = if range > 0.0 {
                BETAFLIGHT_RANGE / range
            } else {
                0.0
            };
            let sign = if axis == Axis::Pitch as usize {
                -scale
            } else {
                scale
            };
            factors.iter_mut().for_each(|factors| factors[axis] *= sign);
        }
        factors
    }

    /// Place (m), axis, thrust (N) and torque over thrust (m, positive where it turns counter-clockwise)
    /// of the rotor on each channel, each isolated and both of a pair alike.
    pub(crate) fn px4_rotors(&self) -> Vec<[f64; 8]> {
        let mut rotors = vec![[0.0; 8]; self.airframe.rotors()];
        for (index, unit) in self.airframe.units.iter().enumerate() {
            let [thrust, torque] = self.per_rotor(index);
            let lower = unit.lower_channel;
            let layer_m = if lower.is_some() { LAYER_M } else { 0.0 };
            let upper = (unit.upper_channel, unit.upper_spin, layer_m);
            let lower = lower.map(|lower| (lower, unit.upper_spin.reversed(), -layer_m));
            for (channel, spin, layer_m) in std::iter::once(upper).chain(lower) {
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
        self.columns_of(|unit| self.per_rotor(unit))
    }

    /// B of rotors alike, by their mean, for stacks whose factors follow from the geometry alone.
    fn columns_alike(&self) -> DMatrix<f64> {
        let units = if self.airframe.is_unlike() {
            self.maps.len()
        } else {
            1
        };
        let each: Vec<(f64, [f64; 2])> = (0..units)
            .map(|unit| (self.rotors_of(unit), self.per_rotor(unit)))
            .collect();
        let rotors: f64 = each.iter().map(|(rotors, _)| rotors).sum();
        let mean = [0, 1].map(|k| each.iter().map(|(rotors, of)| rotors * of[k]).sum::<f64>() / rotors);
        self.columns_of(|_| mean)
    }

    /// B of rotors of this thrust and torque by unit.
    fn columns_of(&self, efforts: impl Fn(usize) -> [f64; 2]) -> DMatrix<f64> {
        let matrix = &self.effectiveness.matrix;
        let n = self.airframe.units.len();
        let axes = &self.airframe.allocation.axes;
        DMatrix::from_fn(axes.len(), 2 * n, |row, rotor| {
            let (axis, i) = (axes[row] as usize, rotor % n);
            let [thrust, torque] = efforts(i);
            let (by_thrust, by_torque) = (thrust * matrix[(axis, i)], torque * matrix[(axis, n + i)]);
            // The torque of a single rotor counts positive, that of an upper one negative.
            match (rotor < n, self.airframe.units[i].lower_channel) {
                (true, Some(_)) => by_thrust - by_torque,
                (false, None) => 0.0,
                _ => by_thrust + by_torque,
            }
        })
    }

    fn range(&self) -> [f64; 2] {
        [self.airframe.throttle.min, self.airframe.throttle.max]
    }

    /// How many rotors a unit has.
    fn rotors_of(&self, unit: usize) -> f64 {
        self.airframe.units[unit].channels().count() as f64
    }

    /// c and d of a unit's rotors, N and N m.
    pub(crate) fn per_rotor(&self, unit: usize) -> [f64; 2] {
        let (map, [min, max]) = (&self.maps[unit], self.range());
        let [k_f, k_q] = self.airframe.voltage_factors(self.voltage_v);
        let [full, torque] = map.efforts([max, max]);
        let is_single = self.airframe.units[unit].lower_channel.is_none();
        let torque = match self.hover_throttle() {
            Some(h) => {
                let [[f_u, f_l], [q_u, q_l]] = map.jacobian([h, h]);
                let slope = if is_single { q_u } else { q_l - q_u };
                slope * full / (f_u + f_l)
            }
            None if is_single => torque,
            None => map.efforts([min, max])[1] - map.efforts([max, min])[1],
        };
        let rotors = self.rotors_of(unit);
        [full * k_f / rotors, torque * k_q / rotors]
    }

    /// Slope in hover of the share of the largest thrust over the throttle, both rotors alike: what a stack's loop gain is
    /// multiplied by that takes the one for the other. `None` without a hover.
    pub(crate) fn slope_in_hover(&self) -> Option<f64> {
        if !self.airframe.is_unlike() {
            return self.slope_of(0);
        }
        let full = |unit: usize| self.rotors_of(unit) * self.per_rotor(unit)[0];
        let units = 0..self.maps.len();
        let slopes = units.clone().map(|unit| Some(full(unit) * self.slope_of(unit)?));
        Some(slopes.sum::<Option<f64>>()? / units.map(full).sum::<f64>())
    }

    /// [`Rotors::slope_in_hover`] of a unit alone.
    fn slope_of(&self, unit: usize) -> Option<f64> {
        let (map, h, [_, max]) = (&self.maps[unit], self.hover_throttle()?, self.range());
        let [[f_u, f_l], _] = map.jacobian([h, h]);
        Some((f_u + f_l) / map.efforts([max, max])[0])
    }

    /// Throttle of all rotors that carries the weight; `None` without a mass, or where none from idle on does.
    pub(crate) fn hover_throttle(&self) -> Option<f64> {
        let [k_f, _] = self.airframe.voltage_factors(self.voltage_v);
        let hover = equal_throttle(self.airframe, self.maps, self.airframe.weight_n()? / k_f);
        hover.filter(|hover| *hover > self.airframe.throttle.min)
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

    /// Motors as Betaflight's mixer moves them, and the wrench of the map: its slope in hover, its thrust on the stick.
    #[test]
    fn betaflights_units_are_what_its_factors_give_in_hover() {
        let path = format!("{}/airframes/isae-x8.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap() + "\n[vehicle]\nmass_kg = 3.2\n";
        let compiled = compile(&Source::new("x8", text)).unwrap();
        let factors = compiled.betaflight_factors();
        let [min, max] = compiled.maps[0].range();
        let wrench = |outputs: &dyn Fn(usize) -> f64| -> [f64; 4] {
            let efforts = compiled.airframe.units.iter().map(|unit| {
                let outputs: Vec<f64> = unit.channels().map(outputs).collect();
                compiled.maps[0].efforts([outputs[0], outputs[1]])
            });
            let efforts: Vec<[f64; 2]> = efforts.collect();
            let (matrix, n) = (&compiled.effectiveness.matrix, efforts.len());
            std::array::from_fn(|axis| {
                let of = |(i, [f, q]): (usize, &[f64; 2])| matrix[(axis, i)] * f + matrix[(axis, n + i)] * q;
                efforts.iter().enumerate().map(of).sum()
            })
        };
        let hover = compiled.equal_hover_throttle().unwrap();
        let scale = compiled.betaflight_scale().to_array();
        // Betaflight's pitch is positive nose down.
        for (axis, sign) in [(0, 1.0), (1, -1.0), (2, 1.0)] {
            let small = 1e-4;
            let moved = |sum: f64| wrench(&|motor| hover + (max - min) * sum * factors[motor][axis])[axis];
            let slope = sign * (moved(small) - moved(-small)) / (2.0 * small);
            assert_near(scale[axis], slope);
            let range = factors
                .iter()
                .map(|factors| factors[axis].abs())
                .fold(0.0, f64::max);
            assert!((range - 1.0).abs() < 1e-9, "{factors:?}");
        }
        let [_, _, _, full_n] = wrench(&|_| max);
        let highest = compiled.airframe.voltage_factors(compiled.highest_v())[0];
        assert_near(scale[3], highest * full_n);
    }

    #[test]
    fn hover_is_at_the_stick_of_betaflights_own_mixer() {
        for name in ["isae-x8", "x8-11in-cubic", "x8-16in-quartic", "px4-y6"] {
            let path = format!("{}/airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).unwrap();
            let bare = compile(&Source::new("x8", text.clone())).unwrap();
            let full_kg = f64::from(bare.thrust_range_n[1]) / 9.80665;
            for over_weight in [1.4, 2.0, 3.0, 4.0, 6.0] {
                let text = format!("{text}\n[vehicle]\nmass_kg = {}\n", full_kg / over_weight);
                let compiled = compile(&Source::new("x8", text)).unwrap();
                let [min, max] = compiled.maps[0].range();
                let stick = (compiled.equal_hover_throttle().unwrap() - min) / (max - min);
                let e = compiled.betaflight_expo();
                let square = stick * stick;
                let share = if e <= 1.0 {
                    (1.0 - e) * stick + e * square
                } else {
                    ((2.0 - e) + (e - 1.0) * stick) * square
                };
                let thrust_n = share * f64::from(compiled.betaflight_scale().thrust_n);
                let carried = thrust_n / compiled.airframe.weight_n().unwrap();
                assert!(
                    (carried - 1.0).abs() < 1e-6,
                    "{name} {over_weight}: e {e}, {carried}"
                );
            }
        }
    }

    #[test]
    fn axes_that_are_not_served_have_none() {
        let scale = file("single-pair");
        assert_eq!([scale.roll_nm, scale.pitch_nm], [0.0, 0.0]);
        assert!(scale.yaw_nm > 0.0 && scale.thrust_n > 0.0, "{scale:?}");
    }
}
