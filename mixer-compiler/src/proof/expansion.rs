//! The quantities of the pair, expanded about the throttles of a box.
//!
//! They are polynomials, so Taylor's formula is exact. For a point t of the box and a step v
//!
//! ```text
//! F(t + v) = sum over i, j of F^(i,j)(t) / (i! j!) vu^i vl^j
//! ```
//!
//! Each coefficient is known over the box by its centre and its radius.

use super::taylor::Taylor;
use crate::airframe::{Basis, POWERS};
use crate::bounds::interval::Interval;

/// Coefficients by exponents of u and l.
type Coefficients = [[f64; POWERS]; POWERS];

/// A quantity of the airframe file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Monomials {
    coefficients: Coefficients,
    /// By orders of the derivative by u, how many by l do not vanish.
    columns: [usize; POWERS],
    /// Sum of absolute coefficients.
    size: f64,
}

impl Monomials {
    /// Of a basis, with the coefficients of the file.
    pub(super) fn new(basis: Basis, terms: &[f64]) -> Self {
        let (mut coefficients, mut columns) = ([[0.0; POWERS]; POWERS], [0; POWERS]);
        for (&(i, j), &term) in basis.exponents().iter().zip(terms) {
            let [i, j] = [i, j].map(usize::from);
            coefficients[i][j] = term;
            for columns in &mut columns[..=i] {
                *columns = (j + 1).max(*columns);
            }
        }
        Monomials {
            coefficients,
            columns,
            size: terms.iter().map(|term| term.abs()).sum(),
        }
    }

    /// Coefficients of another polynomial of the same monomials at `by` + x, Horner's scheme.
    fn shifted(&self, mut coefficients: Coefficients, by: [f64; 2]) -> Coefficients {
        let rows = self.columns.iter().take_while(|columns| **columns > 0).count();
        for (row, &columns) in coefficients.iter_mut().zip(&self.columns) {
            for start in 1..columns {
                for j in (start..columns).rev() {
                    row[j - 1] += by[1] * row[j];
                }
            }
        }
        for start in 1..rows {
            for i in (start..rows).rev() {
                let above = coefficients[i];
                for (below, above) in coefficients[i - 1].iter_mut().zip(above).take(self.columns[i]) {
                    *below += by[0] * above;
                }
            }
        }
        coefficients
    }
}

/// F^(i,j) / (i! j!) of both quantities over a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expansion([Coefficient; 2]);

/// Of one quantity, by orders.
#[derive(Clone, Copy, Debug)]
struct Coefficient {
    centre: Coefficients,
    radius: Coefficients,
    columns: [usize; POWERS],
}

/// Roundings in a coefficient or its radius: each is a sum of products built in at most 16 operations, and with
/// throttles of size s their absolute values add up to at most 2^8 s^8 times the sum of absolute coefficients.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

impl Expansion {
    /// Over a box.
    pub(super) fn new(monomials: &[Monomials; 2], over: [Interval; 2]) -> Self {
        let centre = over.map(|range| 0.5 * (range.low + range.high));
        let half = [0, 1].map(|k| (over[k].high - centre[k]).max(centre[k] - over[k].low).next_up());
        let size = over.map(Interval::magnitude).into_iter().fold(1.0, f64::max);
        let power = (1..2 * POWERS - 1).fold(1.0, |power, _| power * size);
        Expansion(monomials.each_ref().map(|monomials| {
            let rounding = ROUNDING * monomials.size * power;
            let centre = monomials.shifted(monomials.coefficients, centre);
            let absolute = centre.map(|row| row.map(f64::abs));
            let mut radius = monomials.shifted(absolute, half);
            for (radius, absolute) in radius.iter_mut().flatten().zip(absolute.iter().flatten()) {
                *radius += rounding - absolute;
            }
            Coefficient {
                centre,
                radius,
                columns: monomials.columns,
            }
        }))
    }

    /// The sums over i + j >= `least` of F^(i,j)(t) / (i! j!) vu^i vl^j.
    pub(super) fn sums(&self, v: &[Taylor; 2], least: usize) -> [Taylor; 2] {
        let powers = v.each_ref().map(|v| {
            let mut powers = [Taylor::exact(1.0); POWERS];
            for i in 1..POWERS {
                powers[i] = powers[i - 1].product(v);
            }
            powers
        });
        self.0.each_ref().map(|of| {
            let mut sum = Taylor::exact(0.0);
            for (i, &columns) in of.columns.iter().enumerate() {
                let known = of.centre[i].iter().zip(&of.radius[i]).zip(&powers[1]);
                let known = known.take(columns).skip(least.saturating_sub(i));
                let row = known.fold(Taylor::exact(0.0), |row, ((centre, radius), power)| {
                    row.plus(&power.times(*centre, *radius))
                });
                sum = sum.plus(&powers[0][i].product(&row));
            }
            sum
        })
    }

    /// Bound of the absolute derivative of this order along one axis, over its factorial, of f or of Q.
    pub(super) fn along(&self, quantity: usize, axis: usize, order: usize) -> f64 {
        let of = &self.0[quantity];
        let mut orders = [0; 2];
        orders[axis] = order;
        let [i, j] = orders;
        of.centre[i][j].abs() + of.radius[i][j]
    }
}
