//! `cargo mixer new`: a complete airframe file to begin with.

use std::path::PathBuf;

use mixer_compiler::Source;
use mixer_files::new::{Error, new};

use crate::frame_args::FrameArgs;
use crate::{Done, airframe_file, bad_usage, file, print_error};

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
    pub pair: Option<PathBuf>,
    /// The airframe file to write
    #[arg(short, long, value_name = "AIRFRAME.toml")]
    output: PathBuf,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

impl NewArgs {
    /// The file's text with this pair's model.
    ///
    /// # Errors
    /// A file without `[pair]`, an arm that is missing.
    pub fn text(&self, pair: Option<&Source>) -> Result<String, Error> {
        new(&self.frame.frame(Some(&self.output)), pair)
    }
}

/// Runs the command.
pub fn run(args: &NewArgs) -> Done {
    file::writable(&args.output, args.force, &args.pair)?;
    let pair = args.pair.as_deref().map(file::source).transpose();
    let pair = pair.map_err(print_error)?;
    let text = args.text(pair.as_ref()).map_err(|error| match error {
        Error::Pair(message) => print_error(message),
        Error::Frame(message) => bad_usage(message),
    })?;
    airframe_file::write(&args.output, &text, args.pair.as_deref())
}
