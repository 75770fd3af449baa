//! Coaxial maps of `MIXER_BENCH_DATA`, identified.

use std::path::{Path, PathBuf};

use cargo_mixer::bench_files::identify_with_runs;
use cargo_mixer::commands::identify::IdentifyArgs;
use clap::Parser;
use mixer_identify::fragment;
use mixer_identify::identified::Identified;

/// The command's arguments, so that its defaults are tested.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    identify: IdentifyArgs,
}

/// The folder of real bench files.
pub(crate) fn bench_data() -> PathBuf {
    let data = std::env::var_os("MIXER_BENCH_DATA").map(PathBuf::from);
    data.expect("MIXER_BENCH_DATA names the folder of the bench files")
}

/// The maps.
pub(crate) fn files() -> Vec<PathBuf> {
    let maps = named(&["map10x10"]);
    assert!(maps.len() >= 10, "{} maps", maps.len());
    maps
}

/// The files with one of these words in their name.
pub(crate) fn named(words: &[&str]) -> Vec<PathBuf> {
    let folder = bench_data().join("newdexterity");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| words.iter().any(|word| path.to_string_lossy().contains(word)));
    files.sort();
    files
}

/// What `cargo mixer identify MAP --basis BASIS` finds.
pub(crate) fn identified(map: &Path, basis: &str) -> Identified {
    with_runs(map, [None, None], basis)
}

/// [`identified`] with runs of the upper and of the lower rotor alone.
pub(crate) fn with_runs(map: &Path, runs: [Option<&Path>; 2], basis: &str) -> Identified {
    let words = [
        "identify".into(),
        map.as_os_str().to_owned(),
        "--basis".into(),
        basis.into(),
    ];
    let arguments = Arguments::try_parse_from(words)
        .unwrap_or_else(|error| panic!("{error}"))
        .identify;
    identify_with_runs(&arguments.files, runs, &arguments.settings())
        .unwrap_or_else(|refusals| panic!("{}: {}", map.display(), refusals[0]))
}

/// The tables that it writes but for the power map, with these throttles instead of its own.
#[allow(dead_code, reason = "not all tests that share this module change them")]
pub(crate) fn with_throttle(identified: &Identified, [min, max]: [f64; 2]) -> String {
    let lines: Vec<String> = fragment::text(identified)
        .lines()
        // The power map holds for the throttles that were measured.
        .filter(|line| *line != "[pair.power]" && !line.starts_with("power_w = "))
        .map(|line| match line.split_once(" = ") {
            Some(("min", _)) => format!("min = {min:?}"),
            Some(("max", _)) => format!("max = {max:?}"),
            _ => line.to_owned(),
        })
        .collect();
    lines.join("\n")
}
