//! What one call of a mixer costs under QEMU: instructions and stack; and which floating-point
//! exceptions it raises. Also how the images that measure it end.
#![no_std]

mod ending;
mod exceptions;
mod instructions;
mod stack;

pub use ending::{exit, no_airframe, with_counter};
pub use exceptions::exceptions;
pub use instructions::{Counter, Inexact, Mixer, NOPS};
pub use stack::high_water;
