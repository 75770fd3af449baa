//! Mixers of today's flight stacks, to compare with: they take every rotor of a coaxial frame as
//! isolated. The report of `cargo mixer` draws the conventional one.
//!
#![cfg_attr(feature = "tables", doc = "```")]
#![cfg_attr(not(feature = "tables"), doc = "```ignore")]
//! use isolated_rotors::IsolatedTables;
//! use mixer_compiler::Source;
//! use mixer_rt::Wrench;
//!
//! # let text = std::fs::read_to_string("../../airframes/isae-x8.toml").unwrap();
//! let compiled = mixer_compiler::compile(&Source::new("isae-x8.toml", text)).unwrap();
//! let tables = IsolatedTables::new(&compiled);
//! let hover = Wrench { thrust_n: 40.0, ..Wrench::default() };
//! let (throttles, within) = tables.conventional(&hover, 14.8).unwrap();
//! assert!(within && throttles.len() == 8);
//! ```
#![cfg_attr(not(feature = "tables"), no_std)]

mod rotors;
#[cfg(feature = "tables")]
mod tables;

pub use rotors::{IsolatedRotor, IsolatedRotors, ThrustCurve};
#[cfg(feature = "tables")]
pub use tables::IsolatedTables;
