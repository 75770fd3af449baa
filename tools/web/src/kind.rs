//! What a dropped file is.

use mixer_files::kind::{self, Kind as Of};
use serde::Serialize;

use crate::make;

/// What a file is, and how many points a bench file has.
#[derive(Debug, Serialize, PartialEq, Eq)]
pub struct Kind {
    /// `airframe`, `pair`, `parameters`, `map` (a bench file of a pair) or `run` (of one rotor).
    pub kind: &'static str,
    /// Points of a bench file.
    pub points: usize,
}

/// Tells a file; a bench file is read with these options of the command line.
///
/// # Errors
/// A file that is of no use here: what it is.
pub fn kind(name: &str, text: &str, options: &[String]) -> Result<Kind, String> {
    let [identify, predict] = ["identify", "predict"].map(|command| make::settings(command, options));
    let file = kind::read(name, text.as_bytes(), &identify, &predict)?;
    Ok(Kind {
        kind: match file.kind {
            Of::Airframe => "airframe",
            Of::Pair => "pair",
            Of::Px4 | Of::Ardupilot | Of::Betaflight => "parameters",
            Of::Map => "map",
            Of::Run => "run",
        },
        points: file.points,
    })
}
