//! The residual over one cell of throttles.
//!
//! Let t* run through the cell and e = F(t*) be its efforts. The runtime computes throttles t near
//! t*; d = t - t* is its deviation, R = F(t) - F(t*) its residual. The first guess is evaluated
//! over Taylor models, which gives d with its rounding error. A Newton step solves J s = m, m = e -
//! F(t) as far as rounding allows: J s = m + r with r bounded below. By Taylor's formula (G in
//! [`expansion`](super::expansion)), without any approximation:
//!
//! ```text
//! m = -J d + G(t; -d)        s = -d + J^-1 (G(t; -d) + r)        R = F(t + s) - F(t*) = G(t; s) + r
//! ```
//!
//! A throttle that leaves the range is limited to its end. The cases "within" and "limited" are
//! followed separately, each over the part of the cell where it can occur: where a throttle was
//! limited, its deviation is the end of the range less t*.

use mixer_rt::tables::{Pair, ThrottleRange, solve};

use super::bend::{Bend, squares};
use super::expansion::{Expansion, Monomials};
use super::taylor::Taylor;
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

/// Deviation of both throttles.
type Deviation = [Taylor; 2];

/// A cell with all that its steps need.
#[derive(Clone, Copy)]
struct Local<'a> {
    subject: &'a Subject<'a>,
    cell: ThrottleCell,
    expansions: [Expansion; 2],
    truth: [Taylor; 2],
    efforts: [Taylor; 2],
}

/// A part of a cell where each throttle is limited to the range, or is not.
struct Case<'a> {
    part: Local<'a>,
    /// After limiting.
    deviation: Deviation,
    limited: [bool; 2],
}

/// What one step does from one point.
struct Step {
    /// Deviation after it.
    deviation: Deviation,
    /// Residual after it, where no throttle is limited.
    residual: [Taylor; 2],
}

impl Subject<'_> {
    /// Bounds of |R| over the cell, `[N, N m]`; infinite where the cell is too large to tell.
    pub(super) fn residual(&self, cell: &ThrottleCell) -> [f64; 2] {
        let local = Local::new(self, cell);
        let guess = self.inverse.guess(local.efforts);
        let deviation: Deviation = [0, 1].map(|k| guess[k].computed().plus(&-local.truth[k]));
        if !bounded(&deviation) {
            return [f64::INFINITY; 2];
        }
        let steps = self.inverse.evaluator.steps();
        if steps == 0 {
            return local.bound(&deviation, &local.change(&deviation));
        }
        let mut bound = [0.0f64; 2];
        for Case { part, deviation, .. } in local.limited(&deviation) {
            let found = part.steps(&deviation, steps);
            bound = [0, 1].map(|k| bound[k].max(found[k]));
        }
        bound
    }
}

impl<'a> Local<'a> {
    fn new(subject: &'a Subject<'a>, cell: &ThrottleCell) -> Self {
        let expansions = [0, 1].map(|k| Expansion::new(&subject.monomials[k], cell.centre, cell.half));
        let efforts = [0, 1].map(|k| {
            let value: Taylor = expansions[k].value();
            let error = value.magnitude() * subject.input[k] + 1e-40;
            value.with_error(error)
        });
        Local {
            subject,
            expansions,
            cell: *cell,
            truth: [0, 1].map(|k| Taylor::coordinate(cell.centre[k], cell.half[k], k == 1)),
            efforts,
        }
    }

    /// The bound after `steps` Newton steps.
    fn steps(&self, start: &Deviation, steps: u8) -> [f64; 2] {
        let Some(step) = self.step(start) else {
            return [f64::INFINITY; 2];
        };
        if steps == 1 {
            return self.bound(&step.deviation, &step.residual);
        }
        let mut bound = [0.0f64; 2];
        for Case { part, deviation, .. } in self.limited(&step.deviation) {
            let found = part.steps(&deviation, steps - 1);
            bound = [0, 1].map(|k| bound[k].max(found[k]));
        }
        bound
    }

