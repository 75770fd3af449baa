//! What the programme decides: the efforts of units, and the shortages.

use core::hint::black_box;

use crate::desaturation::attainable::{AttainableSet, CORNERS, Corner};
use crate::pair::rotors::Rotors;
use crate::{divisor, rolled};

/// No breakpoint: further than any dual step.
pub(super) const NEVER: f32 = 1e9;

/// Slopes below these are rounding.
const LEAST_SLOPE: f32 = 1e-6;
const LEAST_SLOPE_OF_EDGE: f32 = 1e-5;

/// What a unit attains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Set {
    /// With both rotors.
    Polygon,
    /// With one: the chord of its curve, or a line beside it.
    Segment,
    /// With none, or with one whose throttle is decided.
    Point,
}

/// Where in its set a unit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Position {
    /// At a corner: no slot of the basis.
    Corner,
    /// On the edge that leaves its corner: one slot.
    Edge,
    /// It has no way whose gain could turn: free in its polygon with two slots, on its segment with
    /// one, or a point.
    Free,
}

/// The workspace of one unit while the general path runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// B^T lambda plus the bias: gain of the objective per unit of each effort.
    pub(super) gain: [f32; 2],
    /// How the gain changes per unit of the dual step; outside the programme, where the unit moves.
    pub(crate) rate: [f32; 2],
    /// `[f, Q]`, scaled; after [`allocate`](super::allocate) N and N m at the reference voltage.
    pub(crate) at: [f32; 2],
    /// The dual step at which the unit leaves its corner or its edge.
    pub(super) breakpoint: f32,
    /// How far the line of a single rotor is beside its chord: a scaled torque.
    pub(super) curve: f32,
    /// By how much it has moved last.
    moved: f32,
    /// Of a single rotor, where the unit is on its curve.
    pub(crate) throttle: f32,
    pub(super) set: Set,
    pub(super) position: Position,
    /// Index of its corner.
    pub(super) corner: u8,
    /// Index of the corner's way along which it leaves.
    pub(super) way: u8,
    pub(crate) rotors: Rotors,
}

impl Default for Variable {
    #[inline(always)]
    fn default() -> Self {
        static START: Variable = Variable {
            gain: [0.0; 2],
            rate: [0.0; 2],
            at: [0.0; 2],
            breakpoint: 0.0,
            curve: 0.0,
            moved: 0.0,
            throttle: 0.0,
            set: Set::Polygon,
            position: Position::Corner,
            corner: 0,
            way: 0,
            rotors: Rotors::Both,
        };
        // Known zeros would be written by a call of memset, which a bare-metal target may not have.
        *black_box(&START)
    }
}

/// A shortage, or the ray: a share in [0, 1] of its column, counted from the end where it is.
#[derive(Clone, Copy, Default)]
pub(super) struct Segment {
    /// Rows from that end to the other.
    pub(super) column: [f32; 4],
    pub(super) gain: f32,
    pub(super) rate: f32,
    pub(super) breakpoint: f32,
    pub(super) is_basic: bool,
    /// True where it is counted from 1.
    pub(super) is_turned: bool,
}

impl Segment {
    /// From nothing, at this gain.
    #[inline(always)]
    pub(super) fn new(column: [f32; 4], gain: f32) -> Self {
        Segment {
            column,
            gain,
            ..Segment::default()
        }
    }

    /// Goes to its other end, and counts from there.
    #[inline(never)]
    pub(super) fn turn(&mut self, residual: &mut [f32; 4]) {
        for (row, part) in residual.iter_mut().zip(&mut self.column) {
            *row -= *part;
            *part = -*part;
        }
        (self.gain, self.rate) = (-self.gain, -self.rate);
        self.is_turned = !self.is_turned;
    }

    /// The share that is at `value` from the end it is counted from.
    #[inline(always)]
    pub(super) fn share(&self, value: f32) -> f32 {
        if self.is_turned { 1.0 - value } else { value }
    }

    /// Takes the last dual step, and finds the breakpoint in a direction of lambda.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, last_step: f32, direction: &[f32; 4]) -> f32 {
        self.breakpoint = NEVER;
        if !self.is_basic {
            self.gain += last_step * self.rate;
            self.rate = dot(&self.column, direction);
            if self.rate > LEAST_SLOPE {
                self.breakpoint = -self.gain / divisor(self.rate);
            }
        }
        self.breakpoint
    }
}

