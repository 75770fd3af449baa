//! The real pairs that the zoo is made of: those of `airframes/`, and where `MIXER_BENCH_DATA` names
//! the folder of bench files those identified from its maps.

use std::path::Path;

use cargo_mixer::bench_files::identify;
use cargo_mixer::commands::identify::IdentifyArgs;
use clap::Parser;
use mixer_compiler::Source;
use mixer_identify::fragment;

use super::pairs::Pair;
use super::zoo::Zoo;
use crate::{airframes, root};

/// The zoo of `seed` with the pairs of `airframes/`.
///
/// # Errors
/// An airframe that cannot be read.
pub fn zoo(seed: u64) -> Result<Zoo, String> {
    Ok(Zoo::new(seed, shipped()?))
}

/// The zoo of `seed` with the pairs of `airframes/` and of the bench files in `data`.
///
/// # Errors
/// A file that cannot be read, or a map that `identify` refuses.
pub fn zoo_with_bench_data(seed: u64, data: &Path) -> Result<Zoo, String> {
    Ok(Zoo::new(seed, real_pairs(Some(data))?))
}

/// The pairs of `airframes/` and, where there is a folder of bench files, those of its maps.
///
/// # Errors
/// A file that cannot be read, or a map that `identify` refuses.
pub fn real_pairs(data: Option<&Path>) -> Result<Vec<Pair>, String> {
    let mut pairs = shipped()?;
    if let Some(data) = data {
        pairs.extend(identified(data)?);
    }
    Ok(pairs)
}

fn shipped() -> Result<Vec<Pair>, String> {
    let names = airframes().map_err(|error| format!("airframes/: {error}"))?;
    let read = |name: &String| {
        let path = format!("airframes/{name}.toml");
        let text = std::fs::read_to_string(root().join(&path)).map_err(|error| format!("{path}: {error}"))?;
        Ok(Source::new(path, text))
    };
    let files: Vec<Source> = names.iter().map(read).collect::<Result<_, String>>()?;
    let with_one = files.iter().filter(|file| Pair::is_alone(file));
    with_one.map(Pair::of_airframe).collect()
}

/// The command's arguments, so that its defaults are taken.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    identify: IdentifyArgs,
}

/// The full-range maps of both rotors, each in the basis that `identify` chooses.
fn identified(data: &Path) -> Result<Vec<Pair>, String> {
    let folder = data.join("newdexterity");
    let unreadable = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(unreadable)? {
        files.push(entry.map_err(unreadable)?.path());
    }
    files.retain(|file| file.to_string_lossy().contains("map10x10"));
    files.sort();
    files.iter().map(|file| pair_of(file)).collect()
}

fn pair_of(file: &Path) -> Result<Pair, String> {
    let fault = |what: String| format!("{}: {what}", file.display());
    let arguments = Arguments::try_parse_from(["identify".as_ref(), file.as_os_str()])
        .map_err(|error| fault(error.to_string()))?
        .identify;
    let found = identify(&arguments.files, &arguments.settings())
        .map_err(|refusals| fault(refusals.iter().map(ToString::to_string).collect()))?;
    let unit = "[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
                [allocation]\naxes = [\"yaw\", \"thrust\"]\n";
    let text = format!("name = \"map\"\n{}\n{unit}", fragment::text(&found));
    Pair::of_airframe(&Source::new(file.display().to_string(), text)).map_err(fault)
}
