//! Coaxial maps of `MIXER_BENCH_DATA`, identified.

use std::path::{Path, PathBuf};

use cargo_mixer::bench_files::identify;
use cargo_mixer::identify::IdentifyArgs;
use clap::Parser;
use mixer_identify::fragment;
use mixer_identify::identified::Identified;

/// The command's arguments, so that its defaults are tested.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    identify: IdentifyArgs,
}

/// The files; `None`, and a line on stderr, where the data is not there.
pub(crate) fn files(test: &str) -> Option<Vec<PathBuf>> {
    let Some(data) = std::env::var_os("MIXER_BENCH_DATA").map(PathBuf::from) else {
        eprintln!("NOT RUN: {test} needs MIXER_BENCH_DATA");
        return None;
    };
    let folder = data.join("newdexterity");
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut maps: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    maps.retain(|path| path.to_string_lossy().contains("map10x10"));
    maps.sort();
    assert!(maps.len() >= 10, "{} maps in {}", maps.len(), folder.display());
    Some(maps)
}

/// What `cargo mixer identify MAP --basis BASIS` finds.
pub(crate) fn identified(map: &Path, basis: &str) -> Identified {
    let words = [
        "identify".into(),
        map.as_os_str().to_owned(),
        "--basis".into(),
        basis.into(),
    ];
    let arguments = Arguments::try_parse_from(words)
        .unwrap_or_else(|error| panic!("{error}"))
        .identify;
    identify(&arguments.files, &arguments.settings())
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
