//! The report page of a compiled airframe, its figures and their data: [`Compiled`] in, text out.
//!
//! [`page::page`] writes one self-contained HTML page. [`data::sweep`] writes the data of a figure
//! as CSV. [`pictures`] draws figures as SVG files. Nothing here reads or writes files.
//!
//! ```
//! use mixer_compiler::Source;
//! use mixer_files::report::page::page;
//! use mixer_files::report::study::Study;
//!
//! # let text = std::fs::read_to_string("../../airframes/single-pair.toml").unwrap();
//! let compiled = mixer_compiler::compile(&Source::new("single-pair.toml", text)).unwrap();
//! let html = page(&Study::new(&compiled, None), None, None);
//! assert!(html.starts_with("<!DOCTYPE html>"));
//! ```
//!
//! [`Compiled`]: mixer_compiler::Compiled

pub mod authority;
pub mod bench;
mod bench_check;
pub mod colour;
pub mod comparison;
pub mod data;
pub mod effort;
pub mod field;
pub mod figure;
pub mod layout;
pub mod level;
pub mod maps;
pub mod number;
pub mod page;
pub mod pictures;
pub mod plots;
mod rows;
pub mod study;
pub mod surface;
pub mod table;
