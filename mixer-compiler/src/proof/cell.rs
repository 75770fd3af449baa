//! The residual over one cell of throttles.
//!
//! Let t* run through the cell and e = F(t*) be its efforts. The runtime computes throttles t near
//! t*; d = t - t* is its deviation, R = F(t) - F(t*) its residual. The first guess is evaluated
//! over Taylor models, which gives d with its rounding error. A Newton step solves J s = m, m = e -
//! F(t), with rounding errors: J s = m + r with r bounded below. By Taylor's formula, without any
//! approximation:
//!
//! ```text
//! G(t; v) = F(t + v) - F(t) - J(t) v = sum over i + j >= 2 of F^(i,j)(t) / (i! j!) vu^i vl^j
//! m = -J d + G(t; -d)        s = -d + J^-1 (G(t; -d) + r)        R = F(t + s) - F(t*) = G(t; s) + r
//! ```
//!
//! A throttle that leaves the range is limited to its end: its deviation is then the end less t*.

use mixer_rt::tables::{Pair, ThrottleRange, solve};

use super::expansion::{Expansion, Monomials};
use super::taylor::Taylor;
use crate::bounds::interval::Interval;
use crate::inverse::table::InverseTable;
use crate::tables::QuantityTable;

/// What stays the same from cell to cell.
#[derive(Debug)]
pub(super) struct Subject<'a> {
    pub(super) monomials: [Monomials; 2],
    pub(super) pair: &'a Pair<QuantityTable>,
    pub(super) inverse: &'a InverseTable,
    pub(super) throttle: ThrottleRange,
    /// Relative error of the efforts that the inverse is given.
    pub(super) input: [f64; 2],
    /// Bounds of what rounding the coefficients changes, `[value, derivative]` of f and of Q.
    pub(super) coefficients: [[f64; 2]; 2],
}

/// A box of throttles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ThrottleCell {
    pub(super) centre: [f64; 2],
    pub(super) half: [f64; 2],
}

/// Functions over a cell: deviations of both throttles, or residuals of f and of Q.
type Functions = [Taylor; 2];

