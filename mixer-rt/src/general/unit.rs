//! One unit in the simplex method: where it is in its attainable polygon, and what the multipliers make of it.

use crate::attainable::Corner;
use crate::rolled;
use crate::rotors::Rotors;

/// No breakpoint: further than any dual step.
pub(super) const NEVER: f32 = 1e9;

/// Slopes below this are rounding.
const LEAST_SLOPE: f32 = 1e-6;
const LEAST_SLOPE_OF_EDGE: f32 = 1e-5;

/// Where in its polygon a unit is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Place {
    /// At a corner: no slot of the basis.
    #[default]
    Corner,
    /// On the edge that leaves its corner: one slot.
    Edge,
    /// Anywhere: two slots.
    Free,
}

/// The workspace of one unit while the general path runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scratch {
    /// Columns of B: rows per scaled thrust and per scaled torque.
    pub(super) columns: [[f32; 4]; 2],
    /// B^T lambda and a bias: what more thrust and more torque are worth.
    pub(super) gain: [f32; 2],
    /// How the gain changes per unit of the dual step.
    pub(super) rate: [f32; 2],
    /// The dual step at which the unit leaves its corner or its edge.
    pub(super) breakpoint: f32,
    pub(super) place: Place,
    /// Index of its corner.
    pub(super) corner: u8,
    /// True where it leaves its corner along the corner's own edge, false along the edge before it.
    pub(super) is_forward: bool,
    pub(crate) rotors: Rotors,
    /// Torque of a single rotor's curve beyond its chord, scaled.
    pub(super) bend: f32,
    /// `[f, Q]`: scaled while they are being found, then N and N m at the reference voltage.
    pub(crate) efforts: [f32; 2],
    /// Scaled efforts without roll, pitch and yaw.
    pub(super) level: [f32; 2],
}

impl Default for Scratch {
    fn default() -> Self {
        Scratch {
            columns: [[0.0; 4]; 2],
            gain: [0.0; 2],
            rate: [0.0; 2],
            breakpoint: NEVER,
            place: Place::Corner,
            corner: 0,
            is_forward: false,
            rotors: Rotors::Both,
            bend: 0.0,
            efforts: [0.0; 2],
            level: [0.0; 2],
        }
    }
}

/// The corner of this index; the origin beyond the last.
#[inline(always)]
pub(super) fn corner(set: &[Corner], index: u8) -> &Corner {
    const ORIGIN: &Corner = &Corner {
        at: [0.0; 2],
        edge: [0.0; 2],
        before: [0.0; 2],
        bound: 0.0,
    };
    set.get(usize::from(index)).unwrap_or(ORIGIN)
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
fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

impl Scratch {
    /// The efforts `[f, Q]` that were found, N and N m at the reference voltage.
    pub fn efforts(&self) -> [f32; 2] {
        self.efforts
    }

    /// The index of its corner, or of the edge on which it is.
    pub fn corner(&self) -> u8 {
        self.corner
    }

    /// Takes what `efforts` give from `rows`.
    #[inline(always)]
    pub(super) fn subtract(&self, [f, q]: [f32; 2], rows: &mut [f32; 4]) {
        let [by_f, by_q] = &self.columns;
        for ((row, by_f), by_q) in rows.iter_mut().zip(by_f).zip(by_q) {
            rolled();
            *row -= by_f * f + by_q * q;
        }
    }

    /// B^T times rows.
    #[inline(always)]
    pub(super) fn transposed(&self, [r0, r1, r2, r3]: &[f32; 4]) -> [f32; 2] {
        let along = |[c0, c1, c2, c3]: &[f32; 4]| (c0 * r0 + c1 * r1) + (c2 * r2 + c3 * r3);
        [along(&self.columns[0]), along(&self.columns[1])]
    }

    /// Moves to the corner with the largest gain.
    pub(super) fn choose_corner(&mut self, set: &[Corner]) {
        let mut best = f32::MIN;
        for (index, corner) in (0u8..).zip(set) {
            rolled();
            let gain = dot(self.gain, corner.at);
            if gain > best {
                best = gain;
                self.corner = index;
            }
        }
    }

    /// Takes the last dual step and finds the breakpoint in the direction with this rate.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self, set: &[Corner], last_step: f32, rate: [f32; 2]) {
        let gain = [0, 1].map(|k| self.gain[k] + last_step * self.rate[k]);
        (self.gain, self.rate) = (gain, rate);
        self.breakpoint = NEVER;
        match self.place {
            Place::Free => {}
            Place::Edge => {
                let corner = corner(set, self.corner);
                let slope = -corner.outward(rate);
                if set.len() > 2 && slope > LEAST_SLOPE_OF_EDGE {
                    self.breakpoint = positive(corner.outward(gain)) / slope;
                }
            }
            Place::Corner if set.len() > 1 => {
                let &Corner {
                    edge: ahead,
                    before: behind,
                    ..
                } = corner(set, self.corner);
                let slope = dot(ahead, rate);
                if slope > LEAST_SLOPE {
                    self.breakpoint = positive(-dot(ahead, gain)) / slope;
                    self.is_forward = true;
                }
                let slope = -dot(behind, rate);
                if slope > LEAST_SLOPE {
                    let breakpoint = positive(dot(behind, gain)) / slope;
                    if breakpoint < self.breakpoint {
                        self.breakpoint = breakpoint;
                        self.is_forward = false;
                    }
                }
            }
            Place::Corner => {}
        }
    }

    /// The edge along which it leaves its corner: its index and its direction from here.
    #[inline(always)]
    pub(super) fn way(&self, set: &[Corner]) -> (u8, [f32; 2]) {
        if self.is_forward {
            (self.corner, corner(set, self.corner).edge)
        } else {
            let behind = corner(set, self.corner).before;
            (before(set, self.corner), behind.map(|part| -part))
        }
    }

    /// Moves on to the corner at the end of its way, with the breakpoint after `step` there.
    #[inline(always)]
    pub(super) fn flip(&mut self, set: &[Corner], step: f32) {
        self.corner = if self.is_forward {
            next(set, self.corner)
        } else {
            before(set, self.corner)
        };
        let (_, way) = self.way(set);
        let slope = dot(way, self.rate);
        self.breakpoint = NEVER;
        if slope > LEAST_SLOPE {
            let breakpoint = -dot(way, self.gain) / slope;
            self.breakpoint = if breakpoint > step { breakpoint } else { step };
        }
    }
}

#[inline(always)]
pub(super) fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}