    /// One step from t* + `deviation`; `None` where nothing can be said.
    fn step(&self, deviation: &Deviation) -> Option<Step> {
        let subject = self.subject;
        // Whatever the runtime has computed so far, it is an f32 without error now.
        let at = [0, 1].map(|k| self.truth[k].plus(&deviation[k]));
        let (given, computed) = subject.pair.efforts_and_jacobian(at);
        let jacobian_error =
            [0, 1].map(|k| computed[k].map(|slope| slope.error() + subject.coefficients[k][1]));
        let jacobian =
            [0, 1].map(|k| [0, 1].map(|m: usize| computed[k][m].real().widened(jacobian_error[k][m])));
        let missing = [0, 1].map(|k| self.efforts[k] - given[k]);
        let missing_error = [0, 1].map(|k| missing[k].error() + subject.coefficients[k][0]);
        // The step that the runtime computes from these numbers, and its rounding.
        let computed = solve(jacobian, missing.map(Taylor::computed));
        if !bounded(&computed) {
            return None;
        }
        let size = computed.map(|step| step.magnitude());
        let rounding = computed.map(|step| step.error() + self.last_half_unit());
        let slack = [0, 1].map(|k| {
            let along = |m: usize| jacobian_error[k][m] * size[m] + jacobian[k][m].magnitude() * rounding[m];
            missing_error[k] + along(0) + along(1)
        });

        let bend = Bend::new(&self.expansions, self.cell.half, deviation);
        // G and what rounding adds to it.
        let left_out = |v: &[Taylor; 2]| {
            let sums = bend.remainders(v);
            [0, 1].map(|k| sums[k].widened(slack[k]))
        };
        let back = deviation.map(|d| -d);
        let after = solve(jacobian, left_out(&back)).map(Taylor::real);
        let taken = [0, 1].map(|k| after[k].plus(&back[k]));
        let residual = left_out(&taken);
        (bounded(&after) && bounded(&residual)).then_some(Step {
            deviation: after,
            residual,
        })
    }

    /// How far t* + `deviation` may lie from the centre.
    fn reach(&self, deviation: &Deviation) -> [f64; 2] {
        [0, 1].map(|k| self.cell.half[k] + deviation[k].magnitude())
    }

    /// Half a unit in the last place of throttles below the largest: at or above it they are
    /// limited, and limiting to a float commutes with rounding.
    fn last_half_unit(&self) -> f64 {
        let below = self.subject.throttle.max.next_down();
        0.5 * f64::from(below.next_up() - below)
    }

    fn range(&self) -> [f64; 2] {
        [self.subject.throttle.min, self.subject.throttle.max].map(f64::from)
    }

