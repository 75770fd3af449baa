//! `cargo mixer`: the command line of the coaxial mixer compiler.
//!
//! Exit status 0, 1 for a bad input, 2 for bad usage; errors go to stderr.

use std::path::Path;

use mixer_facts::input::{Refusal, compile, errors, fault, read};
use mixer_facts::terminal::{Done, bad_usage, output, print, print_error, print_note, print_notes, warn};

mod airframe_file;
pub mod arguments;
pub mod bench_args;
pub mod bench_files;
pub mod commands;
pub mod file;
pub mod frame_args;
pub mod pack;
pub mod place;
pub mod rows;

/// Writes an output to its file, or prints it where there is none.
fn deliver(output: Option<&Path>, force: bool, text: &str) -> Done {
    let Some(path) = output else {
        return print(text);
    };
    file::writable(path, force, [""; 0])?;
    file::save(path, text).map_err(print_error)
}
