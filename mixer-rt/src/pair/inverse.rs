//! The inverse map of one unit: efforts (f, Q) at the reference voltage to throttles (u, l).
//!
//! The inverse behaves like a square root, so a polynomial in (f, Q) converges slowly. In the
//! coordinates
//!
//! ```text
//! x = sqrt(x0 f + x1 Q + x2)        y = sqrt(y0 f + y1 Q + y2)
//! ```
//!
//! it is almost bilinear; a seed there and a Newton step on the forward map reach millinewtons.
//! Outside the attainable set the radicands, the seed and every iterate are clamped, so the result
//! is continuous and always a pair of throttles within the range.

use super::forward::{Pair, Quantity};
use crate::arithmetic::Scalar;

/// The allowed throttles of every rotor, `0 <= min < max <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrottleRange {
    /// Idle: no rotor is ever commanded below.
    pub min: f32,
    /// The ceiling.
    pub max: f32,
}

impl ThrottleRange {
    /// `throttle` limited to the range; some throttle of the range where it is NaN.
    #[inline(always)]
    pub fn clamp<S: Scalar>(&self, throttle: S) -> S {
        throttle.within_positive(self.min, self.max)
    }
}

/// An evaluator of the inverse map.
pub trait Inverse<P> {
    /// Throttles `[u, l]` within `range` at which `pair` gives `[f, Q]` (N, N m at the reference
    /// voltage), or throttles near by where it cannot.
    fn throttles(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2];
}

/// The paper's evaluator (section IV-B2): a polynomial in (f, Q) of given total degree for each
/// throttle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialInverse<'a> {
    /// Scale and offset of f: the polynomial's first variable is `scale f + offset`, in [-1, 1].
    pub thrust: [f32; 2],
    /// Scale and offset of Q, likewise.
    pub torque: [f32; 2],
    /// Total degree d.
    pub degree: u8,
    /// Coefficients of the upper throttle, (d + 1)(d + 2) / 2 of them: for i = 0..=d (descending
    /// powers d - i of the first variable), for j = 0..=i (descending powers i - j of the second).
    pub upper: &'a [f32],
    /// Coefficients of the lower throttle, likewise.
    pub lower: &'a [f32],
}

impl PolynomialInverse<'_> {
    /// `[u, l]`, not clamped.
    #[inline(always)]
    pub fn guess<S: Scalar>(&self, [f, q]: [S; 2]) -> [S; 2] {
        let s = (f * self.thrust[0] + self.thrust[1]).within(-1.0, 1.0);
        let t = (q * self.torque[0] + self.torque[1]).within(-1.0, 1.0);
        [self.evaluate(self.upper, s, t), self.evaluate(self.lower, s, t)]
    }

    /// Horner's rule in both variables; powers of the first variable without all their coefficients
    /// are left out.
    // Compilers unroll these loops where the degree is known; those of nested ranges of it not all
    // of them do.
    #[inline(always)]
    fn evaluate<S: Scalar>(&self, coefficients: &[f32], s: S, t: S) -> S {
        let mut rest = coefficients;
        let mut value = S::constant(0.0);
        for i in 0..usize::from(self.degree) + 1 {
            let Some((row, after)) = rest.split_at_checked(i + 1) else {
                break;
            };
            rest = after;
            let row = row
                .iter()
                .fold(S::constant(0.0), |row, coefficient| row * t + *coefficient);
            value = value * s + row;
        }
        value
    }
}

impl<P> Inverse<P> for PolynomialInverse<'_> {
    #[inline(always)]
    fn throttles(&self, _: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        self.guess(efforts).map(|throttle| range.clamp(throttle))
    }
}

/// The coordinates x and y in which the inverse is almost bilinear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootCoordinates {
    /// `[x0, x1, x2]` of `x = sqrt(x0 f + x1 Q + x2)`, in 1/N, 1/(N m) and 1.
    pub x: [f32; 3],
    /// `[y0, y1, y2]`, likewise.
    pub y: [f32; 3],
}

