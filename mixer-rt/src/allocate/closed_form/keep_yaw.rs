//! Thrust, roll and pitch given up to keep yaw: thrust for the reserve, all three for zero yaw.
//!
//! The thrusts found so far are drawn along straight lines towards others where yaw reaches further,
//! no further than that needs:
//!
//! ```text
//! reserve     to the thrusts of the same roll and pitch at the thrust nearest the middle
//! zero yaw    to level flight at the middle: out of range next to a few corners of the set only
//! ```
//!
//! All steps are continuous in the request, and all lines lie inside the attainable set.

use core::hint::black_box;

use super::thrusts::furthest;
use super::{ClosedForm, MOST_CLOSED_FORM_UNITS, ThrustLine};
use crate::{clamp, divisor, larger, rolled, smaller};

/// Most steps to where yaw reaches what is needed. Steps inwards are twice as long as a straight
/// line asks for.
const CROSSINGS: u32 = 3;

/// Gain of yaw, in units of `yaw_rounding_nm`, from which thrust is given up in full for the reserve:
/// 1 % of the authority. Below it the change of thrust is scaled linearly to 0, for continuity. That
/// costs at most a quarter of this gain.
const GAIN_BY_THRUST: f32 = 1000.0;

/// Times that thrust is given up for the reserve: the second time from the thrust that the first one
/// leaves, where yaw reaches further along the null space.
const ROUNDS: u32 = 2;

impl ClosedForm<'_> {
    /// Draws the thrusts, now at `z` where yaw reaches less than `needed`, straight towards level
    /// flight of the thrust `middle`, N, until it reaches it. Returns their z on the new lines and
    /// the least and most yaw there; writes the lines with each unit's yaw.
    #[inline(never)]
    pub(super) fn bound_yaw(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (z, reach): (f32, [f32; 2]),
        needed: f32,
        middle: f32,
    ) -> (f32, [f32; 2]) {
        for (unit, line) in rolled(self.units.iter().zip(lines.iter_mut())) {
            let thrust = line.thrust(z);
            line.from = unit.allocation[2] * middle;
            line.along = thrust - line.from;
        }
        let level = furthest(self.reach(lines, 0.0), sign);
        self.crossing(
            lines,
            sign,
            needed,
            [level - needed, furthest(reach, sign) - needed],
        )
    }

    /// Draws the thrusts, now at `z` where yaw reaches less than `needed` of the reserve, towards those
    /// of `roomy`, `[roll, pitch, thrust]` with the same roll and pitch, until it reaches it. Returns and
    /// writes as [`bound_yaw`](Self::bound_yaw).
    #[inline(never)]
    pub(super) fn keep_reserve(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (z, reach): (f32, [f32; 2]),
        needed: f32,
        roomy: &[f32; 3],
    ) -> (f32, [f32; 2]) {
        let mut given = [0.0; MOST_CLOSED_FORM_UNITS];
        for (line, given) in rolled(lines.iter().zip(&mut given)) {
            *given = line.thrust(z);
        }
        let here = furthest(reach, sign);
        let mut roomy = *roomy;
        let mut at = 1.0;
        for _ in 0..black_box(ROUNDS) {
            let [low, high] = self.null_range(lines, &roomy);
            let high = larger(high, low);
            let top = self.top(lines, sign, clamp(z, low, high), [low, high]);
            let most = furthest(self.reach(lines, top), sign);
            for (line, given) in rolled(lines.iter_mut().zip(given)) {
                line.from = line.thrust(top);
                line.along = given - line.from;
            }
            let (crossing, _) = self.crossing(lines, sign, needed, [most - needed, here - needed]);
            let part = clamp((most - here) / (GAIN_BY_THRUST * self.yaw_rounding_nm), 0.0, 1.0);
            at = 1.0 - part * (1.0 - crossing);
            roomy[2] = lines.iter().map(|line| line.thrust(at)).sum();
        }
        (at, self.reach(lines, at))
    }

    /// Goes along the lines from 0 towards 1 until yaw reaches `needed`, which it exceeds by
    /// `inside` at 0 and by `outside` at 1. Returns the place and the least and most yaw there;
    /// writes each unit's yaw.
    ///
    /// A straight line crosses `needed` inside where the sides are concave: then a second one from
    /// there is nearer. Where they are not it may cross outside, by little: then the steps go
    /// inwards.
    #[inline(never)]
    fn crossing(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        needed: f32,
        [inside, outside]: [f32; 2],
    ) -> (f32, [f32; 2]) {
        let inside = larger(inside, 0.0);
        // Outside by a little at least, so that no division is by zero.
        let outside = smaller(outside, -self.yaw_rounding_nm);
        let mut at = inside / (inside - outside);
        for step in 0..black_box(CROSSINGS) {
            let reach = self.reach(lines, at);
            let here = furthest(reach, sign) - needed;
            if here < 0.0 {
                at *= clamp(1.0 + 2.0 * here / divisor(inside - here), 0.0, 1.0);
            } else if step == 0 {
                at += (1.0 - at) * here / divisor(here - outside);
            } else {
                return (at, reach);
            }
        }
        (at, self.reach(lines, at))
    }
}
