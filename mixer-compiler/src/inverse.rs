//! The inverse map of one unit: the forms that can be emitted, the fit of their coefficients, and the
//! numbers.

pub mod evaluator;
pub(crate) mod fit;
pub(crate) mod table;
