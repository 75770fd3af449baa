//! Text in, text out: what a front end calls, be it the command line, a page or a notebook.

use mixer_compiler::diagnostic::content::{self, Content};
use serde::Serialize;

use super::air::Air;
use super::bench::read::{self, Log};
use super::bench::text::normalised;
use super::bench::{self, Bench, few_refused};
use super::identified::{Identified, Settings, with_runs};
use super::lag::{self, RotorLag};
use super::refusal::Refusal;
use super::rotor::predict::{self, PredictOptions, Predicted};
use super::rotor::single::{RunFacts, Single};
use super::{fragment, report};

/// A bench file.
#[derive(Debug, Clone)]
pub struct Text {
    /// Its name without folders, as it is told.
    pub name: String,
    /// Its bytes, UTF-8 or Latin-1, or why it cannot be read.
    pub content: Result<Vec<u8>, Refusal>,
}

/// What came of files.
#[derive(Debug, Clone)]
pub struct Outcome<T> {
    /// In numbers.
    pub found: T,
    /// The report in at most 30 lines of 100 columns.
    pub report: String,
    /// Every number.
    pub details: String,
    /// The tables of an airframe file; [`PairFile`](super::pair_file::PairFile) reads them.
    pub tables: String,
    /// Everything as JSON.
    pub json: String,
}

impl<T> Outcome<T> {
    /// Its texts alone.
    pub fn texts(self) -> Outcome<()> {
        Outcome {
            found: (),
            report: self.report,
            details: self.details,
            tables: self.tables,
            json: self.json,
        }
    }
}

/// Reads a file and makes it ready.
///
/// # Errors
/// A file that cannot be read or used.
pub fn read(text: &Text, settings: &Settings) -> Result<Bench, Refusal> {
    bench::prepare(log(text, settings)?, &settings.preparation)
}

fn log(text: &Text, settings: &Settings) -> Result<Log, Refusal> {
    let bytes = text.content.as_ref().map_err(Refusal::clone)?;
    read::read(&text.name, bytes.as_slice(), &settings.reading)
        .map_err(|refusal| of_another_kind(&text.name, bytes).unwrap_or(refusal))
}

/// The refusal of a file that was meant for another command; `None` of a table and of what nothing is known of.
fn of_another_kind(name: &str, bytes: &[u8]) -> Option<Refusal> {
    let kind = content::of(&normalised(name, bytes).ok()?);
    let is_table = matches!(kind, Content::Table | Content::Other);
    let needed = "the table with the measurements as CSV";
    (!is_table).then(|| Refusal::of(name, format!("this is {}", kind.description()), needed))
}

fn read_all(texts: &[Text], settings: &Settings) -> Result<Vec<Bench>, Vec<Refusal>> {
    all(texts.iter().map(|text| read(text, settings)))
}

/// All of them, or all refusals.
fn all<T>(results: impl Iterator<Item = Result<T, Refusal>>) -> Result<Vec<T>, Vec<Refusal>> {
    let (ready, refused): (Vec<_>, Vec<_>) = results.partition(Result::is_ok);
    match refused.is_empty() {
        true => Ok(ready.into_iter().flatten().collect()),
        false => Err(refused.into_iter().filter_map(Result::err).collect()),
    }
}

/// Refuses an option that had nothing to work on in any of the files that were read by it.
fn in_use(benches: &[&Bench]) -> Result<(), Refusal> {
    let Some((first, others)) = benches.split_first() else {
        return Ok(());
    };
    let is_idle = |option: &&String| others.iter().all(|bench| bench.idle_options.contains(option));
    match first.idle_options.iter().find(is_idle) {
        None => Ok(()),
        Some(option) => Err(Refusal::general(
            format!("{option} has nothing to work on: no file has such a column"),
            "no such option, or the column that is meant: --column ROLE=HEADER",
        )),
    }
}

