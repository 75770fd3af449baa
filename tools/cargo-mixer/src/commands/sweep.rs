//! `cargo mixer sweep`: the data of the figures as CSV.

use std::path::PathBuf;

use mixer_files::report::data::{Data, sweep};
use mixer_files::report::study::Study;

use crate::bench_args::words;
use crate::commands::report::thrust;
use crate::{Done, file, print_error};

/// Writes the data of a figure as CSV, with units in the header
#[derive(clap::Args, Debug)]
pub struct SweepArgs {
    /// The airframe file
    airframe: PathBuf,
    /// Which figure
    #[arg(long, value_parser = words(&Data::ALL))]
    figure: Data,
    /// The pair whose maps are meant, of an airframe with several [default: the first]
    #[arg(long, value_name = "NAME")]
    pair: Option<String>,
    /// The file to write, whole or not at all [default: standard output]
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
    /// Total thrust of the yaw sweep, N [default: the weight, without a mass about 40 % of the
    /// largest bare thrust]
    #[arg(long, value_name = "NEWTON", value_parser = thrust, allow_negative_numbers = true)]
    thrust: Option<f64>,
}

/// Runs the command.
pub fn run(args: &SweepArgs) -> Done {
    if let Some(output) = &args.output {
        file::writable(output, args.force, [&args.airframe])?;
    }
    let compiled = crate::compile(&args.airframe)?;
    let study = Study::new(&compiled, args.thrust).of(args.pair.as_deref());
    let study = study.map_err(print_error)?;
    let csv = sweep(&study, args.figure).map_err(print_error)?;
    crate::deliver(args.output.as_deref(), args.force, &csv)
}
