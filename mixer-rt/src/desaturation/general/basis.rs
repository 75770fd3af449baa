//! The basis of the dual simplex method: what its four slots hold, and the inverse of their columns.

use super::variable::dot;
use crate::desaturation::attainable::Corner;
use crate::quotient;

/// Slots within this distance of their bounds are left alone: of an edge's length, or of a row.
pub(super) const TOLERANCE: f32 = 3e-5;

/// The least pivot that is divided by.
const LEAST_PIVOT: f32 = 1e-7;

/// No bound.
const FAR: f32 = 1e30;

const IDENTITY: [[f32; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// The kinds of unknowns that a slot of the basis holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Holds {
    /// The amount by which a row is missed.
    Row,
    /// The share of the edge on which a unit is.
    Edge,
    /// The share of a segment.
    Along,
    /// The two efforts of a unit that is free in its polygon.
    Thrust,
    Torque,
}

/// A slot of the basis: its value is between 0 and `high`.
#[derive(Clone, Copy)]
pub(super) struct Slot {
    pub(super) high: f32,
    /// The bits of the largest value that is left alone. Those of negative values are larger.
    pub(super) limit: u32,
    pub(super) holds: Holds,
    /// Index of the row, the unit or the segment.
    pub(super) of: u8,
}

impl Slot {
    #[inline(always)]
    pub(super) const fn new(high: f32, holds: Holds, of: u8) -> Self {
        Slot {
            high,
            limit: (high + TOLERANCE).to_bits(),
            holds,
            of,
        }
    }

    /// The amount by which a row is missed, without a bound.
    #[inline(always)]
    pub(super) const fn missed(row: u8) -> Self {
        Slot::new(FAR, Holds::Row, row)
    }

    /// An effort of a free unit: all its bounds are those of the polygon.
    #[inline(always)]
    pub(super) const fn effort(holds: Holds, of: u8) -> Self {
        Slot {
            high: FAR,
            limit: u32::MAX,
            holds,
            of,
        }
    }
}

/// The four slots, and the rows of the inverse of their columns.
pub(super) struct Basis {
    pub(super) slots: [Slot; 4],
    pub(super) inverse: [[f32; 4]; 4],
    /// Some unit has two slots.
    pub(super) has_free: bool,
}

impl Basis {
    /// All rows have to be served.
    #[inline(always)]
    pub(super) fn artificial() -> Self {
        Basis {
            slots: [0, 1, 2, 3].map(|row| Slot::new(0.0, Holds::Row, row)),
            inverse: IDENTITY,
            has_free: false,
        }
    }

    /// Puts a segment into a slot whose row of the inverse is `row`.
    #[inline(always)]
    pub(super) fn hold(&mut self, slot: usize, segment: usize, row: [f32; 4]) {
        self.slots[slot & 3] = Slot::new(1.0, Holds::Along, segment as u8);
        self.inverse[slot & 3] = row;
    }

    /// Lets a row be missed upwards or downwards.
    #[inline(always)]
    pub(super) fn miss(&mut self, row: usize, sign: f32) {
        self.slots[row & 3] = Slot::missed(row as u8);
        self.inverse[row & 3][row & 3] = sign;
    }

    /// Sets a row of the inverse.
    #[inline(always)]
    pub(super) fn row(&mut self, slot: usize) -> &mut [f32; 4] {
        &mut self.inverse[slot & 3]
    }

    #[inline(never)]
    pub(super) fn slot_of(&self, holds: Holds, of: u8) -> usize {
        let found = self
            .slots
            .iter()
            .position(|slot| slot.holds == holds && slot.of == of);
        found.unwrap_or(0) & 3
    }

    /// The row of the inverse for how far a free unit is beyond an edge.
    #[inline(always)]
    pub(super) fn across(&self, corner: &Corner, thrust: usize, torque: usize) -> [f32; 4] {
        let (thrust, torque) = (&self.inverse[thrust & 3], &self.inverse[torque & 3]);
        [0, 1, 2, 3].map(|k| corner.outward([thrust[k], torque[k]]))
    }

    /// Changes the coordinates of two slots: place along an edge and distance from it, thrust and
    /// torque.
    #[inline(never)]
    pub(super) fn turn(&mut self, first: usize, second: usize, [e0, e1]: [f32; 2]) {
        for k in 0..4 {
            let (x, y) = (self.inverse[first & 3][k & 3], self.inverse[second & 3][k & 3]);
            self.inverse[first & 3][k & 3] = e0 * x + e1 * y;
            self.inverse[second & 3][k & 3] = e1 * x - e0 * y;
        }
    }

    /// Puts a column into a slot: a rank-1 update of the inverse.
    #[inline(always)]
    pub(super) fn exchange(&mut self, slot: usize, column: &[f32; 4]) {
        let row = self.inverse[slot & 3];
        let pivot = dot(&row, column);
        let pivot = if pivot.abs() > LEAST_PIVOT {
            pivot
        } else {
            LEAST_PIVOT
        };
        let per_pivot = quotient(1.0, pivot);
        let row = row.map(|part| part * per_pivot);
        for other in &mut self.inverse {
            let share = dot(other, column);
            for (other, part) in other.iter_mut().zip(row) {
                *other -= share * part;
            }
        }
        self.inverse[slot & 3] = row;
    }
}
