//! What one call of a mixer costs under QEMU: instructions and stack.
#![no_std]

mod instructions;
mod stack;

pub use instructions::{Counter, Inexact, Mixer, NOPS};
pub use stack::high_water;
