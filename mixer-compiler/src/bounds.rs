//! Tools that enclose a value between two floats: interval arithmetic.

pub(crate) mod interval;
