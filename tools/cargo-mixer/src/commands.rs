//! The commands: a file per command, each with its arguments and its function `run`.

pub mod compare;
pub mod expand;
pub mod golden;
pub mod identify;
pub mod import;
pub mod library;
pub mod mix;
pub mod new;
pub mod params;
pub mod plan;
pub mod predict;
pub mod report;
pub mod review;
pub mod schema;
pub mod shell;
pub mod sweep;
pub mod wrench;
