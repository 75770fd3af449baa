//! One variable of the simplex method: a unit in its attainable polygon, or a shortage on its
//! segment.
//!
//! A variable has two coordinates y in a convex set of at most eight corners, and gives the rows B
//! y. For a unit with both rotors these are its scaled thrust and torque. A unit with one rotor,
//! and a shortage, is on a segment: y = (x, 1) with x in [0, 1], where the second column of B is
//! what it gives at x = 0.

use core::hint::black_box;

use crate::desaturation::attainable::Corner;
use crate::pair::rotors::Rotors;
use crate::rolled;

/// No breakpoint: further than any dual step.
pub(super) const NEVER: f32 = 1e9;

/// Slopes below this are rounding.
const LEAST_SLOPE: f32 = 1e-6;
const LEAST_SLOPE_OF_EDGE: f32 = 1e-5;

/// The segment of a shortage or a single rotor.
const SEGMENT: [Corner; 2] = [
    Corner {
        at: [0.0, 1.0],
        edge: [1.0, 0.0],
        back: [1.0, 0.0],
        bound: 0.0,
    },
    Corner {
        at: [1.0, 1.0],
        edge: [-1.0, 0.0],
        back: [-1.0, 0.0],
        bound: 0.0,
    },
];

/// A point inside [`SEGMENT`], for [`inside`].
const MIDDLE: [f32; 2] = [0.5, 1.0];

/// The set of a unit without rotors.
const ORIGIN: [Corner; 1] = [Corner {
    at: [0.0; 2],
    edge: [0.0; 2],
    back: [0.0; 2],
    bound: 0.0,
}];

/// Where in its set a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Position {
    /// At a corner: no slot of the basis.
    Corner,
    /// On the edge that leaves its corner: one slot. A unit with both rotors only.
    Edge,
    /// Anywhere in its set: two slots, or the one of a segment. It has no gain.
    Free,
}

/// The workspace of one variable: of a unit, or of a shortage, while the general path runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// B: rows per coordinate.
    pub(super) columns: [[f32; 4]; 2],
    /// B^T lambda plus the bias: gain of the objective per unit of each coordinate.
    pub(super) gain: [f32; 2],
    /// How the gain changes per unit of the dual step. On a segment, which has no second gain, the
    /// second is the torque of a single rotor's curve beyond its chord, N m.
    pub(crate) rate: [f32; 2],
    /// The coordinates; after [`allocate`](super::allocate) `[f, Q]`, N and N m at the reference
    /// voltage.
    pub(crate) at: [f32; 2],
    /// The dual step at which the variable leaves its corner or its edge.
    pub(super) breakpoint: f32,
    pub(super) position: Position,
    /// Index of its corner.
    pub(super) corner: u8,
    /// True where it leaves its corner along the corner's own edge, false along the edge before it.
    pub(super) is_forward: bool,
    /// The rotors of a unit; of a shortage the upper one, since it has a segment.
    pub(crate) rotors: Rotors,
}

impl Default for Variable {
    #[inline(always)]
    fn default() -> Self {
        static START: Variable = Variable {
            columns: [[0.0; 4]; 2],
            gain: [0.0; 2],
            rate: [0.0; 2],
            at: [0.0; 2],
            breakpoint: 0.0,
            position: Position::Corner,
            corner: 0,
            is_forward: false,
            rotors: Rotors::Upper,
        };
        // Known zeros would be written by a call of memset, which a bare-metal target may not have.
        *black_box(&START)
    }
}

/// The corners of the set of a unit with these rotors; with both it is the polygon with `corners`.
#[inline(always)]
pub(super) fn set(corners: &[Corner], rotors: Rotors) -> &[Corner] {
    match rotors {
        Rotors::Both => corners,
        Rotors::None => &ORIGIN,
        _ => &SEGMENT,
    }
}

/// A point inside the set of a unit with these rotors; with both it is `centre`.
#[inline(always)]
pub(super) fn inside(centre: [f32; 2], rotors: Rotors) -> [f32; 2] {
    match rotors {
        Rotors::Both => centre,
        Rotors::None => [0.0; 2],
        _ => MIDDLE,
    }
}

/// The corner of this index; the origin beyond the last.
#[inline(always)]
pub(super) fn corner(set: &[Corner], index: u8) -> &Corner {
    const NONE: &Corner = &ORIGIN[0];
    set.get(usize::from(index)).unwrap_or(NONE)
}

