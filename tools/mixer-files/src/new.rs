//! A complete airframe file to begin with.

use std::fmt;

use mixer_compiler::Source;
use mixer_identify::pair_file::PairFile;

use crate::frame::NewFrame;
use mixer_compiler::diagnostic::printable_lines;

/// The pair that stands in for the user's own.
const STAND_IN: &str = include_str!("new/stand-in.toml");

/// Why there is no airframe file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The file with the pair's model has none.
    Pair(String),
    /// The frame is not fully described, or has no such part.
    Frame(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Error::Pair(message) | Error::Frame(message)) = self;
        f.write_str(message)
    }
}

impl std::error::Error for Error {}

/// An airframe file of a regular frame. `pair` is a file with the pair's model: what `identify` and
/// `predict` write, or another airframe's; without it the pair of the ISAE X8 stands in.
///
/// # Errors
/// A file without `[pair]`, an arm that is missing.
pub fn new(frame: &NewFrame<'_>, pair: Option<&Source>) -> Result<String, Error> {
    let (tables, bias) = match pair {
        None => (STAND_IN.to_owned(), None),
        Some(pair) => PairFile::read(&pair.name, &pair.text)
            .map_err(Error::Pair)?
            .model(),
    };
    let text = frame.airframe(&tables, bias).map_err(Error::Frame)?;
    Ok(printable_lines(&text))
}

/// Names of pairs that are places.
pub const PLACES: [&str; 4] = ["front", "rear", "left", "right"];

