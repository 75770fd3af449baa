//! `cargo mixer new`: a complete airframe file to begin with.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::airframe_file;
use crate::frame::FrameArgs;

/// Writes a complete, commented airframe file of a regular frame
///
/// Without --pair it has the pair of the ISAE X8 (Chebbi et al. 2020) for you to replace: `cargo
/// mixer identify` makes yours of a bench file.
#[derive(clap::Args, Debug)]
pub struct NewArgs {
    #[command(flatten)]
    frame: FrameArgs,
    /// The pair's model: what `cargo mixer identify -o` writes, or another airframe's
    #[arg(long, value_name = "PAIR.toml")]
    pair: Option<PathBuf>,
    /// The airframe file to write
    #[arg(short, long, value_name = "AIRFRAME.toml")]
    output: PathBuf,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

/// The pair that stands in for the user's own.
const STAND_IN: &str = include_str!("new/stand-in.toml");

/// Runs the command.
pub fn run(args: &NewArgs) -> ExitCode {
    let inputs = args.pair.iter().map(PathBuf::as_path);
    if let Err(status) = crate::file::writable(&args.output, args.force, inputs) {
        return status;
    }
    let pair = match args.pair.as_deref().map(crate::bench_files::pair).transpose() {
        Ok(pair) => pair,
        Err(message) => return crate::print_error(message),
    };
    let (tables, bias) = match &pair {
        None => (STAND_IN.to_owned(), None),
        Some(pair) => pair.model(),
    };
    match args.frame.airframe(Some(&args.output), &tables, bias) {
        Ok(text) => airframe_file::write(&args.output, &crate::printable_lines(&text), args.pair.as_deref()),
        Err(message) => {
            crate::print_error(message);
            ExitCode::from(2)
        }
    }
}
