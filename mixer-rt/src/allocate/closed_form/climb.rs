//! z where yaw reaches furthest.
//!
//! The lines run through the null space, or in a retreat in any direction that keeps roll and pitch.
//! By the coarse sides Y(z), the furthest yaw, is a sum of concave functions of straight lines.
//! From the start z goes in the direction in which Y grows, from knot to knot, until it does not:
//! at most all units' knots, each met once. The knots move with the request continuously and the
//! slopes between them are constants, so the end does not jump; where Y is level, z stays at the
//! nearest point that is best.

use super::{Border, ClosedForm, MOST_CLOSED_FORM_UNITS, Outline, ThrustLine};
use crate::rolled;

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
        // Growth that is rounding only is none.
        let level = self.yaw_rounding_nm / self.thrust_n[1];
        let mut way = 0.0;
        while growth > level {
            core::hint::black_box(());
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
