//! `cargo mixer new`: a complete airframe file to begin with.

use std::path::PathBuf;
use std::process::ExitCode;

use mixer_identify::fragment;

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
    /// `[throttle]`, `[pair]` and `[voltage]`, as `cargo mixer identify -o` writes them
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
    if let Err(message) = crate::file::not_there(&args.output, args.force) {
        return crate::print_error(message);
    }
    let tables = match &args.pair {
        None => STAND_IN.to_owned(),
        Some(path) => match crate::file::read_text(path) {
            Ok(text) => fragment::without_instructions(&text),
            Err(message) => return crate::print_error(message),
        },
    };
    match args.frame.airframe(Some(&args.output), &tables, None) {
        Ok(text) => airframe_file::write(&args.output, &text),
        Err(message) => {
            crate::print_error(message);
            ExitCode::from(2)
        }
    }
}
