//! What a file is that somebody drops on a page or names on a command line.

use mixer_compiler::Source;
use mixer_compiler::diagnostic::content::{self, Content};
use mixer_identify::bench::BenchKind;
use mixer_identify::bench::text::normalised;
use mixer_identify::identified::Settings;
use mixer_identify::texts::{self, Text};
use serde::Serialize;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FileKind {
    /// An airframe file.
    Airframe,
    /// The model of a pair without a vehicle.
    Pair,
    /// Parameters or a start script of PX4.
    Px4,
    /// Parameters of ArduPilot.
    Ardupilot,
    /// `diff all` or `dump` of Betaflight or INAV.
    Betaflight,
    /// A bench file of a pair.
    Map,
    /// The run of one rotor, or its data sheet.
    Run,
}

impl FileKind {
    /// Whether `import` reads it.
    #[must_use]
    pub fn is_of_stack(self) -> bool {
        matches!(self, FileKind::Px4 | FileKind::Ardupilot | FileKind::Betaflight)
    }
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct File {
    /// What it is.
    pub kind: FileKind,
    /// Its text: what the commands that read this kind of file make of its bytes.
    pub text: String,
    /// Points of a bench file that can be read with these settings, else 0.
    pub points: usize,
}

/// Endings of names, for texts whose words do not tell.
const ENDINGS: [(&str, FileKind); 4] = [
    (".toml", FileKind::Airframe),
    (".params", FileKind::Px4),
    (".param", FileKind::Ardupilot),
    (".parm", FileKind::Ardupilot),
];

/// Tells a file by its content, and where that does not tell by its name. `identify` and `predict` are how these
/// commands would read it: a bench file is what the reading takes it for that gets furthest.
///
/// # Errors
/// Files that no command of text reads, as logs, documents and pictures: `NAME: this is WHAT`.
pub fn read(name: &str, bytes: &[u8], identify: &Settings, predict: &Settings) -> Result<File, String> {
    let read = Source::from_bytes(name, bytes.to_vec());
    let text = match &read {
        Ok(source) => &source.text,
        Err(faults) => &faults.source().text,
    };
    let lower = name.to_ascii_lowercase();
    let by_name = ENDINGS.iter().find(|(ending, _)| lower.ends_with(ending));
    let kind = match (content::of(text), by_name) {
        (Content::Airframe, _) => FileKind::Airframe,
        (Content::Pair, _) => FileKind::Pair,
        (Content::Px4, _) => FileKind::Px4,
        (Content::Ardupilot, _) => FileKind::Ardupilot,
        (Content::Betaflight, _) => FileKind::Betaflight,
        (Content::Foreign(what), _) => return Err(format!("{name}: this is {what}")),
        (Content::Table | Content::Other, Some((_, kind))) => *kind,
        (Content::Table | Content::Other, None) => return bench(name, bytes, identify, predict),
    };
    match read {
        Ok(Source { text, .. }) => Ok(File {
            kind,
            text,
            points: 0,
        }),
        Err(faults) => Err(faults.refusal()),
    }
}

/// Of a pair, of one rotor, of a pair without torque.
fn bench(name: &str, bytes: &[u8], identify: &Settings, predict: &Settings) -> Result<File, String> {
    let text = normalised(name, bytes).map_err(|refusal| format!("{name}: {}", refusal.reason))?;
    let content = Text {
        name: name.to_owned(),
        content: Ok(text.as_bytes().to_vec()),
    };
    let mut without_torque = identify.clone();
    without_torque.preparation.is_correction = true;
    let (mut best, mut furthest) = (FileKind::Map, 0);
    for (settings, kind) in [
        (identify, FileKind::Map),
        (predict, FileKind::Run),
        (&without_torque, FileKind::Map),
    ] {
        match texts::read(&content, settings) {
            Ok(bench) => {
                let kind = match bench.kind {
                    BenchKind::Pair => FileKind::Map,
                    BenchKind::SingleRotor => FileKind::Run,
                };
                return Ok(File {
                    kind,
                    text,
                    points: bench.points_used,
                });
            }
            Err(refusal) => {
                let (_, line) = refusal.file_and_line();
                if line > Some(furthest) {
                    (furthest, best) = (line.unwrap_or_default(), kind);
                }
            }
        }
    }
    Ok(File {
        kind: best,
        text,
        points: 0,
    })
}
