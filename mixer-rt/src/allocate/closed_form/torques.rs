//! The torques: least norm, clipped to what the thrusts allow. Yaw that is then missing is shared
//! among the units in proportion to their room.
//!
//! All as yaw, p_i = s_i Q_i: the least-norm p_i are alike, yaw / n.

use super::{ClosedForm, Effort, ThrustLine};
use crate::{clamp, quotient, rolled};

impl ClosedForm<'_> {
    /// Writes the efforts: the thrusts at `z` of their lines, and the torques that come nearest
    /// the `yaw` within what the units give there, which is `reach` in all.
    #[inline(always)]
    pub(super) fn torques(
        &self,
        lines: &[ThrustLine],
        efforts: &mut [Effort],
        yaw: f32,
        (z, reach): (f32, [f32; 2]),
    ) {
        let yaw = clamp(yaw, reach[0], reach[1]);
        let share = self.torque_share * yaw;
        let mut given = 0.0;
        for (effort, line) in rolled(efforts.iter_mut().zip(lines)) {
            effort.torque = clamp(share, line.least, line.most);
            given += effort.torque;
        }
        let missing = yaw - given;
        let end = if missing < 0.0 { reach[0] } else { reach[1] };
        // From 0 to 1, as `yaw` is within `reach`, which is the sum of the same limits; 0 where there is no room.
        let part = quotient(missing, end - given);
        for ((unit, effort), line) in rolled(self.units.iter().zip(efforts).zip(lines)) {
            let p = effort.torque;
            let end = if missing < 0.0 { line.least } else { line.most };
            effort.thrust = line.thrust(z);
            effort.torque = unit.spin * (p + part * (end - p));
        }
    }
}
