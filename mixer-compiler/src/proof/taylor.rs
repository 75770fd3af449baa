//! Taylor models of degree two: functions of a point in a cell, with bounds of all that is left
//! out.
//!
//! A cell is the image of a, b in [-1, 1]. A [`Taylor`] stands for a real function of (a, b) and
//! encloses it:
//!
//! ```text
//! |x(a, b) - (c + ca a + cb b + caa a2 + cab a b + cbb b2)| <= remainder
//! ```
//!
//! It stands as well for what the runtime computes in its place: `|x in f32 - x| <= error`, by the
//! standard model fl(x) = x (1 + e), sharpened to half a unit in the last place of the largest
//! result. As it implements [`Scalar`], `mixer-rt` itself runs over it.
//!
//! Coefficients are computed in f64, rounded to nearest. Each is a sum of at most four products, so
//! their errors add up to less than 8 x 2^-53 times the product of the factors' norms, which goes
//! to the remainder. Remainders and errors are sums of fewer than 40 non-negative terms; the factor
//! [`UP`] makes up for their rounding.

mod scalar;

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::bounds::interval::Interval;

/// See the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Taylor {
    c: f64,
    a: f64,
    b: f64,
    aa: f64,
    ab: f64,
    bb: f64,
    remainder: f64,
    error: f64,
}

/// Factor above what fewer than 40 roundings to nearest can take away.
const UP: f64 = 1.0 + 64.0 * f64::EPSILON;

/// Eight roundings of one half unit each.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Above what underflow takes away, in f64 and in f32.
const TINY: f64 = 1e-45;

/// Beyond it f32 might overflow.
const HUGE: f64 = 1e38;

/// Half a unit in the last place in f32 of results of size up to `size`.
fn half_unit(size: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    const HALF_UNIT: f64 = 1.0 / 16_777_216.0;
    if size < HUGE {
        f64::from_bits(size.to_bits() & EXPONENT) * HALF_UNIT + TINY
    } else {
        f64::INFINITY
    }
}

impl Taylor {
    /// The coordinate `centre + half * a`, or with b if `second`.
    pub(crate) fn coordinate(centre: f64, half: f64, second: bool) -> Self {
        let mut x = Taylor::exact(centre);
        *(if second { &mut x.b } else { &mut x.a }) = half;
        x
    }

    /// The number x.
    pub(crate) const fn exact(x: f64) -> Self {
        Taylor {
            c: x,
            a: 0.0,
            b: 0.0,
            aa: 0.0,
            ab: 0.0,
            bb: 0.0,
            remainder: 0.0,
            error: 0.0,
        }
    }

    /// Any number within `radius` of zero.
    pub(crate) const fn ball(radius: f64) -> Self {
        let mut x = Taylor::exact(0.0);
        x.remainder = radius;
        x
    }

    /// Any number of the interval.
    pub(crate) fn from_interval(interval: Interval) -> Self {
        let centre = 0.5 * (interval.low + interval.high);
        let radius = (interval.high - centre).max(centre - interval.low);
        Taylor {
            c: centre,
            ..Taylor::ball(radius * UP)
        }
    }

    /// The function with these coefficients of 1, a, b, a2, ab, b2 and this remainder.
    pub(crate) const fn new([c, a, b, aa, ab, bb]: [f64; 6], remainder: f64) -> Self {
        let error = 0.0;
        Taylor {
            c,
            a,
            b,
            aa,
            ab,
            bb,
            remainder,
            error,
        }
    }

    /// Coefficients of 1, a, b, a2, ab, b2.
    #[cfg(test)]
    pub(crate) fn coefficients(&self) -> [f64; 6] {
        [self.c, self.a, self.b, self.aa, self.ab, self.bb]
    }

    /// Bound of what the coefficients leave out.
    #[cfg(test)]
    pub(crate) fn remainder(&self) -> f64 {
        self.remainder
    }

    /// Bound of the runtime's rounding error so far.
    pub(crate) fn error(self) -> f64 {
        self.error
    }

    /// What the runtime computes: its error counts as part of the function from here on.
    #[must_use]
    pub(crate) fn computed(self) -> Self {
        self.widened(self.error).real()
    }

    /// The function alone: operations from here on have no rounding behind them but their own.
    #[must_use]
    pub(crate) fn real(mut self) -> Self {
        self.error = 0.0;
        self
    }

    /// With a given error of the runtime.
    #[must_use]
    pub(crate) fn with_error(mut self, error: f64) -> Self {
        self.error = error;
        self
    }

    /// With a larger remainder.
    #[must_use]
    pub(crate) fn widened(mut self, radius: f64) -> Self {
        self.remainder = (self.remainder + radius) * UP;
        self
    }

    fn linear(&self) -> f64 {
        self.a.abs() + self.b.abs()
    }

    fn quadratic(&self) -> f64 {
        self.aa.abs() + self.ab.abs() + self.bb.abs()
    }

    /// Bound of the absolute value.
    pub(crate) fn magnitude(&self) -> f64 {
        (self.c.abs() + self.linear() + self.quadratic() + self.remainder) * UP
    }

    /// An enclosure of all values.
    pub(crate) fn range(&self) -> Interval {
        // a2 and b2 lie in [0, 1].
        let spread = self.linear() + self.ab.abs() + self.remainder;
        let (mut below, mut above) = (spread, spread);
        for square in [self.aa, self.bb] {
            if square > 0.0 {
                above += square;
            } else {
                below -= square;
            }
        }
        let slack = ROUNDING * (self.c.abs() + below + above);
        Interval {
            low: self.c - (below * UP + slack),
            high: self.c + (above * UP + slack),
        }
    }

