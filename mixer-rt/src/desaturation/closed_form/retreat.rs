//! Thrust, roll and pitch given up for yaw: for zero yaw, or for the reserve.
//!
//! The thrusts found so far are drawn along straight lines towards others where yaw reaches further,
//! as far as that is needed:
//!
//! ```text
//! given ---- answer ---- roomy ---- level      yaw reaches what is needed at the answer,
//!                                              and more at roomy and level
//! ```
//!
//! Level flight has the middle of its thrusts. The roomy thrusts have the roll and pitch of the
//! request and the thrust nearest that middle; where yaw hardly reaches there they are drawn towards
//! level flight themselves, so that the line to them has a least slope. That gives up thrust before
//! roll and pitch. All steps are continuous in the request, and all lines lie inside the attainable
//! set.
//!
//! At the answer there may be directions that keep roll and pitch and take yaw further. Going there,
//! and out again towards the given thrusts, gives less up: that is done twice.
//!
//! Without a reserve zero yaw is out of range next to a few corners of the set only, and the thrusts
//! are drawn straight to level flight.

use core::hint::black_box;

use super::thrusts::{GAIN, furthest};
use super::{ClosedForm, MOST_CLOSED_FORM_UNITS, ThrustLine};
use crate::{clamp, divisor, quotient, rolled};

/// Most steps to where yaw reaches what is needed. Steps inwards are twice as long as a straight
/// line asks for.
const CROSSINGS: u32 = 3;

/// Share of the yaw of level flight that a reserve takes at most. The sides being concave, at least
/// the other half of roll and pitch is left.
const RESERVABLE: f32 = 0.5;

/// Room beyond the yaw needed that thrusts have which others are drawn to, as a share of the room
/// of level flight. It bounds how far thrusts move with the request. Where roll and pitch leave
/// less room they are cut, by about this share at most.
const MARGIN: f32 = 1.0 / 64.0;

/// Times that the thrusts are drawn out again.
const ROUNDS: u32 = 2;

/// Directions that keep roll and pitch, as shares of the least-norm thrust and of the null space:
/// on a regular X8 the two units whose upper rotors turn one way, and the other two. Yaw is the sum
/// of what these give, so that one after the other is enough there.
const DIRECTIONS: [[f32; 2]; 2] = [[1.0, 0.25], [1.0, -0.25]];

/// A unit's part in a direction below which it stays: rounding of the table.
const STILL: f32 = 1e-3;

