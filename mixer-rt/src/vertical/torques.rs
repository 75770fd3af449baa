//! The torques: the least-norm ones, clipped to what the thrusts allow, and what that leaves of the yaw in proportion
//! to room.
//!
//! All in the direction of yaw, p_i = s_i Q_i: the least-norm p_i are alike, yaw / n.

use super::reach::reach;
use super::{Effort, Search, Vertical, rolled};
use crate::clamp;

impl Vertical<'_> {
    /// Writes the efforts with the torques that come nearest the yaw `wanted` >= 0 in its direction, of which `reached`
    /// is within the limits. Where even the least yaw is beyond it, the thrusts are drawn towards those of `middle_n`.
    #[inline(always)]
    pub(super) fn torques<'a>(
        &'a self,
        search: &mut [Search<'a>],
        efforts: &mut [Effort],
        reversed: bool,
        wanted: f32,
        mut reached: f32,
        middle_n: f32,
    ) {
        let share = self.torque_share * wanted;
        let mut given = 0.0;
        let mut raised = false;
        for ((unit, effort), state) in self.units.iter().zip(efforts.iter_mut()).zip(search.iter()) {
            rolled();
            let mut p = if share < state.limit { share } else { state.limit };
            if let Some(least) = self.border.least_above(unit.spin, reversed, state.thrust, p) {
                p = least;
                raised = true;
            }
            effort.torque = p;
            given += p;
        }
        let lowered = raised && given > wanted;
        if lowered {
            for state in search.iter_mut() {
                rolled();
                (state.from, state.along) = (state.thrust, 0.0);
            }
            self.look(search, !reversed);
            reached = -reach(search, 0.0).yaw;
            if reached > wanted {
                reached = -self.retreat(search, -reached, -wanted, middle_n);
            }
        }
        let room = reached - given;
        let part = if room == 0.0 {
            0.0
        } else {
            clamp((wanted - given) / room, 0.0, 1.0)
        };
        for ((unit, effort), state) in self.units.iter().zip(efforts).zip(search.iter()) {
            rolled();
            let p = effort.torque;
            let limit = if lowered { -state.limit } else { state.limit };
            let p = p + part * (limit - p);
            effort.thrust = state.thrust;
            effort.torque = if (unit.spin < 0.0) != reversed { -p } else { p };
        }
    }
}
