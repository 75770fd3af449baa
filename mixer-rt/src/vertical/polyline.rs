//! The furthest yaw Y(z) along the null space where the attainable set is not convex, so that Y may have several peaks.
//!
//! The sides are polylines, so Y is one, too: one pass over its knots finds the two highest peaks and the valley between.
//! Where they are nearly as high z is between them, since going from one to the other at once would be a jump
//! of the throttles. The thrusts then go the part of the way to z that yaw needs, as where Y is concave, and on where that
//! part of the way leads through a valley.

use core::hint::black_box;

use super::reach::{TorqueLimit, reach};
use super::{MOST_UNITS, Search};
use crate::rolled;

/// A knot of a side, and the line from it to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// N.
    pub thrust_n: f32,
    /// N m.
    pub torque_nm: f32,
    /// N m per N, to the next knot.
    pub slope: f32,
    /// By how much the slope is larger than before the knot, N m per N; 0 at the first.
    pub bend: f32,
}

/// A side of any shape: the largest torque in one direction at every thrust, linear between knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<'a>(
    /// In the order of the thrust; one at least.
    pub &'a [Knot],
);

impl TorqueLimit for Polyline<'_> {
    #[inline(always)]
    fn tangent(&self, f: f32) -> (f32, f32) {
        let Some((first, others)) = self.0.split_first() else {
            return (0.0, 0.0);
        };
        let mut knot = first;
        for next in others {
            rolled();
            if f < next.thrust_n {
                break;
            }
            knot = next;
        }
        (knot.torque_nm + knot.slope * (f - knot.thrust_n), knot.slope)
    }

    #[inline(always)]
    fn knots(&self) -> &[Knot] {
        self.0
    }

    #[inline(always)]
    fn corner_n(&self) -> Option<f32> {
        None
    }
}

/// Peaks whose heights differ by less than this many times the yaw that counts as none are both heeded: half a percent of
/// the largest yaw.
const RIVALRY: f32 = 500.0;

/// The same in depths of the valley between: a peak that is vanishing counts less and less.
const DEPTHS: f32 = 4.0;

/// Steps out of valleys on the way to the peak.
const STEPS: u32 = 3;

/// A point of Y(z).
#[derive(Clone, Copy)]
struct Point {
    z: f32,
    yaw: f32,
}

/// The knots of one unit's side that are ahead.
#[derive(Clone, Copy)]
struct Ahead<'a> {
    knots: &'a [Knot],
    /// Where the next one is, ..
    z: f32,
    /// .. and by how much it bends the side.
    bend: f32,
    /// Where the unit's way starts, N, and 1 / N per unit of the way.
    from: f32,
    per_along: f32,
}

impl Ahead<'_> {
    /// To the next knot.
    #[inline(always)]
    fn advance(&mut self) {
        let next = if self.per_along > 0.0 {
            self.knots.split_first()
        } else {
            self.knots.split_last()
        };
        self.z = f32::MAX;
        if let Some((knot, rest)) = next {
            self.z = (knot.thrust_n - self.from) * self.per_along;
            self.bend = knot.bend;
            self.knots = rest;
        }
    }
}

/// The two highest peaks, in the order of z, the valley between them, and the lowest point since.
struct Peaks {
    first: Point,
    second: Option<Point>,
    valley: f32,
    since: f32,
}

impl Peaks {
    /// Takes the next peak in the order of z.
    #[inline(always)]
    fn add(&mut self, peak: Point) {
        let Some(second) = self.second else {
            (self.second, self.valley) = (Some(peak), self.since);
            self.since = f32::MAX;
            return;
        };
        // Without the lowest of the three.
        if self.first.yaw <= second.yaw && self.first.yaw <= peak.yaw {
            (self.first, self.valley) = (second, self.since);
        } else if second.yaw <= peak.yaw {
            self.valley = if self.since < self.valley {
                self.since
            } else {
                self.valley
            };
        } else {
            return;
        }
        (self.second, self.since) = (Some(peak), f32::MAX);
    }

