//! The inverse map of one unit: efforts (f, Q) at the reference voltage to throttles (u, l).
//!
//! The inverse behaves like a square root, so a polynomial in (f, Q) converges slowly. In the
//! coordinates
//!
//! ```text
//! x = sqrt(x0 f + x1 Q + x2)        y = sqrt(y0 f + y1 Q + y2)
//! ```
//!
//! it is almost bilinear; a polynomial of low degree there and a Newton step on the forward map reach
//! millinewtons. Outside the attainable set the radicands, the polynomials' values and every iterate
//! are clamped, so the result is continuous and always a pair of throttles within the range.

use super::forward::{Pair, Quantity};
use crate::arithmetic::Scalar;

/// The allowed throttles of every rotor, `0 <= min < max <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrottleRange {
    /// Idle: no rotor is ever commanded below.
    pub min: f32,
    /// No rotor is ever commanded above.
    pub max: f32,
}

impl ThrottleRange {
    /// `throttle` limited to the range; some throttle of the range where it is NaN.
    #[inline(always)]
    pub fn clamp<S: Scalar>(&self, throttle: S) -> S {
        throttle.within_positive(self.min, self.max)
    }
}

/// An inverse map.
pub trait Inverse {
    /// Throttles `[u, l]` within `range` at which `pair` gives `efforts` (N, N m at the reference
    /// voltage), or throttles near by where it cannot.
    fn throttles<P: Quantity>(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2];
}

/// A polynomial of total degree d in two variables for each throttle, then `STEPS` Newton steps on the
/// forward map.
///
/// Before Newton steps the variables are the roots x and y; without any they are the linear forms
/// themselves, limited to [-1, 1]: the paper's inverse (section IV-B2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialInverse<C, const STEPS: usize> {
    /// `[x0, x1, x2]` of the linear form `x0 f + x1 Q + x2` of x, in 1/N, 1/(N m) and 1; those of y.
    pub forms: [[f32; 3]; 2],
    /// Coefficients of the upper throttle.
    pub upper: C,
    /// Coefficients of the lower throttle.
    pub lower: C,
}

/// Coefficients of a polynomial of total degree d in two variables, (d + 1)(d + 2) / 2 of them: for i
/// = 0..=d (descending powers d - i of x), for j = 0..=i (descending powers i - j of y).
pub trait Coefficients {
    /// Total degree d.
    fn degree(&self) -> usize;

    /// The coefficients.
    fn numbers(&self) -> &[f32];
}

impl<const TERMS: usize> Coefficients for [f32; TERMS] {
    #[inline(always)]
    fn degree(&self) -> usize {
        const { degree(TERMS) }
    }

    #[inline(always)]
    fn numbers(&self) -> &[f32] {
        self
    }
}

/// Of a polynomial whose degree is not known beforehand.
impl Coefficients for &[f32] {
    fn degree(&self) -> usize {
        degree(self.len())
    }

    fn numbers(&self) -> &[f32] {
        self
    }
}

/// The total degree of a polynomial of so many terms.
const fn degree(terms: usize) -> usize {
    let mut degree = 0;
    while (degree + 1) * (degree + 2) / 2 < terms {
        degree += 1;
    }
    degree
}

impl<C: Coefficients, const STEPS: usize> PolynomialInverse<C, STEPS> {
    /// The polynomials' `[u, l]`, not clamped.
    #[inline(always)]
    pub fn guess<S: Scalar>(&self, [f, q]: [S; 2]) -> [S; 2] {
        let [x, y] = self.forms.map(|[by_f, by_q, offset]| {
            let form = f * by_f + q * by_q + offset;
            if STEPS == 0 {
                form.within(-1.0, 1.0)
            } else {
                form.root()
            }
        });
        [&self.upper, &self.lower].map(|coefficients| evaluate(coefficients, x, y))
    }
}

impl<C: Coefficients, const STEPS: usize> Inverse for PolynomialInverse<C, STEPS> {
    #[inline(always)]
    fn throttles<P: Quantity>(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        let mut throttles = self.guess(efforts).map(|throttle| range.clamp(throttle));
        for _ in 0..STEPS {
            let (given, jacobian) = pair.efforts_and_jacobian(throttles);
            let step = solve(jacobian, [efforts[0] - given[0], efforts[1] - given[1]]);
            throttles = [0, 1].map(|k| range.clamp(throttles[k] + step[k]));
        }
        throttles
    }
}

/// Horner's rule in both variables; powers of x without all their coefficients are left out.
// Compilers unroll these loops where the degree is known; those of nested ranges of it not all of
// them do.
#[inline(always)]
fn evaluate<C: Coefficients, S: Scalar>(coefficients: &C, x: S, y: S) -> S {
    let mut rest = coefficients.numbers();
    let mut value = None;
    for i in 0..coefficients.degree() + 1 {
        let Some((row, after)) = rest.split_at_checked(i + 1) else {
            break;
        };
        rest = after;
        let row = horner(row, y);
        value = Some(match value {
            Some(value) => row + x * value,
            None => row,
        });
    }
    value.unwrap_or(S::constant(0.0))
}

/// `c0 y^k + c1 y^(k-1) + .. + ck`.
#[inline(always)]
fn horner<S: Scalar>(coefficients: &[f32], y: S) -> S {
    let Some((&first, rest)) = coefficients.split_first() else {
        return S::constant(0.0);
    };
    rest.iter()
        .fold(S::constant(first), |value, &coefficient| value * y + coefficient)
}

/// The step (du, dl) with J (du, dl) = `missing`, by Cramer's rule. The compiler has proven det J >
/// 0 over the range, so the quotient is finite.
#[inline(always)]
pub fn solve<S: Scalar>([[f_u, f_l], [q_u, q_l]]: [[S; 2]; 2], [f, q]: [S; 2]) -> [S; 2] {
    let per_det = (f_u * q_l - f_l * q_u).reciprocal();
    [(f * q_l - q * f_l) * per_det, (q * f_u - f * q_u) * per_det]
}
