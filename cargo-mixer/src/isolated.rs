//! What flight stacks do with a coaxial frame today, for comparison: every rotor is taken as
//! isolated. The report draws the conventional mixer; the crate `isolated-rotors` (`tests/`) has
//! these two files for firmware and tests, and is not published.

mod rotors;
mod tables;

pub use rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};
pub use tables::IsolatedTables;
