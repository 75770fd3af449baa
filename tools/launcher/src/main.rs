//! `cargo mixer` inside the clone: `check` is here and compiled in little time; every other command
//! goes on to `cargo-mixer`, which is compiled when it is first asked for.

use std::env;
use std::io::{self, IsTerminal as _};
use std::process::{Command, ExitCode};

use clap::Parser as _;
use mixer_facts::command;
use mixer_facts::terminal::{print_error, print_note};

/// The part of the command line that is here, named as the whole.
#[derive(clap::Parser)]
#[command(name = "cargo mixer", bin_name = "cargo mixer")]
enum Arguments {
    Check(command::CheckArgs),
}

fn main() -> ExitCode {
    if env::args_os().nth(1).is_none_or(|word| word != "check") {
        return whole().unwrap_or_else(|error| print_error(format_args!("cargo cannot be run: {error}")));
    }
    let Arguments::Check(args) = Arguments::parse();
    command::run(&args).err().unwrap_or(ExitCode::SUCCESS)
}

/// Hands the arguments to the whole program.
fn whole() -> io::Result<ExitCode> {
    let is_compiled = env::current_exe()?
        .with_file_name("cargo-mixer")
        .with_extension(env::consts::EXE_EXTENSION)
        .exists();
    if !is_compiled && io::stderr().is_terminal() {
        print_note("compiling the whole command line, once: some two minutes");
    }
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../cargo-mixer/Cargo.toml");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args([
            "run",
            "--quiet",
            "--bin",
            "cargo-mixer",
            "--manifest-path",
            manifest,
            "--",
        ])
        .args(env::args_os().skip(1))
        .status()?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
