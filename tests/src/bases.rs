//! The three bases compared on full-range maps of real benches, where `MIXER_BENCH_DATA` names
//! their folder.
//!
//! `tests/measurements/bases.csv` holds a [`Row`] per map and basis. It is written by `cargo
//! bases` only: the bench files are no part of the project.

use std::fmt;
use std::path::{Path, PathBuf};

use cargo_mixer::bench_files::identify;
use cargo_mixer::commands::identify::IdentifyArgs;
use clap::Parser;

use crate::root;

/// Title of a map, and the part of a name that only its bench file has.
const MAPS: [(&str, &str); 5] = [
    (
        "16.2 in MN4014 z/D 0.25",
        "MN4014_T_motor_map10x10_full_range_zD_025",
    ),
    ("16.2 in U5 z/D 0.5", "U5_T_motor_map10x10_full_range_zD_05"),
    ("22 in MN501S z/D 0.4", "MN501S_T_motor_map10x10_full_range_zD_04"),
    ("11 in propdrivev2 z/D 1", "propdrivev2_map10x10_full_range_zD_1"),
    ("11 in propdrivev2 z/D 0.4", "data2021_08_17_11_11_55"),
];

/// One basis on one map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Title of the map.
    pub map: String,
    /// Name of the basis.
    pub basis: String,
    /// Leave-one-out error of thrust, percent of the largest thrust, two decimals.
    pub thrust_percent: String,
    /// Leave-one-out error of torque, percent of the largest torque, two decimals.
    pub torque_percent: String,
    /// Least idle without a fold, three decimals; empty where the box has none at any idle.
    pub least_idle: String,
    /// `chosen` for the basis that `identify` takes, else empty.
    pub chosen: String,
}

/// One line of CSV.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{},{},{},{},{},{}",
            self.map, self.basis, self.thrust_percent, self.torque_percent, self.least_idle, self.chosen
        )
    }
}

const HEADER: &str = "map,basis,thrust_percent,torque_percent,least_idle,chosen";

/// The file of the measurement.
pub fn file() -> PathBuf {
    root().join("tests/measurements/bases.csv")
}

/// The text of the file.
pub fn text(rows: &[Row]) -> String {
    let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
    format!("{HEADER}\n{rows}")
}

/// The command's arguments, so that its defaults are measured.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    identify: IdentifyArgs,
}

/// Identifies all maps in `data`, the folder of bench files.
///
/// # Errors
/// A file that is missing or refused.
pub fn measure(data: &Path) -> Result<Vec<Row>, String> {
    let folder = data.join("newdexterity");
    let unreadable = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(unreadable)? {
        files.push(entry.map_err(unreadable)?.path());
    }
    let mut rows = Vec::new();
    for (map, part) in MAPS {
        let file = files
            .iter()
            .find(|file| file.to_string_lossy().contains(part))
            .ok_or_else(|| format!("{}: no file {part}", folder.display()))?;
        rows.extend(compare(map, file)?);
    }
    Ok(rows)
}

fn compare(map: &str, file: &Path) -> Result<Vec<Row>, String> {
    let fault = |what: String| format!("{}: {what}", file.display());
    let arguments = Arguments::try_parse_from(["identify".as_ref(), file.as_os_str()])
        .map_err(|error| fault(error.to_string()))?
        .identify;
    let found = identify(&arguments.files, &arguments.settings())
        .map_err(|refusals| fault(refusals.iter().map(|refusal| refusal.to_string()).collect()))?;
    let pair = found.pair.ok_or_else(|| fault("no map of a pair".into()))?;
    let row = |candidate: &mixer_identify::fit::cross::Candidate| {
        let errors = candidate.errors?;
        Some(Row {
            map: map.to_owned(),
            basis: candidate.basis.name().to_owned(),
            thrust_percent: format!("{:.2}", errors.thrust_leave_one_out),
            torque_percent: format!("{:.2}", errors.torque_leave_one_out),
            least_idle: candidate
                .least_idle
                .map_or_else(String::new, |idle| format!("{idle:.3}")),
            chosen: if candidate.chosen { "chosen" } else { "" }.to_owned(),
        })
    };
    pair.cross_validation
        .iter()
        .map(|candidate| {
            row(candidate).ok_or_else(|| fault(format!("{:?} was not determined", candidate.basis)))
        })
        .collect()
}
