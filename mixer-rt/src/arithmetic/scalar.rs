//! The arithmetic of the forward and the inverse map.
//!
//! At run time a [`Scalar`] is an `f32` and every method is one or two instructions. The compiler
//! runs the same functions over numbers that carry bounds, so what it proves is about these very
//! operations, in this order.

use core::ops::{Add, Div, Mul, Sub};

use super::sqrt::sqrt;

/// A number that tables in `f32` are applied to. Every operation stands for one operation in `f32`,
/// rounded to nearest.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// The number of a table.
    fn constant(value: f32) -> Self;

    /// 1 / self.
    fn reciprocal(self) -> Self;

    /// The square root of the larger of self and zero.
    fn root(self) -> Self;

    /// Self limited to `[low, high]`; `low` where it is NaN.
    fn within(self, low: f32, high: f32) -> Self;

    /// [`Scalar::within`] for `0 <= low < high`; any value of the range where it is NaN.
    #[inline(always)]
    fn within_positive(self, low: f32, high: f32) -> Self {
        self.within(low, high)
    }
}

impl Scalar for f32 {
    #[inline(always)]
    fn constant(value: f32) -> f32 {
        value
    }

    #[inline(always)]
    fn reciprocal(self) -> f32 {
        1.0 / self
    }

    #[inline(always)]
    fn root(self) -> f32 {
        // All bits cleared where the sign is set: on a Cortex-M one instruction, where a comparison
        // takes four.
        let bits = self.to_bits();
        sqrt(f32::from_bits(bits & !((bits as i32 >> 31) as u32)))
    }

    #[inline(always)]
    fn within(self, low: f32, high: f32) -> f32 {
        clamp(self, low, high)
    }

    #[inline(always)]
    fn within_positive(self, low: f32, high: f32) -> f32 {
        // Numbers of one sign are ordered as their bits are: on a Cortex-M a comparison of integers
        // takes three instructions less.
        let (bits, low, high) = (self.to_bits() as i32, low.to_bits() as i32, high.to_bits() as i32);
        let bits = if bits > low { bits } else { low };
        f32::from_bits(if bits < high { bits } else { high } as u32)
    }
}

/// `x` limited to `[low, high]`; `low` where `x` is NaN. (`f32::clamp` has a panic path.)
#[inline(always)]
pub(crate) fn clamp(x: f32, low: f32, high: f32) -> f32 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}

/// The larger of two; `b` where either is NaN.
#[inline(always)]
pub(crate) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two; `b` where either is NaN.
#[inline(always)]
pub(crate) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Below every divisor but zero, and so large that no numerator of the runtime overflows by it.
const LEAST_DIVISOR: f32 = 1e-24;

/// `x > 0` as a divisor; 1e-24 where it is zero or negative, and nobody takes the quotient.
///
/// Flight stacks trap floating-point exceptions, and a branch around a division does not keep it
/// from raising one: to LLVM divisions have no side effects, so it may divide before the branch and
/// select afterwards. The selection here is between integers: of one between floats LLVM may divide
/// by both, too.
#[inline(always)]
pub(crate) fn divisor(x: f32) -> f32 {
    let (bits, least) = (x.to_bits() as i32, LEAST_DIVISOR.to_bits() as i32);
    f32::from_bits(if bits > least { bits } else { least } as u32)
}

/// `part / whole`, where `whole` has any sign; `part / 1e-24` where it is zero.
#[inline(always)]
pub(crate) fn quotient(part: f32, whole: f32) -> f32 {
    let quotient = part / divisor(whole.abs());
    if whole < 0.0 { -quotient } else { quotient }
}

/// `a / b` by itself. Two divisions side by side become one of four lanes on some hosts, of which two
/// divide 0 by 0, which flight stacks trap.
#[cfg_attr(target_arch = "arm", inline(always))]
#[cfg_attr(not(target_arch = "arm"), inline(never))]
pub(crate) fn divided(a: f32, b: f32) -> f32 {
    a / b
}