impl RootCoordinates {
    /// `[x, y]` at the efforts `[f, Q]`; negative radicands count as zero.
    #[inline(always)]
    pub fn at<S: Scalar>(&self, [f, q]: [S; 2]) -> [S; 2] {
        let root = |[by_f, by_q, offset]: [f32; 3]| (f * by_f + q * by_q + offset).root();
        [root(self.x), root(self.y)]
    }
}

/// A first guess of the throttles from the coordinates (x, y).
pub trait Seed {
    /// `[u, l]`, not clamped.
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2];
}

/// Terms 1, x, y, xy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BilinearSeed {
    /// Coefficients of the upper throttle.
    pub upper: [f32; 4],
    /// Coefficients of the lower throttle.
    pub lower: [f32; 4],
}

impl Seed for BilinearSeed {
    #[inline(always)]
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2] {
        let evaluate = |[c, cx, cy, cxy]: [f32; 4]| (y * cxy + cx) * x + (y * cy + c);
        [evaluate(self.upper), evaluate(self.lower)]
    }
}

/// Terms 1, x, y, xy, x2, y2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticSeed {
    /// Coefficients of the upper throttle.
    pub upper: [f32; 6],
    /// Coefficients of the lower throttle.
    pub lower: [f32; 6],
}

impl Seed for QuadraticSeed {
    #[inline(always)]
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2] {
        let evaluate =
            |[c, cx, cy, cxy, cx2, cy2]: [f32; 6]| (x * cx2 + (y * cxy + cx)) * x + ((y * cy2 + cy) * y + c);
        [evaluate(self.upper), evaluate(self.lower)]
    }
}

/// Terms 1, x, y, xy, x2, y2, x2y, xy2, x3, y3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicSeed {
    /// Coefficients of the upper throttle.
    pub upper: [f32; 10],
    /// Coefficients of the lower throttle.
    pub lower: [f32; 10],
}

impl Seed for CubicSeed {
    #[inline(always)]
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2] {
        let evaluate = |[c, cx, cy, cxy, cx2, cy2, cx2y, cxy2, cx3, cy3]: [f32; 10]| {
            ((x * cx3 + (y * cx2y + cx2)) * x + ((y * cxy2 + cxy) * y + cx)) * x
                + (((y * cy3 + cy2) * y + cy) * y + c)
        };
        [evaluate(self.upper), evaluate(self.lower)]
    }
}

/// A seed in root coordinates and `STEPS` Newton steps on the forward map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seeded<S, const STEPS: usize> {
    /// The coordinates of the seed.
    pub coordinates: RootCoordinates,
    /// The seed.
    pub seed: S,
}

impl<P: Quantity, S: Seed, const STEPS: usize> Inverse<P> for Seeded<S, STEPS> {
    #[inline(always)]
    fn throttles(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2] {
        let [x, y] = self.coordinates.at(efforts);
        let mut throttles = self.seed.guess(x, y).map(|throttle| range.clamp(throttle));
        for _ in 0..STEPS {
            let (given, jacobian) = pair.efforts_and_jacobian(throttles);
            let step = solve(jacobian, [efforts[0] - given[0], efforts[1] - given[1]]);
            throttles = [0, 1].map(|k| range.clamp(throttles[k] + step[k]));
        }
        throttles
    }
}

/// The step (du, dl) with J (du, dl) = `missing`, by Cramer's rule. The compiler has proven det J >
/// 0 over the range, so the quotient is finite.
#[inline(always)]
pub fn solve<S: Scalar>([[f_u, f_l], [q_u, q_l]]: [[S; 2]; 2], [f, q]: [S; 2]) -> [S; 2] {
    let per_det = (f_u * q_l - f_l * q_u).reciprocal();
    [(f * q_l - q * f_l) * per_det, (q * f_u - f * q_u) * per_det]
}
