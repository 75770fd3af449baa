//! The programme of a request: what it may fall short of, at which cost, and where the simplex method
//! starts.
//!
//! So that requests within the attainable set do not end at corners, a segment leads beyond the
//! request, along the ray from the units' centres, at a small reward.

use core::hint::black_box;

use super::basis::Basis;
use super::problem::{LAST, LEVEL_TORQUE, MIDDLE, Problem, RESERVED, Wanted};
use super::simplex::Simplex;
use super::variable::{Segment, Variable, dot, positive};
use crate::desaturation::{Airmode, Budget};
use crate::rolled;

/// Indices of the segments; the last one is yaw within its reserve.
const LEVEL: usize = 0;
const YAW: usize = 1;
pub(super) const RAY: usize = 2;

/// How far beyond the request the ray reaches, as a share of the request's distance from the
/// centre, and the reward per row.
pub(super) const REACH: f32 = 1.0;
const REWARD: f32 = 0.02;

/// Least width of a shortage, rows: so that none has a column of zeros.
const LEAST_WIDTH: f32 = 1e-3;

/// A unit's bias: small beside the least cost, large beside rounding.
const BIAS: f32 = 4e-3;

/// Requests further than this from the centre, squared, as a share of the units, start at the prices.
const FAR: f32 = 0.25;

/// Sets the programme of a request up, given what the units give at their centres, rows. The start
/// changes no answer, since the optimum is unique: far out it is at the prices of what will be short,
/// near it is on the ray.
#[inline(never)]
pub(super) fn start<'a>(
    problem: &'a Problem<'a>,
    variables: &'a mut [Variable],
    wanted: &Wanted,
    centre: [f32; 4],
    airmode: Airmode,
    budget: Budget,
) -> Simplex<'a> {
    let units = variables.len() as f32;
    let Wanted {
        rows,
        level: size,
        direction: [east, north],
        yaw,
        sign,
        reserve,
    } = *wanted;
    let width = size + LEAST_WIDTH;
    let beyond = positive(yaw - reserve);
    let kept = yaw - beyond;
    let beyond = beyond + LEAST_WIDTH;
    let yaw_cost = if airmode.is_yaw_first() { MIDDLE } else { LAST };
    let away = [0, 1, 2, 3].map(|k| rows[k] - centre[k]);
    let [a0, a1, a2, a3] = away;
    let length = (a0.abs() + a1.abs()) + (a2.abs() + a3.abs());
    let mut segments = [
        Segment::new([width * east, width * north, 0.0, 0.0], -LEVEL_TORQUE * width),
        Segment::new([0.0, 0.0, sign * beyond, 0.0], -yaw_cost * beyond),
        Segment::new(away.map(|row| -REACH * row), REWARD * length),
        Segment::new([0.0, 0.0, sign * kept, 0.0], -RESERVED * kept),
    ];
    let mut basis = Basis::artificial();
    let square = dot(&away, &away);
    let multipliers;
    if square > FAR * units * units {
        let [.., little, much] = problem.prices;
        let mut price = 0.0;
        if a3 > 0.0 {
            price = little;
            basis.miss(3, 1.0);
        } else if airmode.may_raise_thrust() {
            price = -much;
            basis.miss(3, -1.0);
        }
        let mut level = 0.0;
        if size > 0.0 {
            level = LEVEL_TORQUE;
            basis.hold(0, LEVEL, [east / width, north / width, 0.0, 0.0]);
            *basis.row(1) = [-north, east, 0.0, 0.0];
            segments[LEVEL].is_basic = true;
        }
        basis.hold(2, YAW, [0.0, 0.0, sign / beyond, 0.0]);
        segments[YAW].is_basic = true;
        multipliers = [level * east, level * north, sign * yaw_cost, price];
    } else {
        // The ray serves the row in which it is longest, and gives its share to the others.
        let mut longest = 0;
        for row in 1..4 {
            if away[row].abs() > away[longest & 3].abs() {
                longest = row;
            }
        }
        let longest = longest & 3;
        let along = away[longest];
        let per_row = -1.0 / (REACH * along + if along < 0.0 { -1e-6 } else { 1e-6 });
        for (row, part) in away.iter().enumerate() {
            basis.row(row)[longest] = per_row * REACH * part;
        }
        let mut row = [0.0; 4];
        row[longest] = per_row;
        basis.hold(longest, RAY, row);
        segments[RAY].is_basic = true;
        let reward = REWARD * length / (REACH * square + 1e-9);
        multipliers = away.map(|row| reward * row);
    }
    let mut residual = rows;
    for segment in black_box(segments.as_mut_slice()) {
        rolled();
        segment.gain += dot(&segment.column, &multipliers);
        if segment.is_basic {
            segment.gain = 0.0;
        } else if segment.gain > 0.0 {
            segment.turn(&mut residual);
        }
    }
    let mut weyl = 0.5;
    for (variable, unit) in variables.iter_mut().zip(problem.units) {
        rolled();
        let [f, q] = problem.gains(unit, &multipliers);
        variable.gain = [f + BIAS * (weyl - 0.5), q + BIAS * (0.75 - weyl)];
        // Weyl's sequence: spread over [0, 1) for any number of units.
        weyl += 0.618_034;
        weyl -= if weyl >= 1.0 { 1.0 } else { 0.0 };
        variable.rate = [0.0; 2];
        let at = variable.choose_corner(problem.set);
        problem.subtract_inline(unit, at, &mut residual);
    }
    Simplex {
        problem,
        basis,
        variables,
        segments,
        residual,
        multipliers,
        values: [0.0; 4],
        step: 0.0,
        budget,
    }
}