#[inline(always)]
pub(super) fn dot2(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
pub(super) fn dot(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// `from` and a share of the way from there to `to`.
#[inline(always)]
pub(super) fn between(from: [f32; 2], to: [f32; 2], share: f32) -> [f32; 2] {
    [0, 1].map(|k| from[k] + share * (to[k] - from[k]))
}

#[inline(always)]
pub(super) fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// The corner of this index.
#[inline(always)]
pub(super) fn corner(corners: &[Corner; CORNERS], index: u8) -> &Corner {
    &corners[usize::from(index) & (CORNERS - 1)]
}

impl Variable {
    /// Takes the set that the rotors leave, without a curve.
    #[inline(always)]
    pub(super) fn reset(&mut self) {
        self.set = match self.rotors {
            Rotors::Both => Set::Polygon,
            Rotors::Upper | Rotors::Lower => Set::Segment,
            Rotors::None => Set::Point,
        };
        (self.at, self.curve, self.moved) = ([0.0; 2], 0.0, 0.0);
    }

    /// A single rotor stays at its throttle.
    #[inline(always)]
    pub(super) fn decide(&mut self) {
        if self.set == Set::Segment {
            self.set = Set::Point;
        }
    }

    /// By how much the line of a single rotor moves that is `beside` its curve: half as far where it
    /// goes to and fro.
    #[inline(always)]
    pub(super) fn next_move(&mut self, beside: f32) -> f32 {
        let is_back = beside * self.moved < 0.0;
        self.moved = if is_back { 0.5 * beside } else { beside };
        self.moved
    }

    /// A point inside its set, on its chord where it has one.
    #[inline(always)]
    pub(super) fn inside(&self, set: &AttainableSet<'_>) -> [f32; 2] {
        match self.set {
            Set::Polygon => set.centre,
            Set::Segment => {
                let least = self.first_corner();
                let [low, high] = [least, least + 1].map(|end| corner(set.corners, end).at);
                between(low, high, 0.5)
            }
            Set::Point => self.at,
        }
    }

    /// Index of the first corner of its set.
    #[inline(always)]
    fn first_corner(&self) -> u8 {
        match self.rotors {
            Rotors::Upper => AttainableSet::UPPER,
            Rotors::Lower => AttainableSet::LOWER,
            _ => 0,
        }
    }

    /// Goes to the corner with the largest gain, or stays where it is as a point; returns where that
    /// is. Uphill from one corner of the polygon or another, so that few steps are taken.
    #[inline(always)]
    pub(super) fn choose_corner(&mut self, set: &AttainableSet<'_>) -> [f32; 2] {
        if self.set == Set::Point {
            self.position = Position::Free;
            return self.at;
        }
        self.position = Position::Corner;
        let mut index = self.first_corner();
        if self.set == Set::Polygon && self.gain[0] > 0.0 {
            index = set.count / 2;
        }
        let mut best = corner(set.corners, index);
        let [forward, back] = best.ways.map(|way| dot2(way, self.gain));
        let way = usize::from(back > forward);
        for _ in 0..black_box(set.count) {
            rolled();
            if dot2(best.ways[way], self.gain) <= 0.0 {
                break;
            }
            index = best.links[way];
            best = corner(set.corners, index);
        }
        self.corner = index;
        [best.at[0], best.at[1] + self.curve]
    }

    /// Takes the last dual step, and finds the breakpoint where the gain changes by `rate` per unit
    /// of the next one. By rounding it may be just below zero.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, corners: &[Corner; CORNERS], last_step: f32, rate: [f32; 2]) -> f32 {
        let gain = [0, 1].map(|k| self.gain[k] + last_step * self.rate[k]);
        (self.gain, self.rate) = (gain, rate);
        let corner = corner(corners, self.corner);
        let mut breakpoint = NEVER;
        if self.position == Position::Corner {
            // The gain turns towards its rate: anticlockwise it meets the corner's own edge.
            let way = usize::from(gain[0] * rate[1] <= gain[1] * rate[0]);
            self.way = way as u8;
            breakpoint = turning(corner.ways[way & 1], gain, rate);
        } else {
            let slope = -corner.outward(rate);
            if slope > LEAST_SLOPE_OF_EDGE {
                breakpoint = corner.outward(gain) / divisor(slope);
            }
        }
        breakpoint
    }

    /// The way along which it leaves its corner, and the corner there.
    #[inline(always)]
    pub(super) fn way(&self, corners: &[Corner; CORNERS]) -> ([f32; 2], u8) {
        let corner = corner(corners, self.corner);
        let way = usize::from(self.way & 1);
        (corner.ways[way], corner.links[way])
    }

    /// Goes on to the corner at the end of its way, and finds the breakpoint there, which is `step`
    /// or after it.
    #[inline(always)]
    pub(super) fn flip(&mut self, corners: &[Corner; CORNERS], step: f32) -> f32 {
        (_, self.corner) = self.way(corners);
        let (way, _) = self.way(corners);
        let breakpoint = turning(way, self.gain, self.rate);
        self.breakpoint = if breakpoint > step { breakpoint } else { step };
        self.breakpoint
    }
}

/// The dual step at which the gain along `way` turns positive.
#[inline(always)]
fn turning(way: [f32; 2], gain: [f32; 2], rate: [f32; 2]) -> f32 {
    let slope = dot2(way, rate);
    if slope > LEAST_SLOPE {
        -dot2(way, gain) / divisor(slope)
    } else {
        NEVER
    }
}
