//! The thrusts: f = C+ w + z N.
//!
//! Where z has room and yaw does not reach the request, z is moved to where Y, the furthest yaw, is largest. Y is
//! concave, so the part `(yaw - Y(0)) / (Y(z) - Y(0))` of the way is enough, and the thrusts are a Lipschitz function of
//! the request, which they would not be if z were moved just far enough. Where Y is not concave see vertical/polyline.rs.

use super::polyline::climb;
use super::reach::{reach, reach_from_inside, top};
use super::{Request, Search, TorqueLimit, Vertical, VerticalUnit};
use crate::clamp;
use crate::rolled;

impl VerticalUnit {
    /// The least-norm thrust, N, for `[roll, pitch, thrust]`.
    #[inline(always)]
    pub(super) fn thrust(&self, wrench: &[f32; 3]) -> f32 {
        let [roll, pitch, thrust] = self.allocation;
        (roll * wrench[0] + pitch * wrench[1]) + thrust * wrench[2]
    }
}

/// The z that leave all thrusts attainable; from `high` to `low` where there are none.
#[derive(Clone, Copy)]
pub(super) struct NullRange {
    low: f32,
    high: f32,
    /// False where a thrust that N does not change is out of its range.
    others: bool,
}

impl NullRange {
    /// True where some z leaves all thrusts attainable.
    #[inline(always)]
    fn is_attainable(&self) -> bool {
        self.low <= self.high && self.others
    }

    /// The z nearest zero.
    #[inline(always)]
    pub(super) fn nearest(&self) -> f32 {
        clamp(
            0.0,
            self.low,
            if self.high > self.low { self.high } else { self.low },
        )
    }
}

impl<S: TorqueLimit> Vertical<'_, S> {
    /// Finds attainable thrusts of at most `ceiling` in all, from which yaw can reach `wanted` in its `direction` if from
    /// any. Where it cannot even reach zero they are drawn towards those of the thrust `middle`. Returns how far yaw
    /// reaches, and where they are on the units' way.
    #[inline(always)]
    pub(super) fn attainable_thrusts<'a>(
        &'a self,
        request: &Request,
        [ceiling, middle]: [f32; 2],
        search: &mut [Search<'a, S>],
        direction: f32,
        wanted: f32,
    ) -> (f32, f32) {
        let (wrench, range, attainable) = self.within_facets(request, ceiling, search, direction);
        let NullRange { low, high, .. } = range;
        let mut z = range.nearest();
        let mut here = reach(search, z);
        // On the zonotope's border z has no room.
        let is_short = here < wanted && high > low && attainable;
        if is_short && !self.border.is_concave() {
            (z, here) = climb(search, (z, here), [low, high], wanted, self.yaw_rounding_nm);
        } else if is_short {
            let top_z = top(search, z, [low, high]);
            let most = reach(search, top_z);
            let gain = most - here;
            let gain = if gain > self.yaw_rounding_nm {
                gain
            } else {
                self.yaw_rounding_nm
            };
            let part = (wanted - here) / gain;
            here = most;
            if part < 1.0 {
                z += part * (top_z - z);
                here = reach(search, z);
            } else {
                z = top_z;
            }
        }
        if here < -self.yaw_rounding_nm {
            // From the inside, so it is zero or a little more.
            let (_, at) = self.retreat(search, z, here, 0.0, middle);
            if self.border.is_concave() {
                return (0.0, at);
            }
            // z has some room there, and yaw may gain much from it.
            let drawn = wrench.map(|part| at * part);
            let drawn = [drawn[0], drawn[1], drawn[2] + (1.0 - at) * middle];
            let NullRange { low, high, .. } = self.null_range(search, &drawn, direction);
            z *= at;
            here = reach(search, z);
            if here < wanted && high > low {
                z = clamp(z, low, high);
                (z, here) = climb(search, (z, here), [low, high], wanted, self.yaw_rounding_nm);
            }
            return (if here > 0.0 { here } else { 0.0 }, z);
        }
        (here, z)
    }

    /// Starts at the least-norm thrusts of the request, with (roll, pitch) and thrust brought to where the facets allow them if
    /// need be. Returns these, z's range, and true where there was no need.
    #[inline(always)]
    pub(super) fn within_facets<'a>(
        &'a self,
        request: &Request,
        ceiling: f32,
        search: &mut [Search<'a, S>],
        direction: f32,
    ) -> ([f32; 3], NullRange, bool) {
        let mut wrench = [request.roll, request.pitch, request.thrust];
        let mut range = self.null_range(search, &wrench, direction);
        let attainable = range.is_attainable();
        if !attainable {
            let (share, [low, high]) = self.share(request.roll, request.pitch, ceiling);
            wrench = [
                share * request.roll,
                share * request.pitch,
                clamp(request.thrust, low, high),
            ];
            range = self.null_range(search, &wrench, direction);
        }
        (wrench, range, attainable)
    }

    /// Starts at the least-norm thrusts of `[roll, pitch, thrust]`, with z as the units' way. Returns z's range.
    #[inline(never)]
    fn null_range<'a>(
        &'a self,
        search: &mut [Search<'a, S>],
        wrench: &[f32; 3],
        direction: f32,
    ) -> NullRange {
        let [least, most] = self.thrust_n;
        let mut range = NullRange {
            low: -f32::MAX,
            high: f32::MAX,
            others: true,
        };
        for (unit, state) in self.units.iter().zip(search) {
            rolled();
            let f = unit.thrust(wrench);
            (state.from, state.along) = (f, unit.null);
            state.turn = direction * unit.spin;
            state.side = self.border.side(state.turn);
            if unit.per_null == 0.0 {
                range.others &= f >= least && f <= most;
                continue;
            }
            let [from, to] = unit.ends.map(|end| (end - f) * unit.per_null);
            range.low = if from > range.low { from } else { range.low };
            range.high = if to < range.high { to } else { range.high };
        }
        if range.high == f32::MAX {
            // There is no null space.
            (range.low, range.high) = (0.0, 0.0);
        }
        range
    }

    /// Draws the thrusts, now at `z` where yaw reaches `reached`, towards those of `middle_n` until it reaches `needed`.
    /// Returns how far it then reaches and where the thrusts are on their new way; leaves the limits.
    #[inline(never)]
    pub(super) fn retreat(
        &self,
        search: &mut [Search<'_, S>],
        z: f32,
        reached: f32,
        needed: f32,
        middle_n: f32,
    ) -> (f32, f32) {
        for (unit, state) in self.units.iter().zip(search.iter_mut()) {
            rolled();
            let thrust = state.thrust(z);
            state.from = unit.allocation[2] * middle_n;
            state.along = thrust - state.from;
        }
        reach_from_inside(search, reached, needed, self.border.is_concave())
    }
}
