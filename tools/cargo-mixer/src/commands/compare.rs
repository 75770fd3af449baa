//! `cargo mixer compare`: airframes side by side.

use std::path::PathBuf;

use mixer_facts::Checked;

use crate::Done;

/// Prints airframes side by side: thrust, authority, hover, evaluator, cost
#[derive(clap::Args, Debug)]
pub struct CompareArgs {
    /// The airframe files
    #[arg(required = true, num_args = 2.., value_name = "AIRFRAME.toml")]
    airframes: Vec<PathBuf>,
}

/// Runs the command.
pub fn run(args: &CompareArgs) -> Done {
    let all = args
        .airframes
        .iter()
        .map(|path| crate::compile(path).map(Checked::new));
    crate::print(&mixer_facts::compare(&all.collect::<Result<Vec<_>, _>>()?))
}
