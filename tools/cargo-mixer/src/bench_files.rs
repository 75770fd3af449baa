//! Bench files from the file system.

use std::path::{Path, PathBuf};

use mixer_compiler::diagnostic::printable;
use mixer_identify::bench::{Bench, read};
use mixer_identify::identified::{Identified, Settings};
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::{self, Text};

use crate::today::today;

/// Inputs of a bench command from outside of its arguments: files and the day.
pub struct Outside<'a> {
    /// A file by its path.
    pub text: &'a dyn Fn(&Path) -> Text,
    /// `YYYY-MM-DD`.
    pub today: Option<String>,
}

impl Outside<'_> {
    /// The file system and the clock.
    pub fn of_the_machine() -> Outside<'static> {
        Outside {
            text: &text,
            today: today(),
        }
    }

    pub(crate) fn texts(&self, paths: &[PathBuf]) -> Vec<Text> {
        paths.iter().map(|path| (self.text)(path)).collect()
    }
}

/// A file, or why it cannot be read.
pub fn text(path: &Path) -> Text {
    let name = path.file_name().unwrap_or(path.as_os_str());
    Text {
        name: printable(&name.to_string_lossy()),
        content: crate::file::bytes(path)
            .map_err(|error| read::unreadable(&path.display().to_string(), &error.to_string())),
    }
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
    let maps: Vec<Text> = paths.iter().map(|path| text(path)).collect();
    texts::identify(&maps, runs.each_ref().map(Option::as_ref), settings).map(|answer| answer.found)
}

/// Reads a file and makes it ready.
///
/// # Errors
/// A file that cannot be read or used.
pub fn read_one(path: &Path, settings: &Settings) -> Result<Bench, Refusal> {
    texts::read(&text(path), settings)
}
