//! What a unit keeps while its efforts are being found.

use core::num::NonZeroU8;

use crate::attainable::Point;
use crate::chord::{Chord, Rotors};
use crate::linear::unknown_zero;

/// What a unit keeps while the efforts are being found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scratch {
    /// `[f, Q]` at the reference voltage, N and N m; on the way c_i, scaled.
    pub(crate) efforts: [f32; 2],
    /// Those of the best end so far.
    pub(crate) best: [f32; 2],
    /// Which of its rotors work.
    pub(crate) rotors: Rotors,
    /// What stands for its attainable set where only one does.
    pub(crate) chord: Chord,
    /// Columns of B_i: rows per scaled effort.
    pub(crate) columns: [[f32; 4]; 2],
    /// p_i, scaled.
    pub(crate) point: Point,
    /// Of a unit that is held back in a hollow of its set, one more than the indices of the corners at the hollow's ends.
    pub(crate) hollow: [Option<NonZeroU8>; 2],
    /// The velocity of p_i in its own coordinates.
    pub(crate) pair: [f32; 2],
}

impl Default for Scratch {
    fn default() -> Self {
        let zero = unknown_zero();
        Scratch {
            efforts: [zero; 2],
            best: [zero; 2],
            rotors: Rotors::Both,
            chord: Chord::default(),
            columns: [[zero; 4]; 2],
            point: Point::default(),
            hollow: [None; 2],
            pair: [zero; 2],
        }
    }
}

impl Scratch {
    /// Adds what scaled `efforts` give to the rows.
    #[inline]
    pub(crate) fn add(&self, [f, q]: [f32; 2], rows: &mut [f32; 4]) {
        let [by_f, by_q] = &self.columns;
        for ((row, by_f), by_q) in rows.iter_mut().zip(by_f).zip(by_q) {
            *row += by_f * f + by_q * q;
        }
    }

    /// The rows of a direction of the scaled efforts.
    #[inline]
    pub(crate) fn effect(&self, direction: [f32; 2]) -> [f32; 4] {
        let mut rows = [0.0; 4];
        self.add(direction, &mut rows);
        rows
    }

    /// The step of p_i where the multipliers change by `multipliers`: B_i^T lambda.
    #[inline]
    pub(crate) fn step(&self, multipliers: &[f32; 4]) -> [f32; 2] {
        let [m0, m1, m2, m3] = *multipliers;
        let along = |[c0, c1, c2, c3]: &[f32; 4]| (c0 * m0 + c1 * m1) + (c2 * m2 + c3 * m3);
        [along(&self.columns[0]), along(&self.columns[1])]
    }
}
