//! Mixers of today's flight stacks, for comparison. They take every rotor of a coaxial frame as
//! isolated. The report draws the conventional one. The unpublished crate `tests/isolated-rotors`
//! compiles these two files for firmware and the flight simulation.

mod rotors;
mod tables;

pub use rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};
pub use tables::IsolatedTables;
