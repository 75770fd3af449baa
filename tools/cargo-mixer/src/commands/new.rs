//! `cargo mixer new`: a complete airframe file to begin with.

use std::path::PathBuf;

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_facts::checklist;
use mixer_files::new::{Error, new, new_unlike};

use crate::frame_args::FrameArgs;
use crate::{Done, airframe_file, bad_usage, file, print_error, print_note};

/// Writes a complete, commented airframe file of a regular frame
///
/// Without --pair it has the pair of the ISAE X8 (Chebbi et al. 2020) for you to replace: `cargo
/// mixer identify` makes yours of a bench file.
#[derive(clap::Args, Debug)]
pub struct NewArgs {
    #[command(flatten)]
    frame: FrameArgs,
    /// The pair's model: what `cargo mixer identify -o` writes, or another airframe's; NAME=PAIR.toml for each of several, by
    /// place, front, rear, left or right, or with names of your own, which go round the frame clockwise
    #[arg(long, value_name = "PAIR.toml")]
    pub pair: Vec<PathBuf>,
    /// The airframe file to write
    #[arg(short, long, value_name = "AIRFRAME.toml")]
    output: PathBuf,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

impl NewArgs {
    /// The files with the pairs' models, each with its name where there are several.
    ///
    /// # Errors
    /// One of several without a name.
    pub fn pairs(&self) -> Result<Vec<(String, PathBuf)>, String> {
        let split = |path: &PathBuf| {
            let text = path.to_string_lossy();
            let (name, file) = text.split_once('=')?;
            Some((name.to_owned(), PathBuf::from(file)))
        };
        match self.pair.as_slice() {
            [one] => Ok(vec![(String::new(), one.clone())]),
            several => several
                .iter()
                .map(|path| {
                    split(path).ok_or_else(|| {
                        format!("--pair {}: each of several has a name: NAME=FILE", path.display())
                    })
                })
                .collect(),
        }
    }

    /// The file's text with these pairs' models, as [`NewArgs::pairs`] names them.
    ///
    /// # Errors
    /// A file without `[pair]`, an arm that is missing.
    pub fn text(&self, pairs: &[(String, Source)]) -> Result<String, Error> {
        let frame = self.frame.frame(Some(&self.output));
        match pairs {
            [] => new(&frame, None),
            [(_, pair)] => new(&frame, Some(pair)),
            pairs => new_unlike(&frame, pairs),
        }
    }
}

/// Runs the command.
pub fn run(args: &NewArgs) -> Done {
    let pairs = args.pairs().map_err(bad_usage)?;
    file::writable(&args.output, args.force, pairs.iter().map(|(_, path)| path))?;
    let sources = pairs
        .iter()
        .map(|(name, path)| Ok((name.clone(), file::source(path)?)));
    let sources: Vec<(String, Source)> = sources.collect::<Result<_, String>>().map_err(print_error)?;
    let text = args.text(&sources).map_err(|error| match error {
        Error::Pair(message) => print_error(message),
        Error::Frame(message) => bad_usage(message),
    })?;
    airframe_file::write(&args.output, &text, pairs.first().map(|(_, path)| path.as_path()))?;
    let airframe = Airframe::read(&Source::new("new.toml", text)).ok();
    let unlike = airframe.filter(Airframe::is_unlike);
    unlike.iter().flat_map(checklist::frame).for_each(print_note);
    Ok(())
}
