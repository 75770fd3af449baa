//! z where yaw reaches furthest.
//!
//! By the coarse sides Y(z), the furthest yaw, is a sum of concave functions of straight lines. From the start z goes the way
//! on which Y grows, from knot to knot, until it does not: at most all units' knots, each met once. The knots move with the
//! request continuously and the slopes between them are constants, so the end does not jump; where Y is level, z stays at the
//! nearest point that is best.

use super::{Border, MOST_UNITS, Outline, Search, Vertical, rolled};

/// The knots of one unit's side that are ahead.
#[derive(Clone, Copy, Default)]
struct Ahead {
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

impl Ahead {
    /// To the knot at `index`.
    #[inline(always)]
    fn look(&mut self, outline: &Outline) {
        (self.next, self.drop) = match outline.knots.get(self.index) {
            Some(knot) => ((knot.thrust_n - self.start) * self.per_n, knot.drop * self.speed),
            None => (f32::MAX, 0.0),
        };
        self.index = self.index.wrapping_add(self.step);
    }
}

impl Border<'_> {
    /// The side in which a unit that has `turn` yaw per torque in the direction looked at gives most.
    #[inline(always)]
    fn outline(&self, turn: f32) -> &Outline {
        let [largest, least] = &self.outlines;
        if turn < 0.0 { least } else { largest }
    }
}

impl Vertical<'_> {
    /// z within `[low, high]` where yaw of the sign `sign` reaches furthest by the coarse sides, seen from `start`.
    #[inline(always)]
    pub(super) fn top(&self, search: &[Search], sign: f32, start: f32, [low, high]: [f32; 2]) -> f32 {
        for (direction, end) in [(1.0, high - start), (-1.0, start - low)] {
            let way = self.ascent(search, sign, start, direction, end);
            if way > 0.0 {
                return start + direction * way;
            }
        }
        start
    }

    /// How far yaw grows from `start` in one direction of z, at most to `end`.
    #[inline(never)]
    fn ascent(&self, search: &[Search], sign: f32, start: f32, direction: f32, end: f32) -> f32 {
        let mut ahead = [Ahead::default(); MOST_UNITS];
        let mut growth = 0.0;
        for ((unit, state), ahead) in self.units.iter().zip(search).zip(&mut ahead) {
            rolled();
            let outline = self.border.outline(sign * unit.spin);
            let (speed, f) = (direction * state.along, state.thrust(start));
            *ahead = Ahead {
                next: f32::MAX,
                per_n: direction * unit.per_null,
                speed: speed.abs(),
                start: f,
                ..Ahead::default()
            };
            let mut slope = outline.slope;
            let mut passed = 0usize;
            for knot in &outline.knots {
                rolled();
                if knot.thrust_n < f || (knot.thrust_n == f && speed > 0.0) {
                    slope -= knot.drop;
                    passed += 1;
                }
            }
            growth += slope * speed;
            (ahead.index, ahead.step) = if speed > 0.0 {
                (passed, 1)
            } else {
                (passed.wrapping_sub(1), usize::MAX)
            };
            if speed != 0.0 {
                ahead.look(outline);
            }
        }
        // Growth that is rounding only is none.
        let level = self.yaw_rounding_nm / self.thrust_n[1];
        let mut way = 0.0;
        while growth > level {
            rolled();
            way = end;
            let mut nearest = None;
            for (unit, ahead) in self.units.iter().zip(&mut ahead) {
                rolled();
                if ahead.next < way {
                    way = ahead.next;
                    nearest = Some((unit, ahead));
                }
            }
            let Some((unit, ahead)) = nearest else {
                break;
            };
            growth -= ahead.drop;
            ahead.look(self.border.outline(sign * unit.spin));
        }
        way
    }
}
