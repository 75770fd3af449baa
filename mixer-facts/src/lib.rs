//! What a compiled airframe gives, costs and risks: numbers with units, and the words for them.
//!
//! `cargo mixer check`, `compare` and the report page read it; firmware needs nothing of it.

pub mod checklist;
pub mod cost;
pub mod hover;
pub mod report;
