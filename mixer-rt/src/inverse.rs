//! The inverse map of one unit: efforts (f, Q) at the reference voltage to throttles (u, l).
//!
//! The inverse behaves like a square root, so a polynomial in (f, Q) converges slowly. In the coordinates
//!
//! ```text
//! x = sqrt(x0 f + x1 Q + x2)        y = sqrt(y0 f + y1 Q + y2)
//! ```
//!
//! it is almost bilinear; a seed there and a Newton step on the forward map reach millinewtons. Outside the
//! attainable set the radicands, the seed and every iterate are clamped, so the result is continuous and always a
//! pair of throttles within the range.

use crate::{Pair, Quantity, clamp, sqrt};

/// The allowed throttles of every rotor, `0 <= min < max <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrottleRange {
    /// Idle: no rotor is ever commanded below.
    pub min: f32,
    /// The ceiling.
    pub max: f32,
}

impl ThrottleRange {
    /// `throttle` limited to the range; idle where it is NaN.
    #[inline(always)]
    pub fn clamp(&self, throttle: f32) -> f32 {
        clamp(throttle, self.min, self.max)
    }
}

/// An evaluator of the inverse map.
pub trait Inverse<P> {
    /// Throttles `[u, l]` within `range` at which `pair` gives `[f, Q]` (N, N m at the reference voltage), or
    /// throttles near by where it cannot.
    fn throttles(&self, pair: &Pair<P>, range: &ThrottleRange, efforts: [f32; 2]) -> [f32; 2];
}

/// The paper's evaluator (section IV-B2): a polynomial in (f, Q) of given total degree for each throttle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialInverse<'a> {
    /// Scale and offset of f: the polynomial's first variable is `scale f + offset`, in [-1, 1].
    pub thrust: [f32; 2],
    /// Scale and offset of Q, likewise.
    pub torque: [f32; 2],
    /// Total degree d.
    pub degree: u8,
    /// Coefficients of the upper throttle, (d + 1)(d + 2) / 2 of them: for i = 0..=d (descending powers d - i of
    /// the first variable), for j = 0..=i (descending powers i - j of the second).
    pub upper: &'a [f32],
    /// Coefficients of the lower throttle, likewise.
    pub lower: &'a [f32],
}

impl PolynomialInverse<'_> {
    /// Horner's rule in both variables; terms beyond the coefficients count as zero.
    #[inline]
    fn evaluate(&self, coefficients: &[f32], s: f32, t: f32) -> f32 {
        let mut rest = coefficients.iter();
        let mut value = 0.0;
        for i in 0..=self.degree {
            let mut row = 0.0;
            for _ in 0..=i {
                if let Some(coefficient) = rest.next() {
                    row = row * t + coefficient;
                }
            }
            value = value * s + row;
        }
        value
    }
}

impl<P> Inverse<P> for PolynomialInverse<'_> {
    #[inline(always)]
    fn throttles(&self, _: &Pair<P>, range: &ThrottleRange, [f, q]: [f32; 2]) -> [f32; 2] {
        let s = clamp(self.thrust[0] * f + self.thrust[1], -1.0, 1.0);
        let t = clamp(self.torque[0] * q + self.torque[1], -1.0, 1.0);
        [
            range.clamp(self.evaluate(self.upper, s, t)),
            range.clamp(self.evaluate(self.lower, s, t)),
        ]
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
    #[inline(always)]
    fn at(&self, [f, q]: [f32; 2]) -> [f32; 2] {
        let root = |[by_f, by_q, offset]: [f32; 3]| {
            let radicand = by_f * f + by_q * q + offset;
            sqrt(if radicand > 0.0 { radicand } else { 0.0 })
        };
        [root(self.x), root(self.y)]
    }
}

/// A first guess of the throttles from the coordinates (x, y).
pub trait Seed {
    /// `[u, l]`, not clamped.
    fn guess(&self, x: f32, y: f32) -> [f32; 2];
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
    fn guess(&self, x: f32, y: f32) -> [f32; 2] {
        let evaluate = |[c, cx, cy, cxy]: [f32; 4]| (cxy * y + cx) * x + (cy * y + c);
        [evaluate(self.upper), evaluate(self.lower)]
    }
}

/// Terms 1, x, y, xy, x2, y2, x2y, xy2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EightTermSeed {
    /// Coefficients of the upper throttle.
    pub upper: [f32; 8],
    /// Coefficients of the lower throttle.
    pub lower: [f32; 8],
}

impl Seed for EightTermSeed {
    #[inline(always)]
    fn guess(&self, x: f32, y: f32) -> [f32; 2] {
        let evaluate = |[c, cx, cy, cxy, cx2, cy2, cx2y, cxy2]: [f32; 8]| {
            ((cx2y * y + cx2) * x + ((cxy2 * y + cxy) * y + cx)) * x + ((cy2 * y + cy) * y + c)
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
        let [mut u, mut l] = self.seed.guess(x, y).map(|throttle| range.clamp(throttle));
        for _ in 0..STEPS {
            let [step_u, step_l] = newton_step(pair, u, l, efforts);
            u = range.clamp(u + step_u);
            l = range.clamp(l + step_l);
        }
        [u, l]
    }
}

/// The Newton step from (u, l) towards the efforts (f, Q). The compiler has proven det J > 0 over the range, so
/// the quotient is finite.
#[inline(always)]
fn newton_step<P: Quantity>(pair: &Pair<P>, u: f32, l: f32, [f, q]: [f32; 2]) -> [f32; 2] {
    let [thrust, thrust_u, thrust_l] = pair.thrust.value_and_gradient(u, l);
    let [torque, torque_u, torque_l] = pair.torque.value_and_gradient(u, l);
    let (missing_f, missing_q) = (f - thrust, q - torque);
    let per_det = 1.0 / (thrust_u * torque_l - thrust_l * torque_u);
    [
        (missing_f * torque_l - missing_q * thrust_l) * per_det,
        (missing_q * thrust_u - missing_f * torque_u) * per_det,
    ]
}
