//! Proof that the emitted inverse keeps its tolerance.
//!
//! The claim: for every voltage and density in their ranges and every pair of throttles in the throttle box, let E
//! = k F(u, l) be the efforts that they give. Where the mixer asks for E, rounded to f32, the
//! throttles that the emitted tables give by the operations of `mixer-rt` lie within the throttle
//! range, and their efforts are within `stated` of E. F and k are the airframe file's, in exact
//! arithmetic.
//!
//! The box is cut into cells. On each, `cell.rs` bounds the residual; the worst cell is halved
//! until the largest bound is as small as was asked, or the work allowed is done.

mod cell;
mod correction;
mod expansion;
pub(crate) mod residual;
mod taylor;

use std::collections::BinaryHeap;

use crate::airframe::Pair;
use crate::proof::residual::Residual;
use crate::tables::UnitMap;
use crate::view::View;
use cell::{Subject, ThrottleCell};
use expansion::Monomials;

pub(crate) use correction::CorrectionBounds;
pub(crate) use taylor::Taylor;

/// What has been proven of one unit's inverse map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Bound of the residual at the reference voltage, `[N, N m]`, the voltage table's error
    /// included.
    pub reference: [f64; 2],
    /// Bound of the residual at every voltage and density in their ranges, `[N, N m]`.
    pub stated: [f64; 2],
    /// The file's tolerance, `[N, N m]`.
    pub tolerance: [f64; 2],
    /// Number of cells.
    pub cells: usize,
    /// Throttles `[u, l]` at the centres of the cells with the largest bounds of f and of Q.
    pub at: [[f64; 2]; 2],
}

impl Certificate {
    /// True where the bound is within the tolerance.
    pub fn holds(&self) -> bool {
        (0..2).all(|k| self.stated[k] <= self.tolerance[k])
    }

    /// False where a residual was observed above its proven bound: then the proof is wrong.
    pub fn agrees(&self, observed: &Residual) -> bool {
        (0..2).all(|k| observed.efforts[k] <= self.reference[k])
    }

    /// Share of the tolerance that is left: the lesser of thrust and torque; negative where it does
    /// not hold.
    pub fn margin(&self) -> f64 {
        let left = |k: usize| 1.0 - self.stated[k] / self.tolerance[k];
        left(0).min(left(1))
    }

    /// Bound at the reference voltage over observed residual, of thrust and of torque.
    pub fn over_observed(&self, observed: &Residual) -> [f64; 2] {
        [0, 1].map(|k| self.reference[k] / observed.efforts[k])
    }
}

/// Cells per side at the start.
const START: usize = 8;

/// Largest number of cells: some 50 ms in a build without optimisation.
const MOST_CELLS: usize = 1600;

/// Largest number of cells while nothing can be said of one of them.
const MOST_UNBOUNDED: usize = 300;

/// Halvings in a row that improve a bound by less than 1 %, after which rounding is all that is
/// left.
const STALE: u8 = 6;

/// How long a proof tries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Patience {
    /// Gives up early where nothing can be said of a cell.
    Quick,
    /// Uses all cells that are allowed.
    Thorough,
}

/// Proves a bound of the errors of the emitted tables. Cells are halved until no bound at the reference
/// voltage is above `aim` (`[N, N m]`), or the work allowed is done.
pub(crate) fn prove(
    view: &View<'_, &Pair>,
    map: &UnitMap,
    correction: &CorrectionBounds,
    aim: [f64; 2],
    patience: Patience,
) -> Certificate {
    let inverse = &view.inverse;
    let tolerance = inverse.tolerances();
    let subject = Subject::new(view, map, correction);
    let whole = ThrottleCell::grid([view.throttle.min, view.throttle.max], START);
    let mut cells = whole.len();
    let mut open: BinaryHeap<Open> = whole
        .into_iter()
        .map(|cell| Open::new(&subject, cell, aim))
        .collect();
    while let Some(worst) = open.peek() {
        let hopeless = cells >= MOST_UNBOUNDED && worst.excess.is_infinite() && patience == Patience::Quick;
        if worst.excess <= 1.0 || worst.stale >= STALE || cells >= MOST_CELLS || hopeless {
            break;
        }
        let Some(worst) = open.pop() else { break };
        for half in worst.cell.halves() {
            let mut part = Open::new(&subject, half, aim);
            if part.excess > 0.99 * worst.excess && worst.excess.is_finite() {
                part.stale = worst.stale + 1;
            }
            open.push(part);
        }
        cells += 1;
    }
    let mut certificate = Certificate {
        reference: [0.0; 2],
        stated: [0.0; 2],
        tolerance,
        cells,
        at: [[0.0; 2]; 2],
    };
    for Open { cell, bound, .. } in open {
        for (k, bound) in bound.into_iter().enumerate() {
            if bound > certificate.reference[k] {
                certificate.reference[k] = bound;
                certificate.at[k] = cell.centre;
            }
        }
    }
    certificate.stated = [0, 1].map(|k| (certificate.reference[k] * correction.largest[k]).next_up());
    certificate
}

