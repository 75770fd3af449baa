//! Bench files from the file system, with progress on a terminal.

use std::fs::File;
use std::io::{BufReader, IsTerminal as _};
use std::path::{Path, PathBuf};
use std::slice;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mixer_compiler::diagnostic::printable;
use mixer_identify::bench::{self, Bench};
use mixer_identify::identified::{Identified, Settings, with_runs};
use mixer_identify::read::{self, Log, Reading};
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
    let bar = progress(paths);
    let mut benches = Vec::new();
    let mut refusals = Vec::new();
    for path in paths {
        let log = read_with(path, &settings.reading, &bar);
        match log.and_then(|log| bench::prepare(log, &settings.preparation)) {
            Ok(bench) => benches.push(bench),
            Err(refusal) => refusals.push(refusal),
        }
    }
    bar.finish_and_clear();
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
    let bar = progress(slice::from_ref(&path.to_path_buf()));
    let log = read_with(path, &settings.reading, &bar);
    bar.finish_and_clear();
    bench::prepare(log?, &settings.preparation)
}

/// Reads a file, in silence.
///
/// # Errors
/// A file that cannot be read.
pub fn read_file(path: &Path, reading: &Reading) -> Result<Log, Refusal> {
    read_with(path, reading, &ProgressBar::hidden())
}

fn read_with(path: &Path, reading: &Reading, bar: &ProgressBar) -> Result<Log, Refusal> {
    let name = printable(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy());
    let file = File::open(path)
        .map_err(|error| read::unreadable(&path.display().to_string(), &error.to_string()))?;
    let source = BufReader::with_capacity(1 << 16, bar.wrap_read(file));
    read::read(&name, source, reading)
}

/// A bar over the bytes of all files, on a terminal and for long inputs only.
fn progress(paths: &[PathBuf]) -> ProgressBar {
    const LONG: u64 = 20 << 20; // about a third of a second
    let bytes = paths
        .iter()
        .filter_map(|p| p.metadata().ok())
        .map(|m| m.len())
        .sum();
    if bytes < LONG || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("reading {bytes} of {total_bytes} {wide_bar} {eta}");
    let bar = ProgressBar::with_draw_target(Some(bytes), ProgressDrawTarget::stderr());
    style.map_or(bar.clone(), |style| bar.with_style(style))
}
