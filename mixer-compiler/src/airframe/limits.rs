//! A limit that several tables of the file share.

/// Largest coefficient, N or N m: far beyond any rotor, far within single precision.
pub(super) const LARGEST_EFFORT: f64 = 1e6;