/// The same with several pairs by name. [`PLACES`], in any case of letters, are those of the units there, and the frame does
/// not depend on their order; other names go round the frame.
///
/// # Errors
/// As [`new`]; a name that is no place beside one that is, ranges of throttle that have nothing in common, a law of the
/// voltage or the air that one file has and another has not.
pub fn new_unlike(frame: &NewFrame<'_>, pairs: &[(String, Source)]) -> Result<String, Error> {
    let place = |name: &str| PLACES.iter().position(|place| place.eq_ignore_ascii_case(name));
    let mut files = Vec::new();
    for (name, file) in pairs {
        let name = place(name).map_or(name.as_str(), |place| PLACES[place]);
        let read = PairFile::read(&file.name, &file.text).map_err(Error::Pair)?;
        files.push((name, &file.name, read));
    }
    files.sort_by_key(|(name, ..)| place(name));
    let is_placed = files.iter().any(|(name, ..)| place(name).is_some());
    if let Some((name, ..)) = files.iter().find(|(name, ..)| is_placed && place(name).is_none()) {
        let places = PLACES.join(", ");
        return Err(Error::Frame(format!(
            "--pair {name}: places are {places}; other names go round the frame"
        )));
    }
    let angles = frame.angles_deg();
    let mut names = Vec::new();
    for (k, angle) in angles.into_iter().enumerate() {
        let (sin, cos) = (libm::sin(angle.to_radians()), libm::cos(angle.to_radians()));
        let along = if cos > 1e-9 { "front" } else { "rear" };
        let across = if sin > 1e-9 { "right" } else { "left" };
        let mut of_place = [along, across].into_iter();
        let name = match is_placed {
            // The compiler tells of a place without a pair.
            true => of_place
                .find(|place| files.iter().any(|(name, ..)| name == place))
                .unwrap_or(along),
            false => files[k % files.len()].0,
        };
        names.push(name.to_owned());
    }
    let range = |key: &'static str| {
        files
            .iter()
            .filter_map(move |(.., file)| file.number("throttle", key))
    };
    let [min, max] = [range("min").fold(0.0, f64::max), range("max").fold(1.0, f64::min)];
    if min >= max {
        return Err(Error::Pair(format!(
            "--pair: no throttle from {min} to {max} is in the ranges of all pairs"
        )));
    }
    let mut tables = format!(
        "[throttle]                             # what all pairs have\nmin = {min:?}\nmax = {max:?}\n\n"
    );
    // The law of the first file is the frame's; a pair of another takes its own along.
    for (table, mend) in [
        ("voltage", "--voltage-exponent 1.75 --cells N"),
        ("air", "--temperature C --pressure HPA"),
    ] {
        let one = |has: bool| files.iter().find(|(.., file)| file.has(table) == has);
        if let [Some((_, with, _)), Some((_, without, _))] = [true, false].map(one) {
            return Err(Error::Pair(format!(
                "{without}: no [{table}], and {with} has one: identify it again with {mend}, which writes it"
            )));
        }
        let (first, others) = files.split_at_mut(1);
        others
            .iter_mut()
            .for_each(|(.., file)| file.take_along(table, &first[0].2));
    }
    for (name, _, file) in &files {
        tables += &file.named(name);
    }
    tables += &files[0].2.tables(&["voltage", "air"]).0;
    let frame = NewFrame {
        pairs: names,
        ..frame.clone()
    };
    let text = frame.airframe(&tables, None).map_err(Error::Frame)?;
    Ok(printable_lines(&text))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::frame::Frame;
    use crate::import::{self, import};
    use crate::params::{Options, Stack, params};

    /// The shipped files whose pairs differ.
    const PAIRS: [&str; 7] = [
        "airframes/isae-x8.toml",
        "airframes/x8-11in-cubic.toml",
        "airframes/x8-11in-least-power.toml",
        "airframes/x8-16in-biquadratic.toml",
        "airframes/x8-16in-quartic.toml",
        "airframes/x8-22in-cubic.toml",
        "examples/simulator/x8-quartic.toml",
    ];

    fn file(path: &str) -> Source {
        let text = std::fs::read_to_string(format!("../../{path}"));
        Source::new(path, text.unwrap_or_else(|error| panic!("{path}: {error}")))
    }

    /// The codes of what `check` warns of.
    #[track_caller]
    fn warned(text: &str) -> BTreeSet<String> {
        let compiled = mixer_compiler::compile(&Source::new("a.toml", text));
        let compiled = compiled.unwrap_or_else(|faults| panic!("{faults}\n{text}"));
        let records = mixer_compiler::lint(&compiled).records();
        records.into_iter().map(|record| record.code).collect()
    }

    /// Whatever frame is written around whatever pair, it brings no warning that the pair's own file has not.
    #[test]
    fn no_frame_warns_of_itself() {
        for path in PAIRS {
            let pair = file(path);
            let of_pair = warned(&pair.text);
            for (frame, word, _) in Frame::ALL {
                let arm_m = (frame != Frame::Single).then_some(0.45);
                let orders = Stack::ALL.into_iter().map(|(stack, ..)| Some(stack));
                for outputs in [None].into_iter().chain(orders.filter(|_| path == PAIRS[0])) {
                    let wanted = NewFrame {
                        arm_m,
                        outputs,
                        ..NewFrame::of(frame)
                    };
                    // Not every stack has every frame.
                    let text = match new(&wanted, Some(&pair)) {
                        Ok(text) => text,
                        Err(error) if outputs.is_some() => {
                            assert!(error.to_string().starts_with("--outputs: "), "{error}");
                            continue;
                        }
                        Err(error) => panic!("{error}"),
                    };
                    let more: Vec<String> = warned(&text).difference(&of_pair).cloned().collect();
                    assert!(more.is_empty(), "{word} {outputs:?} of {path}: {more:?}\n{text}");
                }
            }
        }
    }

    /// Nor does what is imported of a stack's own parameters of it.
    #[test]
    fn no_import_warns_of_itself() {
        let pair = file(PAIRS[0]);
        for (stack, ..) in Stack::ALL {
            let wanted = NewFrame {
                arm_m: Some(0.45),
                outputs: Some(stack),
                ..NewFrame::of(Frame::X8)
            };
            let text = new(&wanted, Some(&pair)).unwrap();
            let compiled = mixer_compiler::compile(&Source::new("a.toml", text)).unwrap();
            let options = Options {
                own: true,
                ..Options::of(stack)
            };
            let set = params(&compiled, "a.toml", &options).unwrap().text;
            let options = import::Options {
                arm_m: Some(0.45),
                ..import::Options::default()
            };
            let made = import(&Source::new("a", set), Some(&pair), &options).unwrap();
            assert_eq!(warned(&made.text), BTreeSet::new(), "{stack:?}\n{}", made.text);
        }
    }
}
