//! How far yaw reaches: Y(f) = sum max(s_i Q_i) over the attainable torques.
//!
//! A unit's attainable set has two sides, Q_min(f) and Q_max(f). Where these are concave so is Y along any straight way of
//! thrusts. They are then two arcs each that meet in a corner: the images of the four edges of the throttle box. An arc may
//! bend a little the other way: to find the top of Y its chord then says how steep it is. Other sides are polylines:
//! vertical/polyline.rs.

use core::hint::black_box;

use super::{Knot, MOST_UNITS, Search};
use crate::rolled;
use crate::{Scalar, sqrt};

/// One side of the attainable set: the largest torque in one direction at every thrust.
pub trait TorqueLimit {
    /// The torque at the thrust `f`, and how steep it is there: its derivative, or the slope of an arc's chord where the arc
    /// is convex, whose own slope would cut off what lies beyond.
    fn tangent(&self, f: f32) -> (f32, f32);

    /// Where the derivative changes, if it does so only at knots; none where the torque is a concave function.
    fn knots(&self) -> &[Knot];

    /// The thrust (N) at the corner of a side that is two arcs, which then is concave or taken for it.
    fn corner_n(&self) -> Option<f32>;
}

/// `offset + slope f + bend sqrt(f + shift)`: the image of one edge of the throttle box. Exact for the
/// biquadratic basis, on whose edges f and Q are both quadratic in one throttle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// N m.
    pub offset: f32,
    /// N m per N.
    pub slope: f32,
    /// N m per square root of N.
    pub bend: f32,
    /// N.
    pub shift: f32,
    /// How steep it is: never steeper at a larger thrust.
    pub steepness: Steepness,
}

impl Arc {
    /// The torque at the thrust `f`.
    #[inline(always)]
    fn torque(&self, f: f32) -> f32 {
        (self.offset + self.slope * f) + self.bend * (f + self.shift).root()
    }
}

/// `slope + bend / sqrt(f + shift)`: the derivative of an [`Arc`], or the slope of its chord where it is convex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steepness {
    /// N m per N.
    pub slope: f32,
    /// N m per square root of N: half the arc's, or 0.
    pub bend: f32,
    /// N.
    pub shift: f32,
}

impl Steepness {
    #[inline(always)]
    fn at(&self, f: f32) -> f32 {
        self.slope + self.bend / (f + self.shift).root()
    }
}

/// A side that is concave, or so nearly that it may be taken for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The thrust at the corner, N.
    pub corner_n: f32,
    /// The arcs below and above it.
    pub arcs: [Arc; 2],
}

impl TorqueLimit for Side {
    #[inline(always)]
    fn tangent(&self, f: f32) -> (f32, f32) {
        let [below, above] = &self.arcs;
        let arc = if f < self.corner_n { below } else { above };
        (arc.torque(f), arc.steepness.at(f))
    }

    #[inline(always)]
    fn knots(&self) -> &[Knot] {
        &[]
    }

    #[inline(always)]
    fn corner_n(&self) -> Option<f32> {
        Some(self.corner_n)
    }
}

/// The border of a unit's attainable set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border<S = Side> {
    /// Q_max(f), and -Q_min(f).
    pub sides: [S; 2],
    /// Offset (N m) and slope (N m per N) of a line between the two sides.
    pub chord: [f32; 2],
    /// Offsets (N) and slopes (N per N m) of lines in the plane of (Q, f): a thrust that is at least the first two and
    /// at most the last two is attainable with the torque.
    pub quadrangle: [[f32; 2]; 4],
}

impl<S: TorqueLimit> Border<S> {
    /// True where yaw's reach is a concave function along any straight way of thrusts.
    #[inline(always)]
    pub(crate) fn is_concave(&self) -> bool {
        let [largest, least] = &self.sides;
        largest.corner_n().is_some() && least.corner_n().is_some()
    }

    /// The side in which a unit with `turn`, the yaw per torque in the direction looked at, gives most.
    #[inline(always)]
    pub(super) fn side(&self, turn: f32) -> &S {
        let [largest, least] = &self.sides;
        if turn < 0.0 { least } else { largest }
    }

    /// Least and largest of the thrusts that are known to be attainable with the torque `q`: most of them, without a
    /// root.
    #[inline(always)]
    pub(super) fn thrusts_at(&self, q: f32) -> [f32; 2] {
        let [a, b, c, d] = self.quadrangle.map(|[offset, slope]| offset + slope * q);
        [if a > b { a } else { b }, if c < d { c } else { d }]
    }

    /// The least torque of a unit with `turn` in the direction looked at if it is above `p`. The `chord` is the border's.
    #[inline(always)]
    pub(super) fn least_above(&self, [offset, slope]: [f32; 2], turn: f32, f: f32, p: f32) -> Option<f32> {
        if p >= turn * (offset + slope * f) {
            return None;
        }
        let least = -self.side(-turn).tangent(f).0;
        (least > p).then_some(least)
    }
}

/// Distance from a kink at which the growth to one side of it is taken, as a share of the range.
const ASIDE: f32 = 2e-5;
/// Steps of the retreat from a corner, each from the inside.
const RETREAT_STEPS: u32 = 2;
/// The same where yaw's reach is not concave.
const LONG_RETREAT_STEPS: u32 = 5;

