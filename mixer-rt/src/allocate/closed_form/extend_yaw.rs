//! z moved towards where yaw reaches furthest.
//!
//! The lines run through the null space, or for the reserve in any direction that keeps roll and pitch.
//! By the coarse sides Y(z), the furthest yaw, is a sum of concave functions of straight lines.
//! From the start z goes in the direction in which Y grows, from knot to knot, until it does not:
//! at most all units' knots, each met once. The knots move with the request continuously and the
//! slopes between them are constants, so the end does not jump; where Y is level, z stays at the
//! nearest point that is best.
//!
//! Where z has room and the requested yaw is out of range at the start, z moves towards the z of
//! the largest yaw, by the part `(yaw - Y(start)) / (Y(top) - Y(start))` of the way. This makes the
//! thrusts a Lipschitz function of the request; moving z just far enough would not. Y is nearly
//! concave: where that part is not enough, a second step of twice the length follows.

use core::hint::black_box;

use super::thrusts::furthest;
use super::{Border, ClosedForm, MOST_CLOSED_FORM_UNITS, Outline, ThrustLine};
use crate::{divisor, rolled, smaller};

/// Most steps towards the largest yaw. The second is twice as long as a straight line asks for.
const EXTENSIONS: u32 = 2;

/// Gain of yaw, in units of `yaw_rounding_nm`, from which z moves to the top in full. For a smaller
/// gain it moves a part of the way, so that z does not jump where the gain vanishes. That costs at
/// most a quarter of this gain, 0.025 % of the authority in yaw.
const GAIN: f32 = 100.0;

/// The knots of one unit's side that are ahead.
#[derive(Clone, Copy)]
struct Ahead<'a> {
    outline: &'a Outline,
    /// How far away the next one is, in z.
    next: f32,
    /// By how much less yaw grows beyond it, N m per unit of z.
    drop: f32,
    /// Its index, and the step to the one after it.
    index: usize,
    step: usize,
    /// z per N of thrust, and N per unit of z in magnitude.
    per_n: f32,
    speed: f32,
    /// Thrust at the start, N.
    start: f32,
}

impl Ahead<'_> {
    /// To the knot at `index`; none where the unit stays.
    #[inline(always)]
    fn look(&mut self) {
        self.next = f32::MAX;
        if let Some(knot) = self.outline.knots.get(self.index)
            && self.speed > 0.0
        {
            self.next = (knot.thrust_n - self.start) * self.per_n;
            self.drop = knot.drop * self.speed;
        }
        self.index = self.index.wrapping_add(self.step);
    }
}

impl Border<'_> {
    /// The side in which a unit that has `turn` yaw per torque in the direction looked at gives
    /// most.
    #[inline(always)]
    fn outline(&self, turn: f32) -> &Outline {
        let [largest, least] = &self.outlines;
        if turn < 0.0 { least } else { largest }
    }
}

impl ClosedForm<'_> {
    /// Moves z from a point where yaw does not reach `wanted` towards where it reaches furthest
    /// within `range`. Returns z and the least and most yaw there, and leaves what each unit gives
    /// of it.
    #[inline(always)]
    pub(super) fn extend_yaw(
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
        for _ in 0..black_box(EXTENSIONS) {
            let here = furthest(reach, sign);
            let gain = most - here;
            let mut part = if gain > 0.0 {
                ahead * (wanted - here) / divisor(gain)
            } else {
                0.0
            };
            part = smaller(part, 1.0);
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

    /// z within `[low, high]` where yaw of the sign `sign` reaches furthest by the coarse sides,
    /// seen from `start`.
    #[inline(never)]
    pub(super) fn top(&self, lines: &[ThrustLine], sign: f32, start: f32, [low, high]: [f32; 2]) -> f32 {
        let none = Ahead {
            outline: &self.border.outlines[0],
            next: f32::MAX,
            drop: 0.0,
            index: 0,
            step: 1,
            per_n: 0.0,
            speed: 0.0,
            start: 0.0,
        };
        let mut ahead = [none; MOST_CLOSED_FORM_UNITS];
        let mut growth = 0.0;
        for ((unit, line), ahead) in rolled(self.units.iter().zip(lines).zip(&mut ahead)) {
            ahead.outline = self.border.outline(sign * unit.spin);
            ahead.start = line.thrust(start);
            let mut slope = ahead.outline.slope;
            for knot in rolled(&ahead.outline.knots) {
                if knot.thrust_n > ahead.start {
                    break;
                }
                slope -= knot.drop;
                ahead.index += 1;
            }
            growth += slope * line.along;
        }
        // Towards more thrust a unit passes the knots above it, towards less those below it, one
        // just met included.
        let direction = if growth < 0.0 { -1.0 } else { 1.0 };
        growth *= direction;
        let end = if direction < 0.0 {
            start - low
        } else {
            high - start
        };
        for (line, ahead) in rolled(lines.iter().zip(&mut ahead)) {
            let speed = direction * line.along;
            ahead.speed = speed.abs();
            if speed != 0.0 {
                ahead.per_n = 1.0 / speed;
            }
            if speed < 0.0 {
                ahead.index = ahead.index.wrapping_sub(1);
                ahead.step = usize::MAX; // -1, added with wrapping
            }
            ahead.look();
        }
        let mut way = 0.0;
        while growth > 0.0 {
            black_box(());
            way = end;
            let mut nearest = None;
            for ahead in rolled(&mut ahead) {
                if ahead.next < way {
                    way = ahead.next;
                    nearest = Some(ahead);
                }
            }
            let Some(ahead) = nearest else {
                break;
            };
            growth -= ahead.drop;
            ahead.look();
        }
        start + direction * way
    }
}
