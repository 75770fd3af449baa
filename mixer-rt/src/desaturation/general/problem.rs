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

use core::hint::black_box;

use super::variable::{Variable, dot};
use crate::desaturation::attainable::AttainableSet;
use crate::desaturation::limited;
use crate::layout::{Tables, Unit};
use crate::{clamp, divisor, rolled, sqrt};

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

/// A torque that is reversed or exceeded by more than this share of its authority is not accepted. A
/// single unit may reverse it by `LEAST_WIDTH` of the programme.
const ACCEPTED: f32 = 1.5e-3;

/// The same where an answer is taken back, so that the model's and the inverse map's errors have room.
const AIMED_AT: f32 = 1e-4;

/// More thrust missed below zero than there is: no bound.
pub(super) const ANY: f32 = -1e9;

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

    /// What a request in rows misses where the units are.
    #[inline(never)]
    pub(super) fn missed(&self, rows: &[f32; 4], variables: &[Variable]) -> [f32; 4] {
        let mut missed = *rows;
        for (variable, unit) in variables.iter().zip(self.units) {
            rolled();
            self.subtract_inline(unit, variable.at, &mut missed);
        }
        missed
    }

    /// A request in rows, limited to what is looked at.
    #[inline(always)]
    pub(super) fn wanted(&self, rows: [f32; 4], reserve: f32) -> Wanted {
        let units = self.units.len() as f32;
        let limit = LIMIT * units;
        let thrusts = [LEAST_THRUST * units, MOST_THRUST * units];
        Wanted::new(limited(rows, limit, limit * self.ratio, thrusts), reserve)
    }
}

/// A request in rows.
pub(super) struct Wanted {
    pub(super) rows: [f32; 4],
    /// Size and direction of (roll, pitch).
    pub(super) level: f32,
    pub(super) direction: [f32; 2],
    /// Size and sign of yaw.
    pub(super) yaw: f32,
    pub(super) sign: f32,
    /// The yaw that is kept before roll and pitch.
    pub(super) reserve: f32,
}

impl Wanted {
    #[inline(never)]
    pub(super) fn new(rows: [f32; 4], reserve: f32) -> Self {
        let [roll, pitch, yaw, _] = rows;
        let level = sqrt(roll * roll + pitch * pitch);
        let direction = if level > 0.0 {
            [roll, pitch].map(|row| row / divisor(level))
        } else {
            [1.0, 0.0]
        };
        Wanted {
            rows,
            level,
            direction,
            yaw: yaw.abs(),
            sign: if yaw < 0.0 { -1.0 } else { 1.0 },
            reserve,
        }
    }

    /// True where efforts that miss this neither reverse nor exceed a torque, nor turn (roll, pitch).
    #[inline(always)]
    pub(super) fn accepts(&self, missed: &[f32; 4], units: usize) -> bool {
        let [roll, pitch, yaw, _] = self.rows;
        self.share(&[roll, pitch, yaw, ANY], missed, ACCEPTED * units as f32) >= 1.0
    }

    /// The share of the way from efforts that miss `from` to those that miss `to` which is sound.
    #[inline(always)]
    pub(super) fn sound_share(&self, from: &[f32; 4], to: &[f32; 4], units: usize) -> f32 {
        self.share(from, to, AIMED_AT * units as f32)
    }

    /// The share of the way from efforts that miss `from` to those that miss `to` up to which no torque
    /// is reversed or exceeded, (roll, pitch) keeps its direction, and thrust is not exceeded by more
    /// than `from` does. Each of these is linear in what is missed.
    #[inline(never)]
    fn share(&self, from: &[f32; 4], to: &[f32; 4], slack: f32) -> f32 {
        let [east, north] = self.direction;
        let bounded = [
            ([east, north, 0.0, 0.0], self.level),
            ([-north, east, 0.0, 0.0], 0.0),
            ([0.0, 0.0, self.sign, 0.0], self.yaw),
            ([0.0, 0.0, 0.0, 1.0], -ANY),
        ];
        let mut share = 1.0;
        for (along, most) in black_box(bounded.as_slice()) {
            rolled();
            let [from, to] = [from, to].map(|rows| dot(along, rows));
            let (low, high) = (-slack, most + slack);
            let low = if from < low { from } else { low };
            let bound = clamp(to, low, high);
            let (room, way) = ((bound - from).abs(), (to - from).abs());
            if to != bound && share * way > room {
                share = room / divisor(way);
            }
        }
        share
    }
}
