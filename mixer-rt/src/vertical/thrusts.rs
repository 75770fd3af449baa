//! The thrusts: f = C+ w + z N.
//!
//! Where z has room and yaw does not reach the request, z moves towards where yaw reaches furthest, only the part
//! `(yaw - Y(0)) / (Y(z) - Y(0))` of the way. So the thrusts are a Lipschitz function of the request, which they would
//! not be if z were moved just far enough. Y is nearly concave: where that part is not enough, two more steps mend it.

use super::{Request, Search, Vertical, VerticalUnit, rolled};
use crate::clamp;
use core::hint::black_box;

/// Steps towards the furthest yaw, ..
const CLIMBS: u32 = 2;

/// .. and towards the middle. Each is twice as long as a straight line asks for, but for the first.
const RETREATS: u32 = 2;

/// In yaw that counts as none: what z's way must gain to be gone in full. A way of less gain is gone in part, so that
/// z does not jump where the gain vanishes. Costs up to a quarter of it, 0.02 % of the yaw.
const GAIN: f32 = 100.0;

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
struct NullRange {
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
    fn nearest(low: f32, high: f32) -> f32 {
        clamp(0.0, low, if high > low { high } else { low })
    }
}

/// How far yaw of the sign `sign` reaches.
#[inline(always)]
fn furthest([least, most]: [f32; 2], sign: f32) -> f32 {
    if sign < 0.0 { -least } else { most }
}

impl Vertical<'_> {
    /// Finds attainable thrusts of at most `ceiling` in all, from which yaw can reach the request if from any. Where yaw
    /// would be reversed or exceeded they are drawn towards those of the thrust `middle`. Returns where they are on the
    /// units' way, and leaves what yaw each unit gives there.
    #[inline(always)]
    pub(super) fn attainable_thrusts(
        &self,
        request: &Request,
        [ceiling, middle]: [f32; 2],
        search: &mut [Search],
    ) -> f32 {
        let (NullRange { low, high, .. }, has_room) = self.within_facets(request, ceiling, search);
        let mut z = NullRange::nearest(low, high);
        let reach = self.reach(search, z);
        // The limit of yaw that the request violates, if any.
        let sign = if request.yaw > reach[1] {
            1.0
        } else if request.yaw < reach[0] {
            -1.0
        } else {
            return z;
        };
        let wanted = sign * request.yaw;
        let mut here = furthest(reach, sign);
        if has_room && high > low {
            (z, here) = self.climb(search, sign, (z, here), [low, high], wanted);
        }
        // Beyond zero yaw is reversed, beyond the request it is exceeded.
        let needed = if wanted < 0.0 { wanted } else { 0.0 };
        if needed - here > self.yaw_rounding_nm {
            z = self.retreat(search, sign, (z, here), needed, middle);
        }
        z
    }

    /// Moves z from a point where yaw reaches less than `wanted` towards where it reaches furthest within `range`. Returns z
    /// and how far yaw reaches there, and leaves what each unit gives.
    #[inline(always)]
    fn climb(
        &self,
        search: &mut [Search],
        sign: f32,
        (mut z, mut here): (f32, f32),
        range: [f32; 2],
        wanted: f32,
    ) -> (f32, f32) {
        let top = self.top(search, sign, z, range);
        if top == z {
            return (z, here);
        }
        let most = furthest(self.reach(search, top), sign);
        let whole = GAIN * self.yaw_rounding_nm;
        let mut ahead = 1.0;
        for _ in 0..black_box(CLIMBS) {
            let gain = most - here;
            let mut part = if gain > 0.0 {
                ahead * (wanted - here) / gain
            } else {
                0.0
            };
            part = if part < 1.0 { part } else { 1.0 };
            part *= if gain < whole { gain / whole } else { 1.0 };
            z += part * (top - z);
            here = furthest(self.reach(search, z), sign);
            if here >= wanted || here >= most {
                break;
            }
            ahead = 2.0;
        }
        (z, here)
    }

    /// z's range at the least-norm thrusts of the request, with (roll, pitch) and thrust brought to where the facets allow
    /// them if need be: then z has no room. Leaves the units' way, z.
    #[inline(always)]
    fn within_facets(&self, request: &Request, ceiling: f32, search: &mut [Search]) -> (NullRange, bool) {
        let wrench = [request.roll, request.pitch, request.thrust];
        let range = self.null_range(search, &wrench);
        if range.is_attainable() {
            return (range, true);
        }
        let (share, [low, high]) = self.share(request.roll, request.pitch, ceiling);
        let wrench = [
            share * request.roll,
            share * request.pitch,
            clamp(request.thrust, low, high),
        ];
        (self.null_range(search, &wrench), false)
    }

    /// Starts at the least-norm thrusts of `[roll, pitch, thrust]`, with z as the units' way. Returns z's range.
    #[inline(never)]
    fn null_range(&self, search: &mut [Search], wrench: &[f32; 3]) -> NullRange {
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
    /// Returns where they are on their new way, and leaves what yaw each unit gives there.
    ///
    /// A straight line from the middle crosses `needed` inside where the sides are concave: then a second one from there
    /// is nearer. Where they are not it may cross outside, by little: then the steps go inwards.
    #[inline(never)]
    fn retreat(
        &self,
        search: &mut [Search],
        sign: f32,
        (z, reached): (f32, f32),
        needed: f32,
        middle_n: f32,
    ) -> f32 {
        for (unit, state) in self.units.iter().zip(search.iter_mut()) {
            rolled();
            let thrust = state.thrust(z);
            state.from = unit.allocation[2] * middle_n;
            state.along = thrust - state.from;
        }
        let outside = reached - needed;
        let inside = furthest(self.reach(search, 0.0), sign) - needed;
        let inside = if inside > 0.0 { inside } else { 0.0 };
        let mut at = inside / (inside - outside);
        let mut here = furthest(self.reach(search, at), sign) - needed;
        if here > 0.0 {
            at += (1.0 - at) * here / (here - outside);
            here = furthest(self.reach(search, at), sign) - needed;
        }
        for _ in 0..black_box(RETREATS) {
            if here >= 0.0 {
                break;
            }
            at *= clamp(1.0 + 2.0 * here / (inside - here), 0.0, 1.0);
            here = furthest(self.reach(search, at), sign) - needed;
        }
        at
    }
}
