//! `cargo mixer completions`: what shells know of the command line.

use std::io::{Write, stdout};
use std::process::ExitCode;

use clap::Command;
use clap_complete::Shell;

/// Prints a script that completes commands and options in a shell
///
/// For bash:
///   cargo-mixer completions bash > ~/.local/share/bash-completion/completions/cargo-mixer
/// The scripts complete the program `cargo-mixer`.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// The name of the installed program.
const PROGRAM: &str = "cargo-mixer";

/// Prints the completions of `command`.
pub fn run(args: &CompletionsArgs, command: Command) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command.bin_name(PROGRAM), PROGRAM, &mut script);
    crate::finish(stdout().lock().write_all(&script))
}
