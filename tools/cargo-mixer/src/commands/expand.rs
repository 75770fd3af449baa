//! `cargo mixer expand`.

use std::path::PathBuf;

use crate::Done;

/// Prints the Rust that the macro and the build-script helper generate from an airframe file
#[derive(clap::Args, Debug)]
pub struct ExpandArgs {
    /// The airframe file
    airframe: PathBuf,
}

/// Runs the command.
pub fn run(args: &ExpandArgs) -> Done {
    crate::print(&crate::compile(&args.airframe)?.rust())
}
