//! Arithmetic in single precision that gives the same bits on every target.

mod scalar;
mod sqrt;

pub use scalar::Scalar;
pub(crate) use scalar::{clamp, divided, divisor, larger, quotient, smaller};
pub use sqrt::sqrt;

/// A loop's head that keeps the compiler from unrolling it. Unrolled, the loops of desaturation take
/// three times the code and are hardly faster. A loop over an array of four needs the array in a
/// `black_box` as well, as a slice.
#[inline(always)]
pub(crate) fn rolled<I: IntoIterator>(items: I) -> impl Iterator<Item = I::Item> {
    items.into_iter().inspect(|_| core::hint::black_box(()))
}
