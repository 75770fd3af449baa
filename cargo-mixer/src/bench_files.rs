//! Bench files from the file system.

use std::path::{Path, PathBuf};

use mixer_compiler::diagnostic::printable;
use mixer_identify::bench::read::{self, Log, Reading};
use mixer_identify::bench::{self, Bench};
use mixer_identify::identified::{Identified, Settings, with_runs};
use mixer_identify::refusal::Refusal;

/// Reads the files and identifies what they hold. All refusals are collected.
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
    let benches = read_all(paths, settings)?;
    let run = |path: Option<&Path>| path.map(|path| read_one(path, settings)).transpose();
    let [upper, lower] = runs;
    run(upper)
        .and_then(|upper| with_runs(benches, [upper, run(lower)?], &settings.wishes))
        .map_err(|refusal| vec![refusal])
}

/// Reads the files and makes them ready. All refusals are collected.
///
/// # Errors
/// Files that cannot be read or used.
pub fn read_all(paths: &[PathBuf], settings: &Settings) -> Result<Vec<Bench>, Vec<Refusal>> {
    let mut benches = Vec::new();
    let mut refusals = Vec::new();
    for path in paths {
        match read_one(path, settings) {
            Ok(bench) => benches.push(bench),
            Err(refusal) => refusals.push(refusal),
        }
    }
    if refusals.is_empty() {
        Ok(benches)
    } else {
        Err(refusals)
    }
}

/// [`read_all`] for one file.
///
/// # Errors
/// A file that cannot be read or used.
pub fn read_one(path: &Path, settings: &Settings) -> Result<Bench, Refusal> {
    read_file(path, &settings.reading).and_then(|log| bench::prepare(log, &settings.preparation))
}

/// Reads a file.
///
/// # Errors
/// A file that cannot be read, or is larger than any bench's.
pub fn read_file(path: &Path, reading: &Reading) -> Result<Log, Refusal> {
    let name = printable(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
    let bytes = crate::file::bytes(path)
        .map_err(|error| read::unreadable(&path.display().to_string(), &error.to_string()))?;
    read::read(&name, bytes.as_slice(), reading)
}
