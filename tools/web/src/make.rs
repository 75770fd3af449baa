//! Commands that make a pair's tables or an airframe file, by the arguments of the command line.

use std::collections::BTreeMap;
use std::path::Path;

use cargo_mixer::bench_args::said;
use cargo_mixer::commands::identify::{IdentifyArgs, NoAnswer};
use cargo_mixer::commands::import::ImportArgs;
use cargo_mixer::commands::new::NewArgs;
use cargo_mixer::commands::predict::PredictArgs;
use cargo_mixer::place::tables_or_airframe;
use clap::{CommandFactory as _, Parser};
use mixer_compiler::Source;
use mixer_compiler::diagnostic::printable_lines;
use mixer_files::kind::File;
use mixer_identify::bench::read;
use mixer_identify::identified::Settings;
use mixer_identify::refusal::Refusal;
use mixer_identify::texts::{Outcome, Text};
use serde::Serialize;

/// The commands, with the arguments that they have on the command line.
#[derive(Parser)]
#[command(name = "cargo mixer", bin_name = "cargo mixer")]
enum Make {
    Identify(Box<IdentifyArgs>),
    Predict(Box<PredictArgs>),
    Import(ImportArgs),
    New(NewArgs),
}

/// The files that words can name.
#[derive(Debug, Default)]
pub struct Files(BTreeMap<String, String>);

impl Files {
    /// Files with their names and texts.
    pub fn new(names: Vec<String>, texts: Vec<String>) -> Self {
        Files(names.into_iter().zip(texts).collect())
    }

    /// A bench file, or that there is none of this name.
    fn text(&self, path: &Path) -> Text {
        let name = path.to_string_lossy().into_owned();
        let content = match self.0.get(&name) {
            Some(text) => Ok(text.clone().into_bytes()),
            None => Err(read::unreadable(&name, "the page has no such file")),
        };
        Text { name, content }
    }

    /// All of them as bench files.
    pub fn texts(&self) -> Vec<Text> {
        self.0.keys().map(|name| self.text(Path::new(name))).collect()
    }

    fn source(&self, path: &Path) -> Result<Source, Fault> {
        let name = path.to_string_lossy().into_owned();
        let text = self.0.get(&name);
        text.map(|text| Source::new(name.as_str(), text.as_str()))
            .ok_or_else(|| Fault::general(format!("{name}: the page has no such file")))
    }
}

/// A file that was made.
#[derive(Debug, Default, Serialize)]
pub struct Made {
    /// The tables of a pair, or an airframe file.
    pub toml: String,
    /// What is said of it.
    pub report: String,
    /// What is doubtful in it.
    pub warnings: Vec<Fault>,
    /// What else its user has to know.
    pub notes: Vec<Fault>,
}

/// What is to be known of files: why nothing was made of them, or what is doubtful in them.
#[derive(Debug, Default, Serialize)]
pub struct Fault {
    /// The file; empty where none is to blame.
    pub file: String,
    /// Its line, from 1.
    pub line: Option<u64>,
    /// What is wrong.
    pub message: String,
    /// What would mend it.
    pub help: String,
    /// Options of the command line that message and help name whole, each as the words of a line.
    pub mends: Vec<String>,
}

impl Fault {
    fn general(message: impl Into<String>) -> Self {
        Fault {
            message: message.into(),
            ..Fault::default()
        }
    }

    /// The same with the options of a command that it names.
    fn mended_by(mut self, command: &str) -> Self {
        self.mends = mends(command, &format!("{} {}", self.message, self.help));
        self
    }

    fn of(refusal: &Refusal) -> Self {
        let (file, line) = refusal.file_and_line();
        Fault {
            file: file.to_owned(),
            line,
            message: refusal.reason.clone(),
            help: refusal.needed.clone(),
            ..Fault::default()
        }
    }
}