impl Subject<'_> {
    /// Bounds of |R| over the cell, `[N, N m]`; infinite where the cell is too large to tell.
    pub(super) fn residual(&self, cell: &ThrottleCell) -> [f64; 2] {
        let coordinates = |from: [f64; 2]| [0, 1].map(|k| Taylor::coordinate(from[k], cell.half[k], k == 1));
        let truth = coordinates(cell.centre);
        let about_centre = Expansion::new(&self.monomials, cell.centre.map(Interval::exact));
        let efforts = about_centre.sums(&coordinates([0.0; 2]), 0);
        let efforts = [0, 1].map(|k| efforts[k].with_error(efforts[k].magnitude() * self.input[k] + 1e-40));
        let guess = self.inverse.guess(efforts);
        let mut deviation = [0, 1].map(|k| guess[k].computed().plus(&-truth[k]));
        let at_truth = Expansion::new(&self.monomials, ranges(&truth));
        let mut residual = at_truth.sums(&deviation, 1);
        for _ in 0..self.inverse.evaluator.steps() {
            if !bounded(&deviation) {
                return [f64::INFINITY; 2];
            }
            let limited = self.limited(&truth, &deviation);
            (deviation, residual) = self.step(&truth, efforts, &limited);
        }
        if !bounded(&deviation) || !bounded(&residual) {
            return [f64::INFINITY; 2];
        }
        self.bound(&at_truth, &truth, &deviation, &residual)
    }

    /// Deviation and residual after a step from t* + `deviation`, where no throttle is limited then.
    fn step(&self, truth: &Functions, efforts: Functions, deviation: &Functions) -> (Functions, Functions) {
        // Whatever the runtime has computed so far, it is an f32 without error now.
        let at = [0, 1].map(|k| truth[k].plus(&deviation[k]));
        let (given, computed) = self.pair.efforts_and_jacobian(at);
        let jacobian_error = [0, 1].map(|k| computed[k].map(|slope| slope.error() + self.coefficients[k][1]));
        let jacobian =
            [0, 1].map(|k| [0, 1].map(|m: usize| computed[k][m].real().widened(jacobian_error[k][m])));
        let missing = [0, 1].map(|k| efforts[k] - given[k]);
        let missing_error = [0, 1].map(|k| missing[k].error() + self.coefficients[k][0]);
        // The step that the runtime computes from these numbers, and its rounding.
        let computed = solve(jacobian, missing.map(Taylor::computed));
        let size = computed.map(|step| step.magnitude());
        let rounding = computed.map(|step| step.error() + self.last_half_unit());
        let slack = [0, 1].map(|k| {
            let along = |m: usize| jacobian_error[k][m] * size[m] + jacobian[k][m].magnitude() * rounding[m];
            missing_error[k] + along(0) + along(1)
        });

        let expansion = Expansion::new(&self.monomials, ranges(&at));
        // G and what rounding adds to it.
        let left_out = |v: &Functions| {
            let sums = expansion.sums(v, 2);
            [0, 1].map(|k| sums[k].widened(slack[k]))
        };
        let back = deviation.map(|d| -d);
        let after = solve(jacobian, left_out(&back)).map(Taylor::real);
        let taken = [0, 1].map(|k| after[k].plus(&back[k]));
        (after, left_out(&taken))
    }

    /// Half a unit in the last place of throttles below the largest: at or above it they are
    /// limited, and limiting to a float commutes with rounding.
    fn last_half_unit(&self) -> f64 {
        let below = self.throttle.max.next_down();
        0.5 * f64::from(below.next_up() - below)
    }

    fn range(&self) -> [f64; 2] {
        [self.throttle.min, self.throttle.max].map(f64::from)
    }

    /// The deviations after both throttles have been limited.
    fn limited(&self, truth: &Functions, deviation: &Functions) -> Functions {
        let [low, high] = self.range();
        [0, 1].map(|k| {
            let place = truth[k].plus(&deviation[k]).range();
            if place.low >= low && place.high <= high {
                return deviation[k];
            }
            let [to_low, to_high] = [low, high].map(|end| Interval::exact(end) - truth[k].range());
            let range = deviation[k].range();
            // The limited deviation rises with the deviation and falls with t*.
            Taylor::from_interval(Interval {
                low: range.low.max(to_low.low).min(to_high.low),
                high: range.high.max(to_low.high).min(to_high.high),
            })
        })
    }

    /// Bounds of |R| after the last `deviation` has been limited; `free` is R before.
    ///
    /// Limiting leaves a throttle a share of its deviation, between 0 and 1: R is the linear interpolation between what
    /// it is without limiting and without the limited throttles, but for an eighth of F_uu du2 or F_ll dl2.
    fn bound(
        &self,
        at_truth: &Expansion,
        truth: &Functions,
        deviation: &Functions,
        free: &Functions,
    ) -> [f64; 2] {
        let free = free.map(|residual| residual.range().magnitude());
        let limited = self.limited(truth, deviation);
        let is_limited = [0, 1].map(|k| limited[k] != deviation[k]);
        if is_limited == [false; 2] {
            return free;
        }
        let direct = at_truth.sums(&limited, 1);
        let size = deviation.map(|d| d.magnitude());
        let on_the_way = [0, 1].map(|k| truth[k].widened(size[k]));
        let on_the_way = Expansion::new(&self.monomials, ranges(&on_the_way));
        // How far t* may lie outside the range, which in f32 may be narrower than the box by a rounding.
        let [low, high] = self.range();
        let beyond = ranges(truth).map(|truth| (truth.high - high).max(low - truth.low).max(0.0));
        [0, 1].map(|k| {
            let (mut share, mut curved) = (free[k], 0.0);
            for m in (0..2).filter(|&m| is_limited[m]) {
                let [slope, curvature] = [1, 2].map(|order| on_the_way.along(k, m, order));
                share = share.max(on_the_way.along(k, 1 - m, 1) * size[1 - m]);
                curved += 0.25 * curvature * size[m] * size[m] + slope * beyond[m];
            }
            direct[k]
                .range()
                .magnitude()
                .min((share + curved) * (1.0 + 1e-12))
        })
    }
}

fn ranges(functions: &Functions) -> [Interval; 2] {
    functions.each_ref().map(Taylor::range)
}

fn bounded(numbers: &Functions) -> bool {
    numbers.iter().all(Taylor::is_bounded)
}
