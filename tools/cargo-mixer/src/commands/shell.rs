//! `cargo mixer completions`: what shells know of the command line.

use clap::Command;
use clap_complete::Shell;

use crate::Done;

/// Prints a script that completes commands and options in a shell
///
/// bash, in ~/.bashrc:                  eval "$(cargo-mixer completions bash)"
/// fish, in ~/.config/fish/config.fish: cargo-mixer completions fish | source
/// zsh, in a folder of $fpath:          cargo-mixer completions zsh > _cargo-mixer
///
/// In these shells `cargo mixer` is completed, too: in zsh by cargo's own completion. In others the
/// program `cargo-mixer` is.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// The name of the installed program.
const PROGRAM: &str = "cargo-mixer";

/// Prints the completions of `command`.
pub fn run(args: &CompletionsArgs, command: Command) -> Done {
    let mut script = Vec::new();
    // clap_complete's script for bash loses the subcommands of a program whose name has a hyphen.
    let name = match args.shell {
        Shell::Bash => "cargo_mixer",
        _ => PROGRAM,
    };
    clap_complete::generate(args.shell, &mut command.name(name), name, &mut script);
    script.extend_from_slice(as_subcommand(args.shell).as_bytes());
    crate::print(&String::from_utf8_lossy(&script))
}

/// The script that completes `cargo mixer` by the completions of `cargo-mixer`. In zsh cargo's own completion
/// calls the function of that name.
fn as_subcommand(shell: Shell) -> &'static str {
    match shell {
        Shell::Bash => include_str!("shell/cargo.bash"),
        Shell::Fish => include_str!("shell/cargo.fish"),
        _ => "",
    }
}