/// Identifies a pair from maps, and its rotors alone from `runs` of the upper and of the lower one.
///
/// # Errors
/// All files that cannot be read or used, else why they do not give a pair.
pub fn identify(
    maps: &[Text],
    runs: [Option<&Text>; 2],
    settings: &Settings,
) -> Result<Outcome<Identified>, Vec<Refusal>> {
    let benches = read_all(maps, settings)?;
    let run = |run: Option<&Text>| run.map(|run| read(run, settings)).transpose();
    let [upper, lower] = runs;
    let found = run(upper).and_then(|upper| {
        let runs = [upper, run(lower)?];
        in_use(&benches.iter().chain(runs.iter().flatten()).collect::<Vec<_>>())?;
        with_runs(benches, runs, &settings.wishes)
    });
    let mut found = found.map_err(|refusal| vec![refusal])?;
    found.options.clone_from(&settings.options);
    Ok(Outcome {
        report: report::verdict(&found),
        details: report::text(&found),
        tables: fragment::text(&found),
        json: json(&found)?,
        found,
    })
}

/// How a pair is predicted.
#[derive(Debug, Clone, Default)]
pub struct Prediction {
    /// How runs of one rotor are read.
    pub run: Settings,
    /// How rows of the pair are read.
    pub map: Settings,
    /// What is known of the runs beside their files.
    pub known: RunFacts,
    /// What is wished of the pair.
    pub wishes: PredictOptions,
}

/// Predicts a pair from a run of the upper rotor and, where it differs, of the lower one; rows of the
/// pair in `maps`, where there are any, correct it.
///
/// # Errors
/// All maps that cannot be read or used, else why there is no pair.
pub fn predict(
    upper: &Text,
    lower: Option<&Text>,
    maps: &[Text],
    how: &Prediction,
) -> Result<Outcome<Predicted>, Vec<Refusal>> {
    let mut maps = read_all(maps, &how.map)?;
    let run = |text: &Text| read(text, &how.run).map_err(|refusal| vec![refusal]);
    let (mut upper, mut lower) = (run(upper)?, lower.map(run).transpose()?);
    in_use(&[&upper].into_iter().chain(&lower).collect::<Vec<_>>()).map_err(|refusal| vec![refusal])?;
    in_use(&maps.iter().collect::<Vec<_>>()).map_err(|refusal| vec![refusal])?;
    // That of the voltage less 1, and 1 where a speed is held.
    let by_density = how.known.exponents.map(|k| if k == 0.0 { 1.0 } else { k - 1.0 });
    let air = Air::of([&upper].into_iter().chain(&lower).chain(&maps), by_density);
    let benches = [&mut upper].into_iter().chain(&mut lower).chain(&mut maps);
    benches.for_each(|bench| air.bring(bench));
    let read = [&upper].into_iter().chain(&lower).chain(&maps);
    let mut warnings: Vec<String> = read.flat_map(Bench::passed_over).collect();
    warnings.extend(air.doubt());
    let mut single = |run: &Bench| Single::of(run, &how.known, &mut warnings);
    let runs = single(&upper).and_then(|upper| Ok((upper, lower.as_ref().map(single).transpose()?)));
    let found =
        runs.and_then(|(upper, lower)| predict::correct(upper, lower, &maps, air, &how.wishes, warnings));
    let mut found = found.map_err(|refusal| vec![refusal])?;
    found.options.clone_from(&how.map.options);
    let report = report::of_prediction(&found);
    Ok(Outcome {
        details: report.clone(),
        report,
        tables: fragment::of_prediction(&found),
        json: json(&found)?,
        found,
    })
}

/// Finds the lag at a throttle of the rotor whose steps `texts` have; `exponent` is that of thrust by voltage.
///
/// # Errors
/// All files that cannot be read, else why their steps tell no lag.
pub fn rotor_lag(
    texts: &[Text],
    exponent: f64,
    throttle: f64,
    settings: &Settings,
) -> Result<Outcome<RotorLag>, Vec<Refusal>> {
    let logs = all(texts.iter().map(|text| {
        let log = log(text, settings)?;
        few_refused(&log.name, &log.refused, log.samples.len() + log.refused.len())?;
        Ok(log)
    }))?;
    let found = lag::find(&logs, exponent, throttle).map_err(|refusal| vec![refusal])?;
    let report = report::of_lag(&found);
    Ok(Outcome {
        details: report.clone(),
        report,
        tables: String::new(),
        json: json(&found)?,
        found,
    })
}

fn json(what: &impl Serialize) -> Result<String, Vec<Refusal>> {
    serde_json::to_string_pretty(what)
        .map_err(|error| vec![Refusal::general(error.to_string(), "numbers that JSON can hold")])
}
