//! What a compiled airframe gives, costs and risks, as one list of [`facts`]: numbers with units and
//! words. The verdict of [`check`], its report and JSON, the report page and [`compare`] print it;
//! firmware needs nothing of it. [`command`] is `cargo mixer check` itself, with its files ([`input`]) and its
//! [`terminal`]: it is compiled alone in a clone.
//!
//! ```
//! use mixer_compiler::Source;
//!
//! # let text = std::fs::read_to_string("../../airframes/single-pair.toml").unwrap();
//! let checked = mixer_facts::check(&Source::new("single-pair.toml", text)).unwrap();
//! assert!(checked.verdict().contains("bare thrust"));
//! assert_eq!(checked.json(())["rotors"], 2);
//! ```

pub mod air;
mod check;
pub mod checklist;
pub mod command;
pub mod cost;
mod facts;
pub mod hover;
pub mod input;
pub mod terminal;

pub use check::{Checked, check, compare, refusal};
pub use facts::{Fact, facts};
