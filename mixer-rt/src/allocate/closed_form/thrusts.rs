//! The thrusts: f = C+ w + z N.
//!
//! Where z has room and the requested yaw is out of range at the start, z moves towards the z of
//! the largest yaw, by the part `(yaw - Y(start)) / (Y(top) - Y(start))` of the way. This makes the
//! thrusts a Lipschitz function of the request; moving z just far enough would not. Y is nearly
//! concave: where that part is not enough, a second step of twice the length follows.
//!
//! Where yaw does not reach what is needed of it, thrust, roll and pitch are given up: retreat.rs.

use super::{Asked, ClosedForm, ClosedFormUnit, ThrustLine};
use crate::{clamp, divisor, rolled};
use core::hint::black_box;

/// Most steps towards the largest yaw. The second is twice as long as a straight line asks for.
const CLIMBS: u32 = 2;

/// Gain of yaw, in units of `yaw_rounding_nm`, from which z moves to the top in full. For a smaller
/// gain it moves a part of the way, so that z does not jump where the gain vanishes. That costs at
/// most a quarter of this gain, 0.025 % of the authority in yaw.
const GAIN: f32 = 100.0;

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
        let mut z = clamp(0.0, low, if high > low { high } else { low });
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
        if has_room && high > low {
            (z, reach) = self.climb(lines, sign, (z, reach), [low, high], wanted);
        }
        // Up to the reserve yaw comes before thrust.
        let kept = if wanted < reserve { wanted } else { reserve };
        if KEEPS_YAW && kept > furthest(reach, sign) {
            wrench[2] = clamp(middle, range[0], range[1]);
            (z, reach) = self.keep(lines, sign, (z, reach), kept, &wrench);
        }
        // Beyond zero yaw is reversed, beyond the request it is exceeded.
        let needed = if wanted < 0.0 { wanted } else { 0.0 };
        if needed - furthest(reach, sign) > self.yaw_rounding_nm {
            (z, reach) = self.retreat(lines, sign, (z, reach), needed, middle);
        }
        (z, reach)
    }

    /// Moves z from a point where yaw does not reach `wanted` towards where it reaches furthest
    /// within `range`. Returns z and the least and most yaw there, and leaves what each unit gives
    /// of it.
    #[inline(always)]
    fn climb(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (mut z, mut reach): (f32, [f32; 2]),
        range: [f32; 2],
        wanted: f32,
    ) -> (f32, [f32; 2]) {
        let top = self.top(lines, sign, z, range);
        if top == z {
            return (z, reach);
        }
        let at_top = self.reach(lines, top);
        let most = furthest(at_top, sign);
        let whole = GAIN * self.yaw_rounding_nm;
        if most <= wanted && most - furthest(reach, sign) >= whole {
            return (top, at_top);
        }
        let mut ahead = 1.0;
        for _ in 0..black_box(CLIMBS) {
            let here = furthest(reach, sign);
            let gain = most - here;
            let mut part = if gain > 0.0 {
                ahead * (wanted - here) / divisor(gain)
            } else {
                0.0
            };
            part = if part < 1.0 { part } else { 1.0 };
            part *= if gain < whole { gain / whole } else { 1.0 };
            z += part * (top - z);
            reach = self.reach(lines, z);
            let here = furthest(reach, sign);
            if here >= wanted || here >= most {
                break;
            }
            ahead = 2.0;
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
                low = if from > low { from } else { low };
                high = if to < high { to } else { high };
            }
        }
        if high == f32::MAX {
            // There is no null space.
            return [0.0, 0.0];
        }
        [low, high]
    }
}
