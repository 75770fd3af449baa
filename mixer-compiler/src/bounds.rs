//! Tools that enclose a value between two floats: Bernstein coefficients and interval arithmetic.

pub mod bernstein;
pub(crate) mod interval;
