//! Interval arithmetic with outward rounding.
//!
//! Each operation rounds to nearest and then moves both ends one float outwards, which encloses the
//! exact result (round to nearest is at most half a unit in the last place off). Exact zeros stay
//! exact.

use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval `[low, high]` that encloses an exact real number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end, not below `low`.
    pub high: f64,
}

impl Interval {
    /// Zero, exactly.
    pub(crate) const ZERO: Interval = Interval { low: 0.0, high: 0.0 };

    /// The number `x`, exactly.
    pub(crate) const fn exact(x: f64) -> Self {
        Interval { low: x, high: x }
    }

    /// The largest absolute value.
    pub(crate) fn magnitude(self) -> f64 {
        self.high.max(-self.low)
    }

    /// True where no number of the interval is positive.
    pub(crate) fn is_not_positive(self) -> bool {
        self.high <= 0.0
    }

    /// Half of the interval (exact but for underflow).
    pub(crate) fn half(self) -> Self {
        Interval {
            low: self.low * 0.5,
            high: self.high * 0.5,
        }
    }

    fn widened(low: f64, high: f64) -> Self {
        Interval {
            low: low.next_down(),
            high: high.next_up(),
        }
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, other: Interval) -> Interval {
        if self == Interval::ZERO {
            return other;
        }
        if other == Interval::ZERO {
            return self;
        }
        Interval::widened(self.low + other.low, self.high + other.high)
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval {
            low: -self.high,
            high: -self.low,
        }
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, other: Interval) -> Interval {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, other: Interval) -> Interval {
        if self == Interval::ZERO || other == Interval::ZERO {
            return Interval::ZERO;
        }
        let products = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        let low = products.into_iter().fold(f64::INFINITY, f64::min);
        let high = products.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Interval::widened(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums and products of floats with 26-bit mantissas are exact in f64 when few: a reference
    /// without rounding.
    #[test]
    fn encloses_exact_results() {
        let mut state = 7u64;
        let mut small = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 40) as f64) - 8_388_608.0
        };
        for _ in 0..10_000 {
            let (a, b, c) = (small(), small(), small());
            let exact = a * b + c; // 24 + 24 bits: exact
            let third = Interval {
                low: (a / 3.0).next_down(),
                high: (a / 3.0).next_up(),
            };
            let result = third * Interval::exact(3.0) * Interval::exact(b) + Interval::exact(c);
            assert!(result.low <= exact && exact <= result.high);
            assert!(result.high - result.low <= 1e-12 * (a * b).abs() + 1e-9);
        }
    }
}
