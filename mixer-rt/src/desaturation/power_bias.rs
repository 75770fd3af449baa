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
//! They move by b shift. b is the room of the unit nearest its border over the largest shift of any
//! unit, at most 1. So no unit leaves the attainable set, whatever the direction of its own shift,
//! and b reaches 0 with the room: where the first unit reaches its border, desaturation begins, and
//! nothing jumps there.
//!
//! With c = 0 the mixer leaves this out, and so does the compiler, as the tables are constants.

use super::closed_form::{ClosedForm, Efforts};
use super::general::Variable;
use crate::layout::Tables;
use crate::{divisor, rolled};

/// Torques cannot cross a polygon's edge of constant thrust. So that the bias fades before such an
/// edge as well, thrusts count as moved by this share of the largest shift of a torque (in scaled
/// efforts).
const FADE: f32 = 0.125;

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

/// [`ClosedForm::add_power_bias`] for any frame with all rotors: the units are at their least-norm
/// efforts, within their polygons. `factors` is `[k_f, k_Q]`. Rates of the units are the shift,
/// `[f, Q]` at the reference voltage.
#[inline(never)]
pub(crate) fn add_power_bias<P, I, S>(
    tables: &Tables<'_, P, I, S>,
    factors: [f32; 2],
    units: &mut [Variable],
) {
    let c = tables.power_bias_nm_per_n;
    let set = &tables.attainable;
    let per_scale = set.scale.map(|scale| 1.0 / scale);
    let per_factor = factors.map(|factor| 1.0 / factor);
    // What Q = c f would add to the wrench.
    let mut wrench = [0.0; 4];
    for (unit, table) in units.iter().zip(tables.units) {
        rolled();
        table.add_wrench([0.0, c * unit.at[0]], factors, &mut wrench);
    }
    let mut largest = [0.0f32; 2];
    for (unit, table) in units.iter_mut().zip(tables.units) {
        rolled();
        let [f, q] = table.efforts(&wrench);
        unit.rate = [-(f * per_factor[0]), c * unit.at[0] - q * per_factor[1]];
        for ((largest, part), per_scale) in largest.iter_mut().zip(unit.rate).zip(per_scale) {
            let part = (part * per_scale).abs();
            if part > *largest {
                *largest = part;
            }
        }
    }
    let [by_thrust, by_torque] = [largest[0] + FADE * largest[1], largest[1]];
    let mut b = 1.0;
    for corner in set.polygon() {
        rolled();
        let [edge, _] = corner.ways;
        let out = edge[1].abs() * by_thrust + edge[0].abs() * by_torque;
        for unit in units.iter() {
            rolled();
            let room = -corner.beyond([unit.at[0] * per_scale[0], unit.at[1] * per_scale[1]]);
            if b * out > room {
                b = if room > 0.0 { room / divisor(out) } else { 0.0 };
            }
        }
    }
    for unit in units {
        rolled();
        unit.at = [0, 1].map(|k| unit.at[k] + b * unit.rate[k]);
    }
}