/// How far the efforts that the runtime computes of its throttles may be from those of the file's
/// map, and the efforts that the inverse is given from those that were asked: `[N, N m]` at the
/// reference voltage.
pub(crate) fn rounding(view: &View<'_, &Pair>, map: &UnitMap, correction: &CorrectionBounds) -> [f64; 2] {
    let subject = Subject::new(view, map, correction);
    let mut largest = [0.0f64; 2];
    for ThrottleCell { centre, half } in ThrottleCell::grid([view.throttle.min, view.throttle.max], START) {
        let at = [0, 1].map(|k: usize| Taylor::coordinate(centre[k], half[k], k == 1));
        for (k, efforts) in map.pair.efforts(at).into_iter().enumerate() {
            let asked = efforts.magnitude() * subject.input[k];
            largest[k] = largest[k].max(efforts.error() + subject.coefficients[k][0] + asked);
        }
    }
    largest
}

/// A cell with its bound.
struct Open {
    cell: ThrottleCell,
    bound: [f64; 2],
    /// The larger bound in units of what is aimed at.
    excess: f64,
    stale: u8,
}

impl Open {
    fn new(subject: &Subject<'_>, cell: ThrottleCell, aim: [f64; 2]) -> Self {
        let bound = subject.residual(&cell);
        Open {
            cell,
            bound,
            excess: (bound[0] / aim[0]).max(bound[1] / aim[1]),
            stale: 0,
        }
    }

    /// The worst bound first, then by place: the same order on every machine.
    fn key(&self) -> (f64, [f64; 2]) {
        (self.excess, self.cell.centre)
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let ((one, [u1, l1]), (two, [u2, l2])) = (self.key(), other.key());
        one.total_cmp(&two)
            .then(u1.total_cmp(&u2))
            .then(l1.total_cmp(&l2))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

impl<'a> Subject<'a> {
    fn new(view: &View<'_, &Pair>, map: &'a UnitMap, correction: &CorrectionBounds) -> Self {
        let (pair, basis) = (view.of, view.of.basis);
        let gap = |terms: &[f64], rounded: &[f32]| {
            let (mut value, mut derivative) = (0.0, 0.0);
            for ((&(i, j), &term), &rounded) in basis.exponents().iter().zip(terms).zip(rounded) {
                let gap = (term - f64::from(rounded)).abs();
                value += gap;
                derivative += gap * f64::from(i.max(j));
            }
            // Throttles near the box stay below 1 + 2^-8; the factor covers the powers of that and
            // rounding.
            [value, derivative].map(|gap: f64| 1.02 * gap)
        };
        Subject {
            monomials: [&pair.thrust_n, &pair.torque_nm].map(|terms| Monomials::new(basis, terms)),
            pair: &map.pair,
            inverse: &map.inverse,
            throttle: map.throttle,
            input: correction.input,
            coefficients: [
                gap(&pair.thrust_n, map.pair.thrust.coefficients()),
                gap(&pair.torque_nm, map.pair.torque.coefficients()),
            ],
        }
    }
}

impl ThrottleCell {
    /// `side` x `side` cells that cover the box.
    fn grid([low, high]: [f64; 2], side: usize) -> Vec<ThrottleCell> {
        let edge = |k: usize| {
            if k == side {
                high
            } else {
                low + (high - low) * k as f64 / side as f64
            }
        };
        let span = |k: usize| {
            let (from, to) = (edge(k), edge(k + 1));
            let centre = 0.5 * (from + to);
            (centre, (to - centre).max(centre - from).next_up())
        };
        (0..side * side)
            .map(|index| {
                let ((u, half_u), (l, half_l)) = (span(index / side), span(index % side));
                ThrottleCell {
                    centre: [u, l],
                    half: [half_u, half_l],
                }
            })
            .collect()
    }

    /// Two cells that cover this one, cut across the longer side.
    fn halves(&self) -> [ThrottleCell; 2] {
        let axis = usize::from(self.half[1] > self.half[0]);
        let half = (0.5 * self.half[axis]).next_up();
        [-half, half].map(|offset| {
            let mut part = *self;
            part.centre[axis] += offset;
            // What rounding of the centre may leave uncovered.
            part.half[axis] = half + f64::EPSILON;
            part
        })
    }
}

#[cfg(test)]
mod enclosure_tests;
#[cfg(test)]
mod tests;