/// How far yaw reaches at `z` along the units' way; leaves the limits there.
#[inline(never)]
pub(super) fn reach<S: TorqueLimit>(search: &mut [Search<'_, S>], z: f32) -> f32 {
    let mut yaw = 0.0;
    for state in search {
        state.limit = state.side.tangent(state.thrust(z)).0;
        yaw += state.limit;
    }
    yaw
}

/// By how much yaw's reach grows with z, where it is concave.
#[inline(never)]
fn growth<S: TorqueLimit>(search: &[Search<'_, S>], z: f32) -> f32 {
    let mut growth = 0.0;
    for state in search {
        growth += state.side.tangent(state.thrust(z)).1 * state.along;
    }
    growth
}

/// z within the range where yaw reaches about furthest, seen from `start`.
///
/// There its growth changes sign: at a kink, where a unit is at its corner, or between two kinks, where the growth is
/// continuous. So z is a continuous function of the units' way, as the best of some samples is not.
#[inline(always)]
pub(super) fn top<S: TorqueLimit>(search: &[Search<'_, S>], start: f32, [low, high]: [f32; 2]) -> f32 {
    let mut kinks = [low; MOST_UNITS];
    for (kink, state) in kinks.iter_mut().zip(search) {
        rolled();
        if let Some(corner_n) = state.side.corner_n() {
            *kink = (corner_n - state.from) / state.along;
        }
    }
    let [a, b, c, d] = kinks;
    let ([a, b], [c, d]) = (ordered([a, b]), ordered([c, d]));
    let ([a, c], [b, d]) = (ordered([a, c]), ordered([b, d]));
    let [b, c] = ordered([b, c]);
    // The start among them: the two largest may be in any order.
    let [a, e] = ordered([a, start]);
    let [b, e] = ordered([b, e]);
    let [c, e] = ordered([c, e]);
    let mut bracket = Bracket {
        near: low,
        grows: 0.0,
        far: high,
        aside: ASIDE * (high - low),
    };
    // In this order three growths tell at most, with that at the near end.
    bracket.split(search, c);
    let others = if c <= bracket.near { [e, d] } else { [a, b] };
    for kink in others {
        bracket.split(search, kink);
    }
    let Bracket {
        near, mut grows, far, ..
    } = bracket;
    if near == low {
        grows = growth(search, low);
        if !(grows > 0.0 && far > low) {
            return low;
        }
    }
    let falls = growth(search, far);
    if falls < 0.0 {
        // Ridders' method: with the growth in the middle it finds the zero of any line times an exponential function.
        let middle = 0.5 * (near + far);
        let growth = growth(search, middle);
        middle + (far - middle) * (growth / sqrt(growth * growth - grows * falls))
    } else {
        // It grows up to the far point.
        far
    }
}

/// Yaw's reach grows after the near point, by `grows`; after the far one it does not.
struct Bracket {
    near: f32,
    grows: f32,
    far: f32,
    /// To the side of a kink, of several at once, too.
    aside: f32,
}

impl Bracket {
    /// Ends at the kink if it is within.
    #[inline(always)]
    fn split<S: TorqueLimit>(&mut self, search: &[Search<'_, S>], kink: f32) {
        if kink > self.near && kink < self.far {
            let after = growth(search, kink + self.aside);
            if after > 0.0 {
                (self.near, self.grows) = (kink + self.aside, after);
            } else {
                self.far = kink - self.aside;
            }
        }
    }
}

/// The smaller first.
#[inline(always)]
fn ordered([a, b]: [f32; 2]) -> [f32; 2] {
    if a > b { [b, a] } else { [a, b] }
}

/// Where, seen from the start of the units' way, yaw last reaches `needed`, from the inside; it reaches `reached` at 1.
/// Returns how far it reaches there, and leaves the limits.
#[inline(always)]
pub(super) fn reach_from_inside<S: TorqueLimit>(
    search: &mut [Search<'_, S>],
    mut reached: f32,
    needed: f32,
    is_concave: bool,
) -> (f32, f32) {
    let mut outside = reached - needed;
    let mut inside = reach(search, 0.0) - needed;
    // Where yaw's reach is concave on the way, a straight line between a point inside and one outside crosses zero
    // inside. Else it may do so outside, by less and less: a point inside that stays counts half (Illinois).
    let (mut inside_at, mut outside_at, mut at) = (0.0, 1.0, 0.0);
    let steps = if is_concave {
        RETREAT_STEPS
    } else {
        LONG_RETREAT_STEPS
    };
    for _ in 0..black_box(steps) {
        let inner = if inside > 0.0 { inside } else { 0.0 };
        at = inside_at + inner / (inner - outside) * (outside_at - inside_at);
        reached = reach(search, at);
        if reached >= needed {
            (inside, inside_at) = (reached - needed, at);
        } else {
            (outside, outside_at) = (reached - needed, at);
            if !is_concave {
                inside *= 0.5;
            }
        }
    }
    (reached, at)
}