impl ClosedForm<'_> {
    /// Draws the thrusts, now at `z` where yaw reaches less than `needed`, straight towards level
    /// flight of the thrust `middle`, N, until it reaches it. Returns their z on the new lines and
    /// the least and most yaw there; writes the lines with each unit's yaw.
    #[inline(never)]
    pub(super) fn retreat(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (z, reach): (f32, [f32; 2]),
        needed: f32,
        middle: f32,
    ) -> (f32, [f32; 2]) {
        for (unit, line) in self.units.iter().zip(lines.iter_mut()) {
            rolled();
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

    /// As [`retreat`](Self::retreat) for a reserve: thrust, at most `ceiling`, is given up before
    /// roll and pitch. `roomy` is `[roll, pitch, thrust]` with the roll and pitch of the request and
    /// a thrust that leaves yaw more room; none where already these have to be cut.
    #[inline(never)]
    pub(super) fn keep(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (z, reach): (f32, [f32; 2]),
        needed: f32,
        roomy: Option<[f32; 3]>,
        [ceiling, middle]: [f32; 2],
    ) -> (f32, [f32; 2]) {
        let mut given = [0.0; MOST_CLOSED_FORM_UNITS];
        for ((unit, line), given) in self.units.iter().zip(lines.iter_mut()).zip(&mut given) {
            rolled();
            *given = line.thrust(z);
            line.from = unit.allocation[2] * middle;
            line.along = *given - line.from;
        }
        let level = furthest(self.reach(lines, 0.0), sign);
        let most = RESERVABLE * if level > 0.0 { level } else { 0.0 };
        let needed = if needed < most { needed } else { most };
        let outside = furthest(reach, sign) - needed;
        if outside >= 0.0 {
            for (line, given) in lines.iter_mut().zip(given) {
                rolled();
                (line.from, line.along) = (given, 0.0);
            }
            return (0.0, self.reach(lines, 0.0));
        }
        let mut inside = level;
        if let Some(wrench) = roomy {
            let target = needed + MARGIN * (level - needed);
            let at = self.roomy(lines, sign, &wrench, (z, target), (middle, level));
            inside = furthest(at.1, sign);
            aim(lines, at.0, &given);
        }
        let mut found = self.crossing(lines, sign, needed, [inside - needed, outside]);
        let directions = if self.units.iter().any(|unit| unit.null != 0.0) {
            DIRECTIONS.as_slice()
        } else {
            // All directions are this one.
            &[[1.0, 0.0]]
        };
        for _ in 0..black_box(ROUNDS) {
            for &direction in directions {
                found = self.ascend(lines, sign, found, direction, ceiling);
            }
            inside = furthest(found.1, sign);
            if inside - needed <= self.yaw_rounding_nm {
                return (found.0, self.reach(lines, found.0));
            }
            aim(lines, found.0, &given);
            found = self.crossing(lines, sign, needed, [inside - needed, outside]);
        }
        found
    }

    /// Moves the thrusts along `direction` to where yaw reaches furthest, within `ceiling` in sum.
    /// Takes and returns the place on the lines and the least and most yaw there; writes the lines,
    /// but not what each unit gives of it.
    #[inline(never)]
    fn ascend(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        (at, reach): (f32, [f32; 2]),
        [by_thrust, by_null]: [f32; 2],
        ceiling: f32,
    ) -> (f32, [f32; 2]) {
        let (mut low, mut high) = (-f32::MAX, ceiling);
        for (unit, line) in self.units.iter().zip(lines.iter_mut()) {
            rolled();
            let f = line.thrust(at);
            let along = by_thrust * unit.allocation[2] + by_null * unit.null;
            (line.from, line.along) = (f, if along.abs() > STILL { along } else { 0.0 });
            // The shares of the least-norm thrust add up to 1.
            high -= by_thrust * f;
        }
        for line in lines.iter() {
            rolled();
            if line.along != 0.0 {
                let [a, b] = self.thrust_n.map(|end| quotient(end - line.from, line.along));
                let [a, b] = if a < b { [a, b] } else { [b, a] };
                low = if a > low { a } else { low };
                high = if b < high { b } else { high };
            }
        }
        // A unit may be beyond its end by rounding.
        let range = [
            if low < 0.0 { low } else { 0.0 },
            if high > 0.0 { high } else { 0.0 },
        ];
        let top = self.top(lines, sign, 0.0, range);
        if top == 0.0 {
            return (0.0, reach);
        }
        let at_top = self.reach(lines, top);
        let gain = furthest(at_top, sign) - furthest(reach, sign);
        let whole = GAIN * self.yaw_rounding_nm;
        if gain >= whole {
            (top, at_top)
        } else if gain > 0.0 {
            // A part of the way, so that nothing jumps where the gain vanishes.
            let part = gain / whole * top;
            (part, self.reach(lines, part))
        } else {
            (0.0, reach)
        }
    }

    /// Finds the thrusts of `wrench`, z as near the present one as can be. Where yaw does not reach
    /// `target` there they are nearer to level flight of the thrust `middle`, where it reaches
    /// `level`. Writes lines, and returns the place on them and the least and most yaw there.
    #[inline(always)]
    fn roomy(
        &self,
        lines: &mut [ThrustLine],
        sign: f32,
        wrench: &[f32; 3],
        (z, target): (f32, f32),
        (middle, level): (f32, f32),
    ) -> (f32, [f32; 2]) {
        let [low, high] = self.null_range(lines, wrench);
        let at = clamp(z, low, if high > low { high } else { low });
        let reach = self.reach(lines, at);
        let short = target - furthest(reach, sign);
        if short <= 0.0 {
            return (at, reach);
        }
        for (unit, line) in self.units.iter().zip(lines.iter_mut()) {
            rolled();
            let thrust = line.thrust(at);
            line.from = unit.allocation[2] * middle;
            line.along = thrust - line.from;
        }
        self.crossing(lines, sign, target, [level - target, -short])
    }

    /// Goes along the lines from 0 towards 1, as far as yaw reaches `needed`, which it exceeds by
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
        let inside = if inside > 0.0 { inside } else { 0.0 };
        // Outside by a little at least, so that no division is by zero.
        let least = -self.yaw_rounding_nm;
        let outside = if outside < least { outside } else { least };
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

/// Writes lines from the thrusts at `at` of the present ones to others.
#[inline(always)]
fn aim(lines: &mut [ThrustLine], at: f32, to: &[f32]) {
    for (line, to) in lines.iter_mut().zip(to) {
        rolled();
        line.from = line.thrust(at);
        line.along = to - line.from;
    }
}
