//! What a request may fall short of, and at which cost.
//!
//! Costs per row of shortage have fixed ratios, which act as priorities and bound how steep the
//! answer is in the request:
//!
//! ```text
//! yaw beyond the reserve   1          (airmode roll-pitch-yaw: 20)
//! too little thrust       20          (1)
//! roll and pitch         400
//! too much thrust       2000 disabled, 20 roll-pitch, 1 roll-pitch-yaw
//! the reserve of yaw   10000
//! ```
//!
//! A higher priority is given up where that gains more of the next one than these ratios. Roll and
//! pitch are one shortage, along their request, so that their direction stays. A shortage runs from
//! nothing to all that was asked for, so that nothing is reversed.

use super::variable::Variable;
use crate::desaturation::Airmode;
use crate::{clamp, rolled, sqrt};

/// How many shortages there are at most. Each has a [`Variable`] behind those of the units.
pub const SHORTAGES: usize = 6;

/// The shortages of thrust, which come first: all that there are without roll, pitch and yaw.
pub(super) const LEVEL: usize = 2;

/// The shortage along the ray, and the number of shortages without a reserve of yaw.
pub(super) const RAY: usize = 4;
const WITHOUT_RESERVE: usize = 5;

/// How far beyond the request the ray reaches, as a share of the request's distance from the
/// centre, and the reward per row.
pub(super) const REACH: f32 = 1.0;
const REWARD: f32 = 0.02;

const THRUST: f32 = 20.0;
const LEVEL_TORQUE: f32 = 20.0 * THRUST;
const FORBIDDEN: f32 = 5.0 * LEVEL_TORQUE;
const RESERVE: f32 = 5.0 * FORBIDDEN;

/// Requests are looked at up to this share of the authority, and thrust from just below none.
const LIMIT: f32 = 1.1;
const LEAST_THRUST: f32 = -0.05;
const MOST_THRUST: f32 = 1.05;

/// The most thrust that desaturation gives: all rotors at full.
const CEILING: f32 = 1.02;

/// Least widths of shortages, rows: so that none has a column of zeros.
const LEAST_WIDTH: f32 = 1e-3;
const LEAST_WIDTH_OF_THRUST: f32 = 0.1;

/// A unit's bias: small beside the least cost, large beside rounding.
const BIAS: f32 = 4e-3;

/// Writes the units' biases and, behind the units, the shortages of a request in rows, which is
/// limited to what is looked at; returns how many shortages there are. `centre` is what the units'
/// centres give, `reserve` the yaw that is kept before roll and pitch, in rows.
#[inline(never)]
pub(super) fn write(
    variables: &mut [Variable],
    units: usize,
    wanted: &mut [f32; 4],
    centre: &[f32; 4],
    airmode: Airmode,
    reserve: f32,
) -> usize {
    let Some((unit, shortages)) = variables.split_at_mut_checked(units) else {
        return 0;
    };
    let mut weyl = 0.5;
    for unit in unit {
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
    let share = if largest > limit { limit / largest } else { 1.0 };
    wanted[0] *= share;
    wanted[1] *= share;
    wanted[2] = clamp(wanted[2], -limit, limit);
    wanted[3] = clamp(wanted[3], LEAST_THRUST * n, MOST_THRUST * n);
    let [roll, pitch, yaw, thrust] = *wanted;

    let (thrust_cost, yaw_cost) = match airmode {
        Airmode::RollPitchYaw => (1.0, THRUST),
        _ => (THRUST, 1.0),
    };
    let excess_cost = match airmode {
        Airmode::Disabled => FORBIDDEN,
        _ => thrust_cost,
    };
    let least = |width: f32, least: f32| if width > least { width } else { least };
    let short = least(thrust - LEAST_THRUST * n, 0.0) + LEAST_WIDTH_OF_THRUST;
    let excess = least(CEILING * n - thrust, LEAST_WIDTH_OF_THRUST);

    let size = sqrt(roll * roll + pitch * pitch);
    let width = size + LEAST_WIDTH;
    let direction = if size > 0.0 {
        [roll * (width / size), pitch * (width / size)]
    } else {
        [width, 0.0]
    };

    let sign = if yaw < 0.0 { -1.0 } else { 1.0 };
    let asked = yaw.abs();
    let reserved = if asked < reserve { asked } else { reserve };
    let (beyond, within) = (asked - reserved + LEAST_WIDTH, reserved + LEAST_WIDTH);

    let ray = [0, 1, 2, 3].map(|k| REACH * (centre[k] - wanted[k]));
    let length: f32 = ray.iter().map(|row| row.abs()).sum();
    let values = [
        ([0.0, 0.0, 0.0, short], thrust_cost * short),
        ([0.0, 0.0, 0.0, -excess], excess_cost * excess),
        ([direction[0], direction[1], 0.0, 0.0], LEVEL_TORQUE * width),
        ([0.0, 0.0, sign * beyond, 0.0], yaw_cost * beyond),
        (ray, -REWARD * length),
        ([0.0, 0.0, sign * within, 0.0], RESERVE * within),
    ];
    for (shortage, (rows, cost)) in shortages.iter_mut().zip(values) {
        rolled();
        (shortage.columns[0], shortage.gain) = (rows, [-cost, 0.0]);
    }
    if reserve > 0.0 { SHORTAGES } else { WITHOUT_RESERVE }
}