    /// z at the higher peak, or between the two; and the yaw there, where it is at the peak.
    #[inline(always)]
    fn choice(&self, rivalry: f32) -> (f32, Option<f32>) {
        let Some(second) = self.second else {
            return (self.first.z, Some(self.first.yaw));
        };
        let (high, low) = if second.yaw > self.first.yaw {
            (second, self.first)
        } else {
            (self.first, second)
        };
        let depth = DEPTHS * (low.yaw - self.valley);
        let rivalry = if depth < rivalry { depth } else { rivalry };
        let behind = high.yaw - low.yaw;
        if behind < rivalry {
            let part = 0.5 - 0.5 * (behind / rivalry);
            (high.z + part * (low.z - high.z), None)
        } else {
            (high.z, Some(high.yaw))
        }
    }
}

/// The two highest peaks of Y within `range`.
#[inline(always)]
fn peaks<S: TorqueLimit>(search: &mut [Search<'_, S>], [low, high]: [f32; 2]) -> Peaks {
    let (mut yaw, mut slope) = (0.0, 0.0);
    let mut ahead = [Ahead {
        knots: &[],
        z: f32::MAX,
        bend: 0.0,
        from: 0.0,
        per_along: 0.0,
    }; MOST_UNITS];
    for (ahead, state) in ahead.iter_mut().zip(search.iter()) {
        rolled();
        let (f, knots) = (state.thrust(low), state.side.knots());
        let (torque, by_thrust) = state.side.tangent(f);
        (yaw, slope) = (yaw + torque, slope + by_thrust * state.along);
        if state.along == 0.0 {
            continue;
        }
        let passed = knots.iter().take_while(|knot| knot.thrust_n <= f).count();
        let (below, above) = knots.split_at_checked(passed).unwrap_or_default();
        ahead.knots = if state.along > 0.0 { above } else { below };
        (ahead.from, ahead.per_along) = (state.from, 1.0 / state.along);
        ahead.advance();
    }
    let mut here = Point { z: low, yaw };
    let mut peaks = Peaks {
        first: here,
        second: None,
        valley: f32::MAX,
        since: f32::MAX,
    };
    let mut is_any = slope <= 0.0;
    // The end of the range counts as a knot after which Y falls.
    loop {
        rolled();
        let mut next = &mut Ahead {
            knots: &[],
            z: high,
            bend: f32::MIN,
            from: 0.0,
            per_along: 0.0,
        };
        for ahead in &mut ahead {
            rolled();
            if ahead.z < next.z {
                next = ahead;
            }
        }
        let is_last = next.bend == f32::MIN;
        if slope > 0.0 {
            // The way up starts in a valley.
            peaks.since = if here.yaw < peaks.since {
                here.yaw
            } else {
                peaks.since
            };
        }
        let step = if next.z > here.z { next.z - here.z } else { 0.0 };
        here = Point {
            z: here.z + step,
            yaw: here.yaw + slope * step,
        };
        let after = if is_last {
            -1.0
        } else {
            slope + next.bend / next.per_along.abs()
        };
        if slope > 0.0 && after <= 0.0 {
            if is_any {
                peaks.add(here);
            } else {
                (peaks.first, peaks.since) = (here, f32::MAX);
                is_any = true;
            }
        }
        if is_last {
            return peaks;
        }
        slope = after;
        next.advance();
    }
}

/// Moves z from a point of the way, with its reach below `wanted`, towards the highest peak within `range` until yaw reaches
/// `wanted`. Returns z and the reach there, and leaves the limits.
#[inline(always)]
pub(super) fn climb<S: TorqueLimit>(
    search: &mut [Search<'_, S>],
    (mut z, mut here): (f32, f32),
    range: [f32; 2],
    wanted: f32,
    rounding: f32,
) -> (f32, f32) {
    let (top_z, top) = peaks(search, range).choice(RIVALRY * rounding);
    let top = match top {
        Some(yaw) => yaw,
        None => reach(search, top_z),
    };
    // Exact where Y is concave, beyond where it is not.
    let mut ahead = 1.0;
    for _ in 0..black_box(STEPS) {
        let mut part = ahead * (wanted - here) / (top - here);
        part = if part < 1.0 { part } else { 1.0 };
        // Between two peaks there may be less than here.
        part = if here < top { part } else { 0.0 };
        z += part * (top_z - z);
        here = reach(search, z);
        if here >= wanted {
            break;
        }
        ahead = 2.0;
    }
    (z, here)
}