/// Runs `identify`, `predict`, `import` or `new` with the words of the command line, the command
/// first. Nothing is written: what `-o` would hold is the result.
///
/// # Errors
/// Words that are none of the command's, files that cannot serve.
pub fn make(words: &[String], files: &Files) -> Result<Made, Vec<Fault>> {
    let name = words.first().map_or("", String::as_str);
    let refused = |refusals: Vec<Refusal>| {
        let faults = refusals.iter().map(|refusal| Fault::of(refusal).mended_by(name));
        faults.collect::<Vec<_>>()
    };
    let words = ["cargo mixer"]
        .into_iter()
        .chain(words.iter().map(String::as_str));
    let reader = |path: &Path| files.text(path);
    let general = |message: String| vec![Fault::general(message)];
    // The first line of what clap says; the others are about a command line.
    let usage = |error: clap::Error| general(said(&error).lines().next().unwrap_or_default().to_owned());
    let command = Make::try_parse_from(words).map_err(usage)?;
    match command {
        Make::Identify(args) => {
            let (answer, notes) = args.answer(&reader).map_err(|none| match none {
                NoAnswer::Usage(message) => general(message.to_owned()),
                NoAnswer::Refused(refusals) => refused(refusals),
            })?;
            let text = tables_or_airframe(&answer, args.place.frame.as_ref(), args.place.output.as_deref());
            Ok(answered(name, text.map_err(general)?, &answer, notes))
        }
        Make::Predict(args) => {
            let answer = args.answer(&reader).map_err(refused)?;
            let text = tables_or_airframe(&answer, args.place.frame.as_ref(), args.place.output.as_deref());
            Ok(answered(name, text.map_err(general)?, &answer, Vec::new()))
        }
        Make::Import(args) => {
            let source = |path| files.source(path).map_err(|fault| vec![fault]);
            let parameters = source(&args.file)?;
            let pair = args.pair.as_deref().map(source).transpose()?;
            let made = args.answer(&parameters, pair.as_ref()).map_err(general)?;
            let faults = |told: Vec<String>| told.into_iter().map(Fault::general).collect();
            Ok(Made {
                toml: made.text,
                warnings: faults(made.warnings),
                notes: faults(made.notes),
                ..Made::default()
            })
        }
        Make::New(args) => {
            let pairs = args.pairs().map_err(general)?.into_iter();
            let pairs = pairs.map(|(name, path)| Ok((name, files.source(&path)?)));
            let pairs: Vec<_> = pairs.collect::<Result<_, _>>().map_err(|fault| vec![fault])?;
            Ok(Made {
                toml: args.text(&pairs).map_err(|error| general(error.to_string()))?,
                ..Made::default()
            })
        }
    }
}

/// `notes` are of rows that were passed over; the answer has its own warnings.
fn answered<T>(command: &str, toml: String, answer: &Outcome<T>, notes: Vec<String>) -> Made {
    let json: serde_json::Value = serde_json::from_str(&answer.json).unwrap_or_default();
    let warnings = json["warnings"].as_array().into_iter().flatten();
    let warnings = warnings.filter_map(|warning| warning.as_str().map(str::to_owned));
    let notes = notes.into_iter().chain(warnings);
    Made {
        toml,
        report: printable_lines(&answer.report),
        warnings: notes
            .map(|note| Fault::general(note).mended_by(command))
            .collect(),
        ..Made::default()
    }
}

/// The options in a text that `identify` or `predict` take as they stand there, as `--tare` and
/// `--unit thrust=gf`: without those that name a file, and without placeholders as `--run-voltage VOLT`.
fn mends(command: &str, text: &str) -> Vec<String> {
    let words = text.split_whitespace();
    let words: Vec<&str> = words
        .map(|word| word.trim_matches(|c: char| "`\"'(,;:.)".contains(c)))
        .collect();
    let takes = |option: &str| Make::try_parse_from(["cargo mixer", command, "FILE", option]).is_ok();
    let options = words
        .iter()
        .enumerate()
        .filter(|(_, word)| word.starts_with("--"));
    let whole = |(k, word): (usize, &&str)| match words.get(k + 1).filter(|value| is_value(value)) {
        Some(value) if takes(&format!("{word}={value}")) => Some(format!("{word} {value}")),
        _ => takes(word).then(|| (*word).to_owned()),
    };
    options.filter_map(whole).collect()
}

/// Whether a word is a value and no placeholder for one.
fn is_value(word: &str) -> bool {
    !word.ends_with('=') && !word.chars().any(char::is_uppercase)
}

/// Tells what a file is; a bench file is read with these options of the command line.
///
/// # Errors
/// A file that is of no use here: what it is.
pub fn kind(name: &str, bytes: &[u8], options: &[String]) -> Result<File, String> {
    let [identify, predict] = ["identify", "predict"].map(|command| settings(command, options));
    mixer_files::kind::read(name, bytes, &identify, &predict)
}

/// How a command reads a bench file with these options; with options that are none of its own, as
/// without.
fn settings(command: &str, options: &[String]) -> Settings {
    let words = ["cargo mixer", command, "FILE"].into_iter();
    let given = Make::try_parse_from(words.clone().chain(options.iter().map(String::as_str)));
    match given.or_else(|_| Make::try_parse_from(words)) {
        Ok(Make::Identify(args)) => args.settings(),
        Ok(Make::Predict(args)) => args.settings(),
        _ => Settings::default(),
    }
}

/// The options of a command as its `--help` tells them; nothing of a command that is none.
pub fn help(command: &str) -> String {
    let mut all = Make::command();
    let found = all.find_subcommand_mut(command);
    found.map_or_else(String::new, |command| command.render_long_help().to_string())
}

/// The words of a line as a POSIX shell parts them.
///
/// # Errors
/// A quote that is open.
pub fn words(line: &str) -> Result<Vec<String>, String> {
    shlex::split(line).ok_or_else(|| format!("a quote is open in {line}"))
}
