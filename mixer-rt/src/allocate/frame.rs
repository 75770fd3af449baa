//! A frame under one set of conditions.

use super::system::Columns;
use crate::layout::{Tables, Unit};

/// A frame under one set of conditions, `VERTICAL` where all axes are.
pub(super) struct Frame<'a, 't, K, S, const VERTICAL: bool> {
    pub(super) tables: &'a Tables<'t, K, S>,
    /// `[k_f, k_Q]`.
    pub(super) factors: [f32; 2],
    /// `[1 / k_f, 1 / k_Q]`.
    pub(super) per_factor: [f32; 2],
    /// k_Q / k_f: rows are those of thrusts and torques over k_f.
    pub(super) ratio: f32,
}

impl<'a, 't, K, S, const VERTICAL: bool> Frame<'a, 't, K, S, VERTICAL> {
    #[inline(always)]
    pub(super) fn new(tables: &'a Tables<'t, K, S>, factors: [f32; 2]) -> Self {
        let per_product = 1.0 / (factors[0] * factors[1]);
        let per_factor = [factors[1] * per_product, factors[0] * per_product];
        Frame {
            tables,
            factors,
            per_factor,
            ratio: factors[1] * per_factor[0],
        }
    }

    /// From idle to the ceiling.
    #[inline(always)]
    pub(super) fn span(&self) -> f32 {
        self.tables.throttle.max - self.tables.throttle.min
    }

    /// A unit's columns in the rows of the axes.
    #[inline(always)]
    pub(super) fn columns(&self, unit: &Unit) -> Columns {
        let [mut by_thrust, mut by_torque] = unit.effectiveness;
        for ((thrust, torque), row) in by_thrust
            .iter_mut()
            .zip(&mut by_torque)
            .zip(self.tables.row_scale)
        {
            *thrust *= row;
            *torque *= self.ratio * row;
        }
        [by_thrust, by_torque]
    }
}
