//! Arithmetic in single precision that gives the same bits on every target.

mod scalar;
mod sqrt;

pub use scalar::Scalar;
pub use sqrt::sqrt;

/// In a loop's body: keeps the compiler from unrolling it. Unrolled, the loops of desaturation take
/// three times the code and are hardly faster. A loop over an array of four needs the array in a
/// `black_box` as well, as a slice.
#[inline(always)]
pub(crate) fn rolled() {
    core::hint::black_box(());
}

/// `x` limited to `[low, high]`; `low` where `x` is NaN. (`f32::clamp` has a panic path.)
#[inline(always)]
pub(crate) fn clamp(x: f32, low: f32, high: f32) -> f32 {
    let x = if x > low { x } else { low };
    if x < high { x } else { high }
}
