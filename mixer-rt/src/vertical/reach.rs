//! How far yaw reaches: Y(f) = sum max(s_i Q_i) over the attainable torques.
//!
//! A unit's attainable set has two sides, Q_min(f) and Q_max(f). Where these are concave so is Y along any straight way of
//! thrusts. They are then two arcs each that meet in a corner: the images of the four edges of the throttle box. Else they
//! are polylines: vertical/polyline.rs.

use core::hint::black_box;

use super::{Knot, Search};
use crate::Scalar;

/// One side of the attainable set: the largest torque in one direction at every thrust.
pub trait TorqueLimit {
    /// The torque at the thrust `f`, and its derivative.
    fn tangent(&self, f: f32) -> (f32, f32);

    /// Where the derivative changes, if it does so only at knots; none where the torque is a concave function.
    fn knots(&self) -> &[Knot];
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
}

impl Arc {
    /// The torque at the thrust `f` and its derivative.
    #[inline(always)]
    pub(super) fn tangent(&self, f: f32) -> (f32, f32) {
        let root = (f + self.shift).root();
        (
            (self.offset + self.slope * f) + self.bend * root,
            self.slope + 0.5 * self.bend / root,
        )
    }
}

/// A concave side.
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
        arc.tangent(f)
    }

    #[inline(always)]
    fn knots(&self) -> &[Knot] {
        &[]
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
        largest.knots().is_empty() && least.knots().is_empty()
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

    /// The least torque of a unit with `turn` in the direction looked at if it is above `p`.
    #[inline(always)]
    pub(super) fn least_above(&self, turn: f32, f: f32, p: f32) -> Option<f32> {
        let [offset, slope] = self.chord;
        if p >= turn * (offset + slope * f) {
            return None;
        }
        let least = -self.side(-turn).tangent(f).0;
        (least > p).then_some(least)
    }
}

/// How far yaw reaches at a point of the units' way, and its derivative along the way.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    pub(super) yaw: f32,
    pub(super) by_z: f32,
}

/// Steps of the search for the largest yaw: the tangents of a function of nearly straight pieces meet at its top.
const TOP_STEPS: u32 = 3;
/// Steps of the retreat from a corner, each from the inside.
const RETREAT_STEPS: u32 = 2;
/// The same where yaw's reach is not concave.
const LONG_RETREAT_STEPS: u32 = 5;

/// How far yaw reaches at `z` along the units' way; leaves the limits there.
#[inline(never)]
pub(super) fn reach<S: TorqueLimit>(search: &mut [Search<'_, S>], z: f32) -> Reach {
    let mut reach = Reach { yaw: 0.0, by_z: 0.0 };
    for state in search {
        let f = state.thrust(z);
        let (torque, slope) = state.side.tangent(f);
        state.limit = torque;
        reach.yaw += torque;
        reach.by_z += slope * state.along;
    }
    reach
}

/// z within `range` and the yaw reached there, about the largest; the search starts at a z with its reach.
#[inline(always)]
pub(super) fn top<S: TorqueLimit>(
    search: &mut [Search<'_, S>],
    (start, here): (f32, Reach),
    range: [f32; 2],
) -> (f32, f32) {
    let end = if here.by_z > 0.0 { range[1] } else { range[0] };
    let (mut near, mut near_z) = (here, start);
    let (mut far, mut far_z) = (reach(search, end), end);
    let mut best = if far.yaw > near.yaw {
        (far_z, far.yaw)
    } else {
        (near_z, near.yaw)
    };
    for _ in 0..black_box(TOP_STEPS) {
        let turn = near.by_z - far.by_z;
        // Still rising at the far end, or no turn to be seen.
        if turn == 0.0 || (far.by_z > 0.0) == (here.by_z > 0.0) {
            break;
        }
        let z = ((far.yaw - near.yaw) + (near.by_z * near_z - far.by_z * far_z)) / turn;
        let middle = reach(search, z);
        if middle.yaw > best.1 {
            best = (z, middle.yaw);
        }
        if (middle.by_z > 0.0) == (here.by_z > 0.0) {
            (near, near_z) = (middle, z);
        } else {
            (far, far_z) = (middle, z);
        }
    }
    best
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
    let mut inside = reach(search, 0.0).yaw - needed;
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
        reached = reach(search, at).yaw;
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
