//! `cargo mixer compare`: airframes side by side.

use std::path::PathBuf;
use std::process::ExitCode;

use mixer_facts::Checked;

/// Prints airframes side by side: thrust, authority, hover, evaluator, cost
#[derive(clap::Args, Debug)]
pub struct CompareArgs {
    /// The airframe files
    #[arg(required = true, num_args = 2.., value_name = "AIRFRAME.toml")]
    airframes: Vec<PathBuf>,
}

/// Runs the command.
pub fn run(args: &CompareArgs) -> ExitCode {
    let mut all = Vec::new();
    for path in &args.airframes {
        match crate::compile(path) {
            Ok(compiled) => all.push(Checked::new(compiled)),
            Err(refusal) => return refusal.report(),
        }
    }
    crate::print(&mixer_facts::compare(&all))
}
