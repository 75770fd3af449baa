//! `cargo mixer completions` and `cargo mixer man`: what shells and `man` know of the command line.

use std::io::{Write, stdout};
use std::process::ExitCode;

use clap::Command;
use clap_complete::Shell;

/// Prints a script that completes commands and options in a shell
///
/// For bash: cargo-mixer completions bash > ~/.local/share/bash-completion/completions/cargo-mixer
/// The scripts complete the program `cargo-mixer`.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Prints a manual page: cargo mixer man | man -l -
#[derive(clap::Args, Debug)]
pub struct ManArgs {
    /// The command; without it the page of them all
    command: Option<String>,
}

/// The name of the installed program.
const PROGRAM: &str = "cargo-mixer";

/// Prints the completions of `command`.
pub fn completions(args: &CompletionsArgs, command: Command) -> ExitCode {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command.bin_name(PROGRAM), PROGRAM, &mut script);
    crate::finish(stdout().lock().write_all(&script))
}

/// Prints the manual page of `command`, or of one of its own.
pub fn man(args: &ManArgs, command: &Command) -> ExitCode {
    let page_of = |command: Command, title: String| clap_mangen::Man::new(command).title(title);
    let shown = match &args.command {
        None => page_of(command.clone().name(PROGRAM), PROGRAM.to_owned()),
        Some(name) => match command.find_subcommand(name) {
            Some(found) => page_of(found.clone(), format!("{PROGRAM}-{name}")),
            None => {
                crate::print_error(format_args!("there is no command {name}"));
                return ExitCode::from(2);
            }
        },
    };
    let mut page = Vec::new();
    let written = shown.render(&mut page);
    crate::finish(written.and_then(|()| stdout().lock().write_all(&page)))
}
