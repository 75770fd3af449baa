//! `cargo mixer expand`.

use std::path::PathBuf;
use std::process::ExitCode;

/// Prints the Rust that the macro and the build-script helper generate from an airframe file
#[derive(clap::Args, Debug)]
pub struct ExpandArgs {
    /// The airframe file
    airframe: PathBuf,
}

/// Runs the command.
pub fn run(args: &ExpandArgs) -> ExitCode {
    match crate::compile(&args.airframe) {
        Ok(compiled) => crate::print(&compiled.rust()),
        Err(refusal) => refusal.report(),
    }
}