    /// False where a bound was lost: division by something that may be zero, overflow.
    pub(crate) fn is_bounded(&self) -> bool {
        self.magnitude() < HUGE && self.error < HUGE
    }

    /// Adds the rounding of one operation in f32 to the error carried over.
    fn rounded(mut self, carried: f64) -> Self {
        let half = half_unit(self.magnitude() + carried);
        self.error = (carried + half) * UP;
        self
    }

    /// The sum of the functions, with no operation of the runtime behind it.
    pub(crate) fn plus(&self, other: &Taylor) -> Taylor {
        let mut sum = Taylor {
            c: self.c + other.c,
            a: self.a + other.a,
            b: self.b + other.b,
            aa: self.aa + other.aa,
            ab: self.ab + other.ab,
            bb: self.bb + other.bb,
            remainder: 0.0,
            error: 0.0,
        };
        let size = sum.c.abs() + sum.linear() + sum.quadratic();
        sum.remainder = (self.remainder + other.remainder + ROUNDING * size) * UP;
        sum
    }

    fn scaled(&self, factor: f64) -> Taylor {
        let mut product = Taylor {
            c: self.c * factor,
            a: self.a * factor,
            b: self.b * factor,
            aa: self.aa * factor,
            ab: self.ab * factor,
            bb: self.bb * factor,
            remainder: 0.0,
            error: 0.0,
        };
        let size = product.c.abs() + product.linear() + product.quadratic();
        product.remainder = (self.remainder * factor.abs() + ROUNDING * size + TINY) * UP;
        product
    }

    /// The product with a number within `radius` of `centre`, with no operation of the runtime
    /// behind it.
    pub(crate) fn times(&self, centre: f64, radius: f64) -> Taylor {
        self.scaled(centre).widened(self.magnitude() * radius)
    }

    /// The product of the functions, with no operation of the runtime behind it.
    pub(crate) fn product(&self, other: &Taylor) -> Taylor {
        let (x, y) = (self, other);
        let (x1, x2, y1, y2) = (x.linear(), x.quadratic(), y.linear(), y.quadratic());
        let (x_norm, y_norm) = (x.c.abs() + x1 + x2, y.c.abs() + y1 + y2);
        let beyond = x1 * y2 + x2 * y1 + x2 * y2;
        let remainder = beyond
            + x_norm * y.remainder
            + x.remainder * y_norm
            + x.remainder * y.remainder
            + ROUNDING * x_norm * y_norm
            + TINY;
        Taylor {
            c: x.c * y.c,
            a: x.c * y.a + x.a * y.c,
            b: x.c * y.b + x.b * y.c,
            aa: x.c * y.aa + x.a * y.a + x.aa * y.c,
            ab: x.c * y.ab + x.a * y.b + x.b * y.a + x.ab * y.c,
            bb: x.c * y.bb + x.b * y.b + x.bb * y.c,
            remainder: remainder * UP,
            error: 0.0,
        }
    }

    /// `p(x)` for a function with value, slope and half its second derivative `[p0, p1, p2]` at the
    /// centre c, and a bound of what Taylor's formula leaves. The coefficients may be off by a few
    /// roundings.
    fn composed(&self, [p0, p1, p2]: [f64; 3], rest: f64) -> Taylor {
        let variable = Taylor {
            c: 0.0,
            error: 0.0,
            ..*self
        };
        let mut result = variable.scaled(p1).plus(&variable.product(&variable).scaled(p2));
        result.c += p0;
        let size = variable.magnitude();
        let roundings = p0.abs() + p1.abs() * size + p2.abs() * size * size;
        result.widened(rest + 2.0 * ROUNDING * roundings)
    }

    fn unbounded() -> Taylor {
        Taylor::ball(f64::INFINITY).with_error(f64::INFINITY)
    }
}

impl Neg for Taylor {
    type Output = Taylor;
    fn neg(self) -> Taylor {
        Taylor {
            c: -self.c,
            a: -self.a,
            b: -self.b,
            aa: -self.aa,
            ab: -self.ab,
            bb: -self.bb,
            ..self
        }
    }
}

impl Add for Taylor {
    type Output = Taylor;
    fn add(self, other: Taylor) -> Taylor {
        self.plus(&other).rounded(self.error + other.error)
    }
}

impl Sub for Taylor {
    type Output = Taylor;
    fn sub(self, other: Taylor) -> Taylor {
        self + -other
    }
}

impl Mul for Taylor {
    type Output = Taylor;
    fn mul(self, other: Taylor) -> Taylor {
        let mut carried = 0.0;
        if self.error != 0.0 || other.error != 0.0 {
            carried =
                self.magnitude() * other.error + self.error * other.magnitude() + self.error * other.error;
        }
        self.product(&other).rounded(carried)
    }
}

impl Add<f32> for Taylor {
    type Output = Taylor;
    fn add(self, constant: f32) -> Taylor {
        let mut sum = self;
        sum.c += f64::from(constant);
        sum.widened(ROUNDING * sum.c.abs()).rounded(self.error)
    }
}

impl Mul<f32> for Taylor {
    type Output = Taylor;
    fn mul(self, constant: f32) -> Taylor {
        let factor = f64::from(constant);
        self.scaled(factor).rounded(self.error * factor.abs())
    }
}

impl Div<f32> for Taylor {
    type Output = Taylor;
    fn div(self, constant: f32) -> Taylor {
        let factor = 1.0 / f64::from(constant);
        let carried = self.error * factor.abs() * UP;
        self.times(factor, factor.abs() * f64::EPSILON).rounded(carried)
    }
}

impl Taylor {
    /// Bound of the distance from the centre c.
    fn deviation(&self) -> f64 {
        (self.linear() + self.quadratic() + self.remainder) * UP
    }
}
