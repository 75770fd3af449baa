//! With one rotor out: the yaw that may be asked.
//!
//! A rotor that is left alone turns the vehicle one way, so that level flight has more yaw in one sense than in the
//! other. What the vehicle speeds up with the stronger sense the weaker one has to brake: where a request may be no
//! larger than what level flight has in either sense, it can. The compiler finds that yaw over the thrust, for each rotor
//! ([`Unit::level_yaw_nm`](crate::layout::Unit)). With several rotors out nothing is limited.
//!
//! Beyond the thrust with the most of it, there may be none: there the yaw reserve, for which thrust is lowered, may be
//! as large as the most at lower thrusts.

use super::frame::Frame;
use super::priorities::REQUEST_LIMIT;
use super::unit::UnitState;
use crate::layout::LEVEL_YAWS;
use crate::{clamp, divided, divisor, larger, smaller};

/// Intervals between the thrusts of the table.
const CELLS: usize = LEVEL_YAWS - 1;

impl<P, I, S, const VERTICAL: bool> Frame<'_, '_, P, I, S, VERTICAL> {
    /// The wrench with its yaw limited to what can be braked, N m.
    #[inline(never)]
    pub(super) fn braked(&self, wrench: &[f32; 4], units: &[UnitState]) -> [f32; 4] {
        let [roll, pitch, yaw, thrust] = *wrench;
        let tables = self.tables;
        let share = divided(thrust * self.per_factor[0], divisor(tables.level_n[1]));
        let at = clamp(share * CELLS as f32, 0.0, CELLS as f32);
        let cell = (at as usize).min(CELLS - 1);
        let reserve = tables.priorities.yaw_reserve_nm * self.per_factor[1];
        let (mut limit, mut out) = (REQUEST_LIMIT, 0);
        for (unit, table) in units.iter().zip(tables.units) {
            for (side, yaws) in table.level_yaw_nm.iter().enumerate() {
                if unit.rotors.turns(side) {
                    continue;
                }
                let mut most = 0.0;
                for yaw in &yaws[..cell + 1] {
                    most = larger(*yaw, most);
                }
                let here = yaws[cell] + (at - cell as f32) * (yaws[cell + 1] - yaws[cell]);
                limit = larger(here, smaller(reserve, most));
                out += 1;
            }
        }
        if out > 1 {
            return *wrench;
        }
        let limit = limit * self.factors[1];
        [roll, pitch, clamp(yaw, -limit, limit), thrust]
    }
}
