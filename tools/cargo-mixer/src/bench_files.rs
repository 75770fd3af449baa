//! Bench files from the file system.

use std::path::{Path, PathBuf};

use mixer_compiler::diagnostic::printable;
use mixer_identify::bench::{Bench, read};
use mixer_identify::identified::{Identified, Settings};
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::{self, Text};

/// How a bench command gets a file: [`text`] from the file system.
pub type Reader<'a> = &'a dyn Fn(&Path) -> Text;

/// A file, or why it cannot be read.
pub fn text(path: &Path) -> Text {
    let name = path.file_name().unwrap_or(path.as_os_str());
    Text {
        name: printable(&name.to_string_lossy()),
        content: crate::file::bytes(path)
            .map_err(|error| read::unreadable(&path.display().to_string(), &error.to_string())),
    }
}

/// [`text`] of files.
pub(crate) fn texts(paths: &[PathBuf]) -> Vec<Text> {
    paths.iter().map(|path| text(path)).collect()
}

/// Identifies what files hold.
///
/// # Errors
/// Files that cannot be read or used.
pub fn identify(paths: &[PathBuf], settings: &Settings) -> Result<Identified, Vec<Refusal>> {
    identify_with_runs(paths, [None, None], settings)
}

/// [`identify`] with runs of the upper and of the lower rotor alone.
///
/// # Errors
/// Files that cannot be read or used.
pub fn identify_with_runs(
    paths: &[PathBuf],
    runs: [Option<&Path>; 2],
    settings: &Settings,
) -> Result<Identified, Vec<Refusal>> {
    let runs = runs.map(|run| run.map(text));
    let maps: Vec<Text> = texts(paths);
    texts::identify(&maps, runs.each_ref().map(Option::as_ref), settings).map(|answer| answer.found)
}

/// Reads a file and makes it ready.
///
/// # Errors
/// A file that cannot be read or used.
pub fn read_one(path: &Path, settings: &Settings) -> Result<Bench, Refusal> {
    texts::read(&text(path), settings)
}