    /// Case by case, the parts of the cell and the deviations there after both throttles have been
    /// limited.
    fn limited(&self, deviation: &Deviation) -> Vec<Case<'a>> {
        let mut cases = vec![Case {
            part: *self,
            deviation: *deviation,
            limited: [false; 2],
        }];
        for axis in 0..2 {
            let mut split = Vec::with_capacity(2);
            for case in cases {
                case.limit(axis, &mut split);
            }
            cases = split;
        }
        cases
    }

    /// The part of the cell where the throttle of `axis` lies in `[from, to]`.
    fn part(&self, axis: usize, [from, to]: [f64; 2]) -> Local<'a> {
        let mut cell = self.cell;
        let centre = 0.5 * (from + to);
        cell.centre[axis] = centre;
        cell.half[axis] = (to - centre).max(centre - from).next_up();
        Local::new(self.subject, &cell)
    }

    /// A function over the cell of `whole` as a function over this part of it.
    fn seen(&self, function: &Taylor, whole: &Local<'_>) -> Taylor {
        let mut seen = *function;
        for axis in 0..2 {
            let (from, to) = (&whole.cell, &self.cell);
            if from.half[axis] != to.half[axis] {
                let offset = (to.centre[axis] - from.centre[axis]) / from.half[axis];
                seen = seen.restricted(axis == 1, offset, to.half[axis] / from.half[axis]);
            }
        }
        seen
    }

    /// Bounds of |R| after the last deviation has been limited; `residual` is R `before`.
    fn bound(&self, before: &Deviation, residual: &[Taylor; 2]) -> [f64; 2] {
        let mut bound = [0.0f64; 2];
        for Case {
            part,
            deviation,
            limited,
        } in self.limited(before)
        {
            let seen =
                |functions: &[Taylor; 2]| functions.each_ref().map(|function| part.seen(function, self));
            let free = seen(residual);
            if !bounded(&free) {
                return [f64::INFINITY; 2];
            }
            let mut sizes = free.map(|residual| residual.range().magnitude());
            if limited != [false; 2] {
                let changes = part.change(&deviation).map(|change| change.range().magnitude());
                let shares = part.shares(&sizes, &seen(before), limited);
                sizes = [0, 1].map(|k| changes[k].min(shares[k]));
            }
            bound = [0, 1].map(|k| bound[k].max(sizes[k]));
        }
        bound
    }

    /// Bounds of |R| where limiting leaves each throttle a share of its `deviation`, between 0 and
    /// 1: R is the linear interpolation between what it is without limiting, `free`, and without
    /// the limited throttles, but for an eighth of F_uu du2 or F_ll dl2.
    fn shares(&self, free: &[f64; 2], deviation: &Deviation, limited: [bool; 2]) -> [f64; 2] {
        let size = deviation.map(|d| d.magnitude());
        let reach = self.reach(deviation);
        [0, 1].map(|k| {
            let slopes = self.expansions[k].slopes(reach);
            let curvature = self.expansions[k].curvature(reach);
            let (mut bound, mut bend) = (free[k], 0.0);
            for m in 0..2 {
                if limited[m] {
                    bound = bound.max(slopes[1 - m] * size[1 - m]);
                    bend += curvature.bend(m, size[m]) + slopes[m] * self.beyond(m);
                }
            }
            (bound + bend) * (1.0 + 1e-12)
        })
    }

    /// How far t* may lie outside the range, which in f32 may be narrower than the box by a
    /// rounding.
    fn beyond(&self, axis: usize) -> f64 {
        let ([low, high], truth) = (self.range(), self.truth[axis].range());
        (truth.high - high).max(low - truth.low).max(0.0)
    }

    /// F(t* + d) - F(t*).
    fn change(&self, deviation: &Deviation) -> [Taylor; 2] {
        let (squares, size) = squares(deviation);
        let reach = self.reach(&[Taylor::exact(0.0); 2]);
        [0, 1].map(|k| {
            let [by_u, by_l] = self.expansions[k].gradient();
            by_u.product(&deviation[0])
                .plus(&by_l.product(&deviation[1]))
                .plus(&self.expansions[k].curvature(reach).remainder(&squares, size))
        })
    }
}

impl<'a> Case<'a> {
    /// The cases of one throttle.
    fn limit(self, axis: usize, cases: &mut Vec<Case<'a>>) {
        let whole = self.part;
        let [low, high] = whole.range();
        let place = whole.truth[axis].plus(&self.deviation[axis]).range();
        if place.low >= low && place.high <= high {
            cases.push(self);
            return;
        }
        let (truth, range) = (whole.truth[axis].range(), self.deviation[axis].range());
        // Where t* is to lie, and where the throttle is limited to.
        let mut case = |[from, to]: [f64; 2], end: Option<f64>| {
            let (from, to) = (from.next_down().max(truth.low), to.next_up().min(truth.high));
            if from <= to {
                let part = whole.part(axis, [from, to]);
                let mut deviation = self.deviation.each_ref().map(|d| part.seen(d, &whole));
                if let Some(end) = end {
                    deviation[axis] = Taylor::exact(end).plus(&-part.truth[axis]);
                }
                let mut limited = self.limited;
                limited[axis] |= end.is_some();
                cases.push(Case {
                    part,
                    deviation,
                    limited,
                });
            }
        };
        case([low - range.high, high - range.low], None);
        // A throttle that is limited had passed the end: t* is no further from there than the
        // deviation goes.
        if place.high > high {
            case([high - range.high, truth.high], Some(high));
        }
        if place.low < low {
            case([truth.low, low - range.low], Some(low));
        }
    }
}

fn bounded(numbers: &[Taylor; 2]) -> bool {
    numbers.iter().all(Taylor::is_bounded)
}
