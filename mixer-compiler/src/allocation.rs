//! Tables of allocation beside M, M+ and the pair: the sides of the closed form, the range of level
//! thrust.

pub(crate) mod closed_form;
pub(crate) mod thrust_range;
