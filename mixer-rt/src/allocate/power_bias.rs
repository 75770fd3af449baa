//! Least power: where the efforts of least norm are attainable, the torques start from Q = c f
//! instead of 0.
//!
//! c is the airframe's `power_bias_nm_per_n`. M+ takes off the part of the torques c f that
//! would change the wrench, so the efforts move along
//!
//! ```text
//! shift = eta - M+ M eta     with eta = [0 .. 0, c f_1 .. c f_n]
//! ```
//!
//! which leaves the wrench on all served axes as it is, whatever the axes of thrust. With vertical
//! ones it is Q_i = c f_i - s_i sum (s_j c f_j) / n, and no thrust moves. c holds at the reference
//! voltage.
//!
//! They move by b shift, b at most 1 and so small that no throttle comes to its bound. Room and change
//! are those of the throttles' squares, over which efforts are nearly linear:
//!
//! ```text
//! b = min over rotors of ROOM room / |change|        change = 2 t (J^-1 shift)
//! ```
//!
//! Room is that to the nearer bound, whichever way the rotor moves. So b reaches 0 where the first rotor
//! comes to a bound: desaturation begins there, and nothing jumps. In closed form the room is that of a unit's torque between the sides of its attainable set, which are
//! throttles at their bounds.
//!
//! With c = 0 the mixer leaves this out, and so does the compiler, as the tables are constants.

use core::hint::black_box;

use super::closed_form::{AllocationMethod, ClosedForm, Efforts};
use super::frame::Frame;
use super::unit::UnitState;
use crate::layout::Tables;
use crate::pair::{Kinds, solve};
use crate::{divided, divisor, rolled, smaller};

/// Share of the room that is used: the efforts are not quite linear over squares.
const ROOM: f32 = 0.8;

impl ClosedForm<'_> {
    /// Moves least-norm `efforts` towards Q = `c` f. `room` is the least distance of a unit's
    /// torque from its sides, N m, not negative.
    #[inline(always)]
    pub(crate) fn add_power_bias(&self, c: f32, room: f32, efforts: &mut Efforts) {
        let mut yaw = 0.0;
        for (unit, effort) in self.units.iter().zip(efforts.iter()) {
            yaw += unit.spin * effort.thrust;
        }
        let mean = self.torque_share * yaw;
        let mut largest = 0.0;
        for (unit, effort) in self.units.iter().zip(efforts.iter()) {
            let shift = (c * (effort.thrust - unit.spin * mean)).abs();
            if shift > largest {
                largest = shift;
            }
        }
        let b = if room < largest {
            room / divisor(largest)
        } else {
            1.0
        };
        let along = b * c;
        for (unit, effort) in self.units.iter().zip(efforts) {
            effort.torque += along * (effort.thrust - unit.spin * mean);
        }
    }
}

/// [`ClosedForm::add_power_bias`] for any frame with all rotors, whose units are at the throttles of least
/// norm for `wrench`. `factors` is `[k_f, k_Q]`.
#[inline(never)]
pub(crate) fn add_power_bias<K: Kinds, S: AllocationMethod>(
    tables: &Tables<'_, K, S>,
    wrench: &[f32; 4],
    factors: [f32; 2],
    units: &mut [UnitState],
) {
    // No columns are used here, so the kind of axes makes no difference.
    Frame::<_, _, true>::new(black_box(tables), factors).add_power_bias(wrench, units);
}

impl<K: Kinds, S: AllocationMethod, const VERTICAL: bool> Frame<'_, '_, K, S, VERTICAL> {
    fn add_power_bias(&self, wrench: &[f32; 4], units: &mut [UnitState]) {
        let (tables, c) = (self.tables, self.tables.power_bias_nm_per_n);
        // What Q = c f would add to the wrench.
        let mut added = [0.0; 4];
        for (unit, table) in rolled(units.iter_mut().zip(tables.units)) {
            unit.efforts = self.least_norm(table, wrench);
            table.add_wrench([0.0, c * unit.efforts[0]], self.factors, &mut added);
        }
        let [least, most] = [tables.throttle.min, tables.throttle.max].map(|end| end * end);
        let mut b = 1.0;
        for (index, (unit, table)) in rolled(units.iter_mut().zip(tables.units).enumerate()) {
            let [f, q] = self.least_norm(table, &added);
            let shift = [-f, c * unit.efforts[0] - q];
            unit.slopes[0] = shift;
            let Some(of) = tables.pair_of(index) else {
                continue;
            };
            let (_, jacobian) = of.pair.efforts_and_jacobian(unit.throttles);
            for (throttle, step) in unit.throttles.iter().zip(solve(jacobian, shift)) {
                let square = throttle * throttle;
                let change = (2.0 * throttle * step).abs();
                let room = ROOM * smaller(most - square, square - least);
                if b * change > room {
                    b = divided(room, divisor(change));
                }
            }
        }
        for (index, unit) in rolled(units.iter_mut().enumerate()) {
            let [f, q] = unit.slopes[0];
            unit.efforts = [unit.efforts[0] + b * f, unit.efforts[1] + b * q];
            self.invert(index, unit);
        }
    }
}
