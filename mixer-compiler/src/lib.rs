//! Compiler of coaxial mixers.

pub mod airframe;
pub mod diagnostic;
mod layout;
pub mod source;
pub mod spec;
