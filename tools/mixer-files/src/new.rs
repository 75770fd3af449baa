//! A complete airframe file to begin with.

use std::fmt;

use mixer_compiler::Source;
use mixer_identify::pair_file::PairFile;

use crate::frame::NewFrame;
use mixer_compiler::diagnostic::printable_lines;

/// The pair that stands in for the user's own.
const STAND_IN: &str = include_str!("new/stand-in.toml");

/// Why there is no airframe file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The file with the pair's model has none.
    Pair(String),
    /// The frame is not fully described, or has no such part.
    Frame(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Error::Pair(message) | Error::Frame(message)) = self;
        f.write_str(message)
    }
}

impl std::error::Error for Error {}

/// An airframe file of a regular frame. `pair` is a file with the pair's model: what `identify` and
/// `predict` write, or another airframe's; without it the pair of the ISAE X8 stands in.
///
/// # Errors
/// A file without `[pair]`, an arm that is missing.
pub fn new(frame: &NewFrame<'_>, pair: Option<&Source>) -> Result<String, Error> {
    let (tables, bias) = match pair {
        None => (STAND_IN.to_owned(), None),
        Some(pair) => PairFile::read(&pair.name, &pair.text)
            .map_err(Error::Pair)?
            .model(),
    };
    let text = frame.airframe(&tables, bias).map_err(Error::Frame)?;
    Ok(printable_lines(&text))
}
