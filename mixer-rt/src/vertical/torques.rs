//! The torques: the least-norm ones, clipped to what the thrusts allow, and what that leaves of the yaw in proportion
//! to room.
//!
//! All in the direction of yaw, p_i = s_i Q_i: the least-norm p_i are alike, yaw / n.

use super::reach::reach;
use super::{Effort, Search, TorqueLimit, Vertical};
use crate::clamp;
use crate::rolled;

impl<S: TorqueLimit> Vertical<'_, S> {
    /// Writes the efforts: the thrusts found, and the torques that come nearest the yaw `wanted` >= 0 in its direction,
    /// of which `reached` is within the limits at `z` of the units' way. Where even the least yaw is beyond it, the thrusts
    /// are drawn towards those of `middle_n`.
    #[inline(always)]
    pub(super) fn torques<'a>(
        &'a self,
        search: &mut [Search<'a, S>],
        efforts: &mut [Effort],
        wanted: f32,
        (mut reached, mut z): (f32, f32),
        middle_n: f32,
    ) {
        if reached <= wanted {
            for (effort, state) in efforts.iter_mut().zip(search.iter()) {
                rolled();
                effort.thrust = state.thrust(z);
                effort.torque = state.turn * state.limit;
            }
            return;
        }
        let share = self.torque_share * wanted;
        let chord = self.border.chord;
        let mut given = 0.0;
        let mut upwards = 1.0;
        for (effort, state) in efforts.iter_mut().zip(search.iter()) {
            rolled();
            let mut p = if share < state.limit { share } else { state.limit };
            if let Some(least) = self.border.least_above(chord, state.turn, state.thrust(z), p) {
                p = least;
            }
            effort.torque = p;
            given += p;
        }
        if given - wanted > self.yaw_rounding_nm {
            upwards = -1.0;
            for state in search.iter_mut() {
                rolled();
                state.turn = -state.turn;
                state.side = self.border.side(state.turn);
            }
            reached = -reach(search, z);
            if reached - wanted > self.yaw_rounding_nm {
                (reached, z) = self.retreat(search, z, -reached, -wanted, middle_n);
                reached = -reached;
            }
        }
        let room = reached - given;
        // Zero where there is no room.
        let part = clamp((wanted - given) / room, 0.0, 1.0);
        for (effort, state) in efforts.iter_mut().zip(search.iter()) {
            rolled();
            let p = effort.torque;
            effort.thrust = state.thrust(z);
            effort.torque = upwards * state.turn * (p + part * (upwards * state.limit - p));
        }
    }
}
