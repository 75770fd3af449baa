//! What a dropped file is.

use mixer_compiler::Source;
use mixer_files::import;
use mixer_identify::bench::Kind as Rotors;
use mixer_identify::bench::header::Offers;
use mixer_identify::identified::Settings;
use mixer_identify::texts::{self, Text};
use serde::Serialize;
use toml_edit::DocumentMut;

/// What a file is, and how many points a bench file has.
#[derive(Debug, Serialize, PartialEq, Eq)]
pub struct Kind {
    /// `airframe`, `pair`, `parameters`, `map` (a bench file of a pair) or `run` (of one rotor).
    pub kind: &'static str,
    /// Points of a bench file.
    pub points: usize,
}

/// Tells a file by its content. What cannot be told is taken for a pair's bench file, whose reader says
/// best what is wrong with it.
pub fn kind(name: &str, text: &str) -> Kind {
    let is = |kind| Kind { kind, points: 0 };
    if let Ok(document) = text.parse::<DocumentMut>() {
        let has = |key| document.contains_key(key);
        if has("unit") || has("layout") {
            return is("airframe");
        }
        if has("pair") {
            return is("pair");
        }
    }
    let source = Source::new(name, text);
    if name.ends_with(".toml") {
        return is("airframe");
    }
    let states = |word| text.contains(word);
    if import::stated(&source).is_ok() || ["CA_ROTOR", "FRAME_CLASS", "mmix"].into_iter().any(states) {
        return is("parameters");
    }
    let bytes = Text {
        name: name.to_owned(),
        content: Ok(text.as_bytes().to_vec()),
    };
    let rotors = |settings: &Settings| {
        Some(texts::read(&bytes, settings).ok()?).map(|bench| (bench.kind, bench.points_used))
    };
    let mut of_one_rotor = Settings::default();
    of_one_rotor.reading.by_hand.offers = Offers::OneRotor;
    of_one_rotor.preparation.own_columns = true;
    let lacks_torque = {
        let mut settings = Settings::default();
        settings.preparation.torque_may_lack = true;
        settings
    };
    match rotors(&lacks_torque) {
        Some((Rotors::Pair, points)) => Kind { kind: "map", points },
        Some((Rotors::SingleRotor, points)) => Kind { kind: "run", points },
        None => match rotors(&of_one_rotor) {
            Some((Rotors::SingleRotor, points)) => Kind { kind: "run", points },
            _ => is("map"),
        },
    }
}
