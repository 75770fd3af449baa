//! What a request may fall short of, and at which cost.
//!
//! Costs per row have fixed ratios, which act as priorities and bound how steep the answer is in
//! the request:
//!
//! ```text
//! yaw beyond the reserve   1          (airmode roll-pitch-yaw: 20)
//! too little thrust       20          (1)
//! roll and pitch         400
//! too much thrust       2000 disabled, 20 roll-pitch, 1 roll-pitch-yaw
//! the reserve of yaw   34000
//! ```
//!
//! A higher priority is given up where that gains more of the next one than these ratios. Roll and
//! pitch are one shortage, along their request, so that their direction stays. A shortage runs from
//! nothing to all that was asked for, so that nothing is reversed. Thrust needs no such limit: its
//! row is missed at a price ([`ThrustPrice`]).

use super::variable::{Variable, positive};
use crate::desaturation::Airmode;
use crate::{clamp, rolled, sqrt};

/// How many shortages there are. Each has a [`Variable`] behind those of the units.
pub const SHORTAGES: usize = 3;

/// The shortage along the ray.
pub(super) const RAY: usize = 2;

/// Prices per row of thrust that is missing and of thrust that was not asked for.
#[derive(Clone, Copy)]
pub(super) struct ThrustPrice {
    pub(super) too_little: f32,
    pub(super) too_much: f32,
}

/// How far beyond the request the ray reaches, as a share of the request's distance from the
/// centre, and the reward per row.
pub(super) const REACH: f32 = 1.0;
const REWARD: f32 = 0.02;

const THRUST: f32 = 20.0;
const LEVEL_TORQUE: f32 = 20.0 * THRUST;
const FORBIDDEN: f32 = 5.0 * LEVEL_TORQUE;

/// Prices per row of roll, pitch and yaw that no shortage covers: yaw within its reserve, and an
/// axis that is reversed or exceeded. They are above all costs, so that these are given up last.
/// They differ, so that the answer is unique where not even level flight is attainable.
pub(super) const TORQUE_PRICES: [f32; 3] = [4e4, 3.7e4, 3.4e4];

/// Requests are limited to this share of the authority, thrust to a range from just below zero.
const LIMIT: f32 = 1.1;
const LEAST_THRUST: f32 = -0.05;
const MOST_THRUST: f32 = 1.05;

/// Least width of a shortage, rows: so that none has a column of zeros.
const LEAST_WIDTH: f32 = 1e-3;

/// A unit's bias: small beside the least cost, large beside rounding.
const BIAS: f32 = 4e-3;

impl ThrustPrice {
    pub(super) fn of(airmode: Airmode) -> Self {
        let (too_little, too_much) = match airmode {
            Airmode::Disabled => (THRUST, FORBIDDEN),
            Airmode::RollPitch => (THRUST, THRUST),
            Airmode::RollPitchYaw => (1.0, 1.0),
        };
        ThrustPrice { too_little, too_much }
    }
}

/// Writes the units' biases, which make the optimum unique, and, behind the units, the shortages of
/// a request in rows, which is limited to what is looked at. `centre` is what the units' centres
/// give, `reserve` the yaw that is kept before roll and pitch, in rows.
#[inline(never)]
pub(super) fn write(
    variables: &mut [Variable],
    units: usize,
    wanted: &mut [f32; 4],
    centre: &[f32; 4],
    airmode: Airmode,
    reserve: f32,
) {
    let Some((biased, shortages)) = variables.split_at_mut_checked(units) else {
        return;
    };
    let mut weyl = 0.5;
    for unit in biased {
        rolled();
        unit.gain = [BIAS * (weyl - 0.5), BIAS * (0.75 - weyl)];
        // Weyl's sequence: spread over [0, 1) for any number of units.
        weyl += 0.618_034;
        weyl -= if weyl >= 1.0 { 1.0 } else { 0.0 };
    }
    let n = units as f32;
    let limit = LIMIT * n;
    let [roll, pitch, ..] = *wanted;
    let largest = if roll.abs() > pitch.abs() {
        roll.abs()
    } else {
        pitch.abs()
    };
    if largest > limit {
        let share = limit / largest;
        wanted[0] *= share;
        wanted[1] *= share;
    }
    wanted[2] = clamp(wanted[2], -limit, limit);
    wanted[3] = clamp(wanted[3], LEAST_THRUST * n, MOST_THRUST * n);
    let [roll, pitch, yaw, _] = *wanted;

    let yaw_cost = match airmode {
        Airmode::RollPitchYaw => THRUST,
        _ => 1.0,
    };

    let size = sqrt(roll * roll + pitch * pitch);
    let width = size + LEAST_WIDTH;
    let direction = if size > 0.0 {
        [roll * (width / size), pitch * (width / size)]
    } else {
        [width, 0.0]
    };

    let sign = if yaw < 0.0 { -1.0 } else { 1.0 };
    let beyond = positive(yaw.abs() - reserve) + LEAST_WIDTH;

    let ray = [0, 1, 2, 3].map(|k| REACH * (centre[k] - wanted[k]));
    let length: f32 = ray.iter().map(|row| row.abs()).sum();
    let values = [
        ([direction[0], direction[1], 0.0, 0.0], LEVEL_TORQUE * width),
        ([0.0, 0.0, sign * beyond, 0.0], yaw_cost * beyond),
        (ray, -REWARD * length),
    ];
    for (shortage, (rows, cost)) in shortages.iter_mut().zip(values) {
        rolled();
        (shortage.columns[0], shortage.gain) = (rows, [-cost, 0.0]);
    }
}