/// The index after this one.
#[inline(always)]
pub(super) fn next(set: &[Corner], index: u8) -> u8 {
    if usize::from(index) + 1 >= set.len() {
        0
    } else {
        index + 1
    }
}

/// The index before this one.
#[inline(always)]
fn before(set: &[Corner], index: u8) -> u8 {
    if index == 0 {
        set.len() as u8 - 1
    } else {
        index - 1
    }
}

#[inline(always)]
fn dot2(a: [f32; 2], b: [f32; 2]) -> f32 {
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

/// The dual step at which the gain along `way` turns positive.
#[inline(always)]
fn turning(way: [f32; 2], gain: [f32; 2], rate: [f32; 2]) -> f32 {
    let slope = dot2(way, rate);
    if slope > LEAST_SLOPE {
        -dot2(way, gain) / slope
    } else {
        NEVER
    }
}

impl Variable {
    /// Takes what coordinates give from `rows`.
    #[inline(never)]
    pub(super) fn subtract(&self, at: [f32; 2], rows: &mut [f32; 4]) {
        self.subtract_inline(at, rows);
    }

    /// As [`subtract`](Self::subtract), for the loop that runs most often.
    #[inline(always)]
    pub(super) fn subtract_inline(&self, [y0, y1]: [f32; 2], rows: &mut [f32; 4]) {
        let [first, second] = &self.columns;
        for ((row, first), second) in rows.iter_mut().zip(first).zip(second) {
            *row -= first * y0 + second * y1;
        }
    }

    /// B^T times rows.
    #[inline(always)]
    pub(super) fn transposed(&self, rows: &[f32; 4]) -> [f32; 2] {
        [dot(&self.columns[0], rows), dot(&self.columns[1], rows)]
    }

    /// Moves to the corner with the largest gain.
    pub(super) fn choose_corner(&mut self, set: &[Corner]) {
        let mut best = f32::MIN;
        for (index, corner) in (0u8..).zip(set) {
            rolled();
            let gain = dot2(self.gain, corner.at);
            if gain > best {
                best = gain;
                self.corner = index;
            }
        }
    }

    /// Takes the last dual step, and finds the breakpoint in a direction of lambda. By rounding it
    /// may be just below zero.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, corners: &[Corner], last_step: f32, direction: &[f32; 4]) {
        let mut breakpoint = NEVER;
        if self.position != Position::Free {
            let rate = dot(&self.columns[0], direction);
            let gain = self.gain[0] + last_step * self.rate[0];
            (self.gain[0], self.rate[0]) = (gain, rate);
            if self.rotors == Rotors::Both {
                let rate = [rate, dot(&self.columns[1], direction)];
                let gain = [gain, self.gain[1] + last_step * self.rate[1]];
                (self.gain[1], self.rate[1]) = (gain[1], rate[1]);
                let corner = corner(corners, self.corner);
                if self.position == Position::Edge {
                    let slope = -corner.outward(rate);
                    if slope > LEAST_SLOPE_OF_EDGE {
                        breakpoint = corner.outward(gain) / slope;
                    }
                } else {
                    // The gain turns towards its rate: anticlockwise it meets the corner's own
                    // edge.
                    self.is_forward = gain[0] * rate[1] > gain[1] * rate[0];
                    breakpoint = if self.is_forward {
                        turning(corner.edge, gain, rate)
                    } else {
                        turning(corner.back, gain, rate)
                    };
                }
            } else {
                let (gain, slope) = if self.corner == 0 {
                    (-gain, rate)
                } else {
                    (gain, -rate)
                };
                if slope > LEAST_SLOPE {
                    breakpoint = gain / slope;
                }
            }
        }
        self.breakpoint = breakpoint;
    }

    /// The edge along which it leaves its corner: its index and its direction from here.
    #[inline(always)]
    pub(super) fn way(&self, set: &[Corner]) -> (u8, [f32; 2]) {
        let corner = corner(set, self.corner);
        if self.is_forward {
            (self.corner, corner.edge)
        } else {
            (before(set, self.corner), corner.back)
        }
    }

    /// Moves on to the corner at the end of its way; returns the breakpoint there, `step` or after
    /// it.
    #[inline(always)]
    pub(super) fn flip(&mut self, set: &[Corner], step: f32) -> f32 {
        self.corner = if self.is_forward {
            next(set, self.corner)
        } else {
            before(set, self.corner)
        };
        let (_, way) = self.way(set);
        let breakpoint = turning(way, self.gain, self.rate);
        let breakpoint = if breakpoint > step { breakpoint } else { step };
        self.breakpoint = breakpoint;
        breakpoint
    }
}
