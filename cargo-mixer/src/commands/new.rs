//! `cargo mixer new`: a complete airframe file to begin with.

use std::path::PathBuf;
use std::process::ExitCode;

use mixer_files::new::{Error, new};

use crate::frame_args::FrameArgs;
use crate::{BAD_USAGE, airframe_file, file, print_error};

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

/// Runs the command.
pub fn run(args: &NewArgs) -> ExitCode {
    let inputs = args.pair.iter().map(PathBuf::as_path);
    if let Err(status) = file::writable(&args.output, args.force, inputs) {
        return status;
    }
    let pair = match args.pair.as_deref().map(file::source).transpose() {
        Ok(pair) => pair,
        Err(message) => return print_error(message),
    };
    match new(&args.frame.frame(Some(&args.output)), pair.as_ref()) {
        Ok(text) => airframe_file::write(&args.output, &text, args.pair.as_deref()),
        Err(Error::Pair(message)) => print_error(message),
        Err(Error::Frame(message)) => {
            print_error(message);
            ExitCode::from(BAD_USAGE)
        }
    }
}
