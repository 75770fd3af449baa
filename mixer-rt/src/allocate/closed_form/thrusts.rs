//! The thrusts: f = C+ w + z N.
//!
//! Where z has room and the requested yaw is out of range at the start, z moves: extend_yaw.rs. Where yaw then
//! does not reach what is needed of it, thrust, roll and pitch are given up: keep_yaw.rs.

use super::{Asked, ClosedForm, ClosedFormUnit, ThrustLine};
use crate::{clamp, larger, rolled, smaller};

impl ClosedFormUnit {
    /// The least-norm thrust, N, for `[roll, pitch, thrust]`.
    #[inline(always)]
    pub(super) fn thrust(&self, wrench: &[f32; 3]) -> f32 {
        let [roll, pitch, thrust] = self.allocation;
        (roll * wrench[0] + pitch * wrench[1]) + thrust * wrench[2]
    }
}

/// How far yaw of the sign `sign` reaches.
#[inline(always)]
pub(super) fn furthest([least, most]: [f32; 2], sign: f32) -> f32 {
    if sign < 0.0 { -least } else { most }
}

impl ClosedForm<'_> {
    /// Finds attainable thrusts, at most `ceiling` in sum, that bring the requested yaw into range
    /// if any do. Where yaw would be short of `reserve`, reversed or exceeded, they are drawn towards
    /// those of the total thrust `middle`. Returns their z on the lines of thrusts and the
    /// least and most yaw there; writes the lines with each unit's yaw.
    #[inline(always)]
    pub(super) fn attainable_thrusts<const KEEPS_YAW: bool>(
        &self,
        request: &Asked,
        reserve: f32,
        [ceiling, middle]: [f32; 2],
        lines: &mut [ThrustLine],
    ) -> (f32, [f32; 2]) {
        let (share, range) = self.share(request.roll, request.pitch, request.thrust, ceiling);
        let thrust = clamp(request.thrust, range[0], range[1]);
        let mut wrench = [share * request.roll, share * request.pitch, thrust];
        let [low, high] = self.null_range(lines, &wrench);
        // Where the facets change roll, pitch or thrust, z has no room.
        let has_room = share == 1.0 && thrust == request.thrust;
        let mut z = clamp(0.0, low, larger(high, low));
        let mut reach = self.reach(lines, z);
        // The limit of yaw that the request violates, if any.
        let sign = if request.yaw > reach[1] {
            1.0
        } else if request.yaw < reach[0] {
            -1.0
        } else {
            return (z, reach);
        };
        let wanted = sign * request.yaw;
        if has_room {
            (z, reach) = self.extend_yaw(lines, sign, (z, reach), [low, high], wanted);
        }
        // Up to the reserve yaw comes before thrust.
        let kept = smaller(wanted, reserve);
        if KEEPS_YAW && kept > furthest(reach, sign) {
            wrench[2] = clamp(middle, range[0], range[1]);
            (z, reach) = self.keep_reserve(lines, sign, (z, reach), kept, &wrench);
        }
        // Beyond zero yaw is reversed, beyond the request it is exceeded.
        let needed = smaller(wanted, 0.0);
        if needed - furthest(reach, sign) > self.yaw_rounding_nm {
            (z, reach) = self.bound_yaw(lines, sign, (z, reach), needed, middle);
        }
        (z, reach)
    }

    /// Least and most yaw at `z` of the lines of thrusts; writes those of each unit there.
    #[inline(never)]
    pub(super) fn reach(&self, lines: &mut [ThrustLine], z: f32) -> [f32; 2] {
        let mut reach = [0.0, 0.0];
        for (unit, line) in self.units.iter().zip(lines) {
            let [middle, half] = self.border.torques(line.thrust(z));
            let middle = unit.spin * middle;
            (line.least, line.most) = (middle - half, middle + half);
            reach = [reach[0] + line.least, reach[1] + line.most];
        }
        reach
    }

    /// Lines from the least-norm thrusts of `[roll, pitch, thrust]` through the null space. Returns
    /// the range of z; its first end is the larger one where rounding leaves no range.
    #[inline(always)]
    pub(super) fn null_range(&self, lines: &mut [ThrustLine], wrench: &[f32; 3]) -> [f32; 2] {
        let (mut low, mut high) = (-f32::MAX, f32::MAX);
        for (unit, line) in rolled(self.units.iter().zip(lines)) {
            let f = unit.thrust(wrench);
            (line.from, line.along) = (f, unit.null);
            if unit.per_null != 0.0 {
                let [from, to] = unit.ends.map(|end| (end - f) * unit.per_null);
                (low, high) = (larger(from, low), smaller(to, high));
            }
        }
        if high == f32::MAX {
            // There is no null space.
            return [0.0, 0.0];
        }
        [low, high]
    }
}
