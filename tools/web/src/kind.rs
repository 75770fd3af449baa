//! What a dropped file is.

use mixer_compiler::Source;
use mixer_compiler::diagnostic::kind::PARAMETERS;
use mixer_files::import;
use mixer_identify::bench::Kind as Rotors;
use mixer_identify::texts::{self, Text};
use serde::Serialize;
use toml_edit::DocumentMut;

use crate::make;

/// What a file is, and how many points a bench file has.
#[derive(Debug, Serialize, PartialEq, Eq)]
pub struct Kind {
    /// `airframe`, `pair`, `parameters`, `map` (a bench file of a pair) or `run` (of one rotor).
    pub kind: &'static str,
    /// Points of a bench file.
    pub points: usize,
}

/// Tells a file by its content; a bench file is read with these options of the command line.
pub fn kind(name: &str, text: &str, options: &[String]) -> Kind {
    let is = |kind| Kind { kind, points: 0 };
    if let Ok(document) = text.parse::<DocumentMut>() {
        let has = |key| document.contains_key(key);
        if has("pair") && !has("unit") && !has("layout") {
            return is("pair");
        }
        if has("pair") || has("unit") || has("layout") {
            return is("airframe");
        }
    }
    let ends = |endings: &[&str]| endings.iter().any(|ending| name.ends_with(ending));
    if ends(&[".toml"]) {
        return is("airframe");
    }
    let states = PARAMETERS.into_iter().any(|word| text.contains(word));
    if states || ends(&[".params", ".param", ".parm"]) || import::stated(&Source::new(name, text)).is_ok() {
        return is("parameters");
    }
    bench(name, text, options)
}

/// A bench file is what the reading takes it for that gets furthest: of a pair, of one rotor, of a pair
/// without torque.
fn bench(name: &str, text: &str, options: &[String]) -> Kind {
    let bytes = Text {
        name: name.to_owned(),
        content: Ok(text.as_bytes().to_vec()),
    };
    let [pair, run] = ["identify", "predict"].map(|command| make::settings(command, options));
    let mut without_torque = pair.clone();
    without_torque.preparation.is_correction = true;
    let mut best = Kind {
        kind: "map",
        points: 0,
    };
    let mut furthest = 0;
    for (settings, kind) in [(pair, "map"), (run, "run"), (without_torque, "map")] {
        match texts::read(&bytes, &settings) {
            Ok(bench) => {
                return Kind {
                    kind: match bench.kind {
                        Rotors::Pair => "map",
                        Rotors::SingleRotor => "run",
                    },
                    points: bench.points_used,
                };
            }
            Err(refusal) => {
                let (_, line) = refusal.file_and_line();
                if line > Some(furthest) {
                    furthest = line.unwrap_or_default();
                    best.kind = kind;
                }
            }
        }
    }
    best
}
