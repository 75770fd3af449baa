//! Outputs of a compiled airframe: generated Rust, the report, costs, check lists and
//! comparisons. Nothing of it reaches back into the compilation.

pub mod alternatives;
pub mod checklist;
pub mod cost;
pub(crate) mod emit;
pub mod hover;
pub mod power;
pub mod report;
pub(crate) mod scale;
