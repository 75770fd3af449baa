//! The mixers that take every rotor of a coaxial frame as isolated, for firmware and the flight
//! simulation. The files are those of `cargo mixer report`, which is published and cannot depend on
//! this crate.
#![cfg_attr(not(feature = "tables"), no_std)]

#[path = "../../../cargo-mixer/src/isolated/rotors.rs"]
mod rotors;
#[cfg(feature = "tables")]
#[path = "../../../cargo-mixer/src/isolated/tables.rs"]
mod tables;

pub use rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};
#[cfg(feature = "tables")]
pub use tables::IsolatedTables;
