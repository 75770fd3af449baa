//! What desaturation reads: the polygon inside the attainable set, the sides of the closed form,
//! the range of thrust.

pub(crate) mod attainable;
pub(crate) mod closed_form;
pub(crate) mod thrust_range;
