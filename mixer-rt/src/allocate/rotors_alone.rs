//! Least norm where rotors turn alone: the throttles nearest those of the whole frame that give the wrench. A rotor is
//! alone where its partner is out, and where it is a single rotor.
//!
//! ```text
//! least   sum_pairs (df^2 / D_f + dQ^2 / D_Q)  +  sum_alone (t - t*)^2
//! with    sum_pairs B (y* + dy)  +  sum_alone B y(t)  =  w
//! ```
//!
//! y* are the efforts of least norm of the whole frame (M+ w), t* the throttle that a rotor alone has
//! there, D_f and D_Q the mean of f_u^2 + f_l^2 and of Q_u^2 + Q_l^2 over the throttles
//! (`PairKind::mean_square_slopes`): so both sums count squares of throttles. A pair with both rotors answers
//! multipliers lambda of the rows by dy = D B^T lambda, a rotor alone along its tangent by t - t* =
//! y'^T B^T lambda: one system of four rows per tangent. The inverse map turns the efforts into
//! throttles. Whether all units then give them is checked, so no convexity is needed.

use super::closed_form::AllocationMethod;
use super::frame::Frame;
use super::interior::is_met;
use super::system::{Factors, Products};
use super::unit::UnitState;
use crate::pair::alone::LEAST_RISE;
use crate::pair::{Kinds, PairKind};
use crate::{divided, larger, rolled, sqrt};

/// Tangents along the curves of rotors alone, on whole frames and with rotors out. With rotors out two serve 3 % fewer
/// requests of an X8, and 15 % fewer where torque over thrust bends most; four serve no more. Single rotors of a whole
/// frame begin at their share of least norm, from where two are enough.
const TANGENTS: [u32; 2] = [2, 3];

/// Multipliers beyond this are of rows that the frame does not serve.
const UNSERVED: f32 = 100.0;

impl<K: Kinds, S: AllocationMethod, const VERTICAL: bool> Frame<'_, '_, K, S, VERTICAL> {
    /// Writes throttles that are nearest those of the whole frame; true where they give the wrench.
    #[inline(never)]
    pub(super) fn serve_with_rotors_alone(
        &self,
        wrench: &[f32; 4],
        units: &mut [UnitState],
        is_whole: bool,
    ) -> bool {
        let (mut matrix, mut lost) = ([0.0; 10], [0.0; 4]);
        for (index, (unit, table)) in rolled(units.iter_mut().zip(self.tables.units).enumerate()) {
            unit.efforts = self.least_norm(table, wrench);
            unit.columns = self.columns(table);
            if let Some(pair) = self.pair_of(index, unit) {
                let [by_thrust, by_torque] = pair.mean_square_slopes;
                Products::<VERTICAL>::add(&unit.columns, [by_thrust, 0.0, by_torque], &mut matrix);
                continue;
            }
            Products::<VERTICAL>::subtract(&unit.columns, unit.efforts.map(|effort| -effort), &mut lost);
            self.invert_apart(index, unit);
            unit.targets = unit.throttles;
            unit.stop_failed();
        }
        let mut lambda = [0.0; 4];
        for _ in rolled(0..TANGENTS[usize::from(!is_whole)]) {
            let (mut system, mut missed) = (matrix, lost);
            for (index, unit) in rolled(units.iter_mut().enumerate()) {
                let Some(side) = unit.rotors.single() else {
                    continue;
                };
                let throttle = unit.throttles[side];
                let [value, slope, half] = self.tables.alone(index, side).expansion(throttle);
                let back = unit.targets[side] - throttle;
                unit.slopes[side] = slope;
                unit.curvature_per_slope = divided(4.0 * half[0], larger(slope[0], LEAST_RISE));
                // The efforts of the tangent at the target.
                unit.efforts = [value[0] + slope[0] * back, value[1] + slope[1] * back];
                let [f, q] = slope;
                Products::<VERTICAL>::subtract(&unit.columns, unit.efforts, &mut missed);
                Products::<VERTICAL>::add(&unit.columns, [f * f, f * q, q * q], &mut system);
            }
            lambda = Factors::of(&system).solve(missed);
            if !is_met(&lambda, UNSERVED) {
                break;
            }
            for unit in rolled(units.iter_mut()) {
                let Some(side) = unit.rotors.single() else {
                    continue;
                };
                let (gain, [f, q]) = (
                    Products::<VERTICAL>::gains(&unit.columns, &lambda),
                    unit.slopes[side],
                );
                let moved = f * gain[0] + q * gain[1];
                unit.efforts = [unit.efforts[0] + f * moved, unit.efforts[1] + q * moved];
                // The throttle of that thrust: exact for a parabola.
                let step = moved + unit.targets[side] - unit.throttles[side];
                let rooted = 0.5 + 0.5 * sqrt(larger(1.0 + unit.curvature_per_slope * step, 0.0));
                unit.throttles[side] = self
                    .tables
                    .throttle
                    .clamp(unit.throttles[side] + divided(step, rooted));
            }
        }
        let is_regular = is_met(&lambda, UNSERVED);
        let mut is_served = is_regular;
        for (index, unit) in rolled(units.iter_mut().enumerate()) {
            if let Some(pair) = self.pair_of(index, unit) {
                if is_regular {
                    let [by_thrust, by_torque] = pair.mean_square_slopes;
                    let gain = Products::<VERTICAL>::gains(&unit.columns, &lambda);
                    unit.efforts[0] += by_thrust * gain[0];
                    unit.efforts[1] += by_torque * gain[1];
                }
                is_served &= self.invert_apart(index, unit);
            } else if let Some(side) = unit.rotors.single() {
                let [given, ..] = self.tables.alone(index, side).expansion(unit.throttles[side]);
                is_served &= self.gives(given, unit);
            } else {
                unit.efforts = [0.0; 2];
            }
        }
        is_served
    }

    /// The pair of a unit both of whose rotors turn.
    #[inline(always)]
    fn pair_of(&self, index: usize, unit: &UnitState) -> Option<&PairKind<K::Quantity, K::Inverse>> {
        self.tables.pair_of(index).filter(|_| unit.rotors.are_both())
    }

    /// [`Frame::invert`], once in the code for both places.
    #[inline(never)]
    fn invert_apart(&self, index: usize, unit: &mut UnitState) -> bool {
        self.invert(index, unit)
    }
}
