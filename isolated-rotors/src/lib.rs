//! Mixers of today's flight stacks, to compare with: they take every rotor of a coaxial frame as
//! isolated. The report of `cargo mixer` draws the conventional one.
#![cfg_attr(not(feature = "tables"), no_std)]

mod rotors;
#[cfg(feature = "tables")]
mod tables;

pub use rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};
#[cfg(feature = "tables")]
pub use tables::IsolatedTables;
