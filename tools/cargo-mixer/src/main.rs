//! The command line; see `cargo mixer --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    cargo_mixer::arguments::run()
}
