//! The inverse map of one unit: the evaluators that can be emitted, and the fit of their
//! coefficients.

pub mod evaluator;
pub(crate) mod fit;
