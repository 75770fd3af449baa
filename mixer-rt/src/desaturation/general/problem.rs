//! What the programme of a request is about: the sets and columns of the units, and what a row costs
//! that is missed.
//!
//! Costs per row have fixed ratios, which act as priorities and bound how steep the answer is in
//! the request:
//!
//! ```text
//! yaw beyond the reserve   1          (yaw before thrust: 20)
//! too little thrust       20          (yaw before thrust: 1)
//! roll and pitch         400
//! too much thrust       2000, where thrust may rise as too little
//! yaw within the reserve 8000
//! ```
//!
//! A higher priority is given up where that gains more of the next one than these ratios. Roll and
//! pitch are one shortage, along their request, so that their direction stays. A shortage runs from
//! nothing to all that was asked for, so that nothing is reversed. Thrust needs no such limit: its
//! row is missed at a price.

use super::variable::{Variable, dot};
use crate::desaturation::attainable::AttainableSet;
use crate::layout::{Tables, Unit};
use crate::{clamp, divisor, rolled};

/// How many shortages and rays there are.
pub(super) const SEGMENTS: usize = 4;

/// Costs per row.
pub(super) const LAST: f32 = 1.0;
pub(super) const MIDDLE: f32 = 20.0 * LAST;
pub(super) const LEVEL_TORQUE: f32 = 20.0 * MIDDLE;
pub(super) const FORBIDDEN: f32 = 5.0 * LEVEL_TORQUE;
pub(super) const RESERVED: f32 = 4.0 * FORBIDDEN;

/// Prices per row of roll, pitch and yaw that no shortage covers: an axis that is reversed or
/// exceeded. They are above all costs, so that these are given up last. They differ, so that the
/// answer is unique where not even level flight is attainable.
const TORQUE_PRICES: [f32; 3] = [1e5, 9e4, 8e4];

/// Requests are limited to this share of the authority, thrust to a range from just below zero.
const LIMIT: f32 = 1.1;
const LEAST_THRUST: f32 = -0.05;
const MOST_THRUST: f32 = 1.05;

/// What of a frame, its health and the voltage the programme reads.
pub(super) struct Problem<'a> {
    pub(super) units: &'a [Unit],
    pub(super) set: &'a AttainableSet<'a>,
    /// k_Q over k_f: rows are those of k_f, torques count so much more.
    pub(super) ratio: f32,
    /// True where thrusts give no yaw, and torques nothing else.
    pub(super) is_vertical: bool,
    /// Prices per row of roll, pitch and yaw, of too little and of too much thrust.
    pub(super) prices: [f32; 5],
}

impl<'a> Problem<'a> {
    #[inline(always)]
    pub(super) fn new<P, I, S>(tables: &'a Tables<'_, P, I, S>, ratio: f32) -> Self {
        let airmode = tables.desaturation.airmode;
        let little = if airmode.is_yaw_first() { LAST } else { MIDDLE };
        let much = if airmode.may_raise_thrust() {
            little
        } else {
            FORBIDDEN
        };
        let [roll, pitch, yaw] = TORQUE_PRICES;
        Problem {
            units: tables.units,
            set: &tables.attainable,
            ratio,
            is_vertical: tables.is_vertical,
            prices: [roll, pitch, yaw, little, much],
        }
    }

    /// B^T times rows.
    #[inline(always)]
    pub(super) fn gains(&self, unit: &Unit, rows: &[f32; 4]) -> [f32; 2] {
        let [thrust, torque] = &unit.columns;
        if self.is_vertical {
            let [roll, pitch, _, lift] = *thrust;
            let f = (roll * rows[0] + pitch * rows[1]) + lift * rows[3];
            return [f, self.ratio * (torque[2] * rows[2])];
        }
        [dot(thrust, rows), self.ratio * dot(torque, rows)]
    }

    /// Takes what efforts give from `rows`.
    #[inline(never)]
    pub(super) fn subtract(&self, unit: &Unit, efforts: [f32; 2], rows: &mut [f32; 4]) {
        self.subtract_inline(unit, efforts, rows);
    }

    /// As [`subtract`](Self::subtract), for the loops that run most often.
    #[inline(always)]
    pub(super) fn subtract_inline(&self, unit: &Unit, [f, q]: [f32; 2], rows: &mut [f32; 4]) {
        let q = self.ratio * q;
        let [thrust, torque] = &unit.columns;
        if self.is_vertical {
            let [roll, pitch, _, lift] = *thrust;
            rows[0] -= roll * f;
            rows[1] -= pitch * f;
            rows[2] -= torque[2] * q;
            rows[3] -= lift * f;
            return;
        }
        for ((row, thrust), torque) in rows.iter_mut().zip(thrust).zip(torque) {
            *row -= thrust * f + torque * q;
        }
    }

    /// What the units give at points inside their sets.
    #[inline(never)]
    pub(super) fn centre(&self, variables: &[Variable]) -> [f32; 4] {
        let mut centre = [0.0; 4];
        for (variable, unit) in variables.iter().zip(self.units) {
            rolled();
            self.subtract_inline(unit, variable.inside(self.set), &mut centre);
        }
        centre.map(|row| -row)
    }

    /// A request in rows, limited to what is looked at.
    #[inline(always)]
    pub(super) fn limited(&self, [roll, pitch, yaw, thrust]: [f32; 4], units: f32) -> [f32; 4] {
        let limit = LIMIT * units;
        let largest = if roll.abs() > pitch.abs() {
            roll.abs()
        } else {
            pitch.abs()
        };
        let share = if largest > limit {
            limit / divisor(largest)
        } else {
            1.0
        };
        let most_yaw = limit * self.ratio;
        [
            share * roll,
            share * pitch,
            clamp(yaw, -most_yaw, most_yaw),
            clamp(thrust, LEAST_THRUST * units, MOST_THRUST * units),
        ]
    }
}
