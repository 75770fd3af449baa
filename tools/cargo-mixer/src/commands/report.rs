//! `cargo mixer report`: an airframe in pictures, one self-contained page.

mod bench;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mixer_compiler::Compiled;
use mixer_files::report::bench::BenchPoints;
use mixer_files::report::page;
use mixer_files::report::study::{Flown, Study};
use mixer_files::review::Options;
use mixer_identify::identified::Settings;
use mixer_identify::texts::Text;
use sha2::{Digest as _, Sha256};

use super::review::{mass, review};
use crate::bench_args::{ReadingArgs, quantity};
use crate::bench_files;
use crate::{Done, file, print_error};

/// Writes one self-contained page about an airframe: its layout, maps, authority, comparison and
/// tables
///
/// The page needs no network, follows the reader's light or dark scheme, and prints.
#[derive(clap::Args, Debug)]
pub struct ReportArgs {
    /// The airframe file
    airframe: PathBuf,
    /// The page to write, whole or not at all
    #[arg(short, long, value_name = "REPORT.html")]
    output: PathBuf,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
    /// The pair of the bench files and of the flight's points, of an airframe with several [default: the first]
    #[arg(long, value_name = "NAME")]
    pair: Option<String>,
    /// Bench files of the pair, to be shown beside the model
    #[arg(long, value_name = "BENCH.csv")]
    bench: Vec<PathBuf>,
    /// How the bench files are read [default: as the airframe file remembers]
    #[command(flatten)]
    reading: ReadingArgs,
    /// A flight log, to be shown beside the model, as review reads it
    #[arg(long, value_name = "LOG")]
    log: Option<PathBuf>,
    /// Mass in that flight, kg [default: that of the airframe file]
    #[arg(long, value_name = "KG", value_parser = mass, requires = "log", allow_negative_numbers = true)]
    mass: Option<f64>,
    /// Total thrust of the comparison at constant thrust, N [default: the weight, without a mass
    /// about 40 % of the largest bare thrust]
    #[arg(long, value_name = "NEWTON", value_parser = thrust, allow_negative_numbers = true)]
    thrust: Option<f64>,
}

impl ReportArgs {
    fn flown(&self, log: &Path, compiled: &Compiled, pair: usize) -> Result<Flown, ExitCode> {
        let options = Options {
            mass_kg: self.mass,
            bench_us: self.reading.pwm_range,
        };
        let review = review(log, compiled, &options).map_err(print_error)?;
        Ok(Flown {
            log: log.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            lines: review.lines(),
            throttles: review
                .flown
                .into_iter()
                .filter(|(of, _)| *of == pair)
                .map(|(_, at)| at)
                .collect(),
        })
    }
}

/// Bench files of the airframe's pair, read by `given`, else as `identify` read them by what the file
/// remembers.
///
/// # Errors
/// Remembered options that are none, a file that cannot be read or that holds a single rotor.
pub fn bench_points(study: &Study<'_>, files: &[Text], given: Settings) -> Result<BenchPoints, String> {
    if study.of_pair().is_none() {
        let name = &study.compiled.airframe.name;
        return Err(format!("no unit of {name} is a pair, as bench files are of"));
    }
    let settings = match given.options.as_slice() {
        [] => remembered(study)?,
        _ => given,
    };
    bench::read(study, files, &settings).map_err(|refusal| refusal.to_string())
}

fn remembered(study: &Study<'_>) -> Result<Settings, String> {
    let options = study.of_pair().map_or(&[][..], |(pair, _)| &pair.bench_options);
    let remembered = ReadingArgs::remembered(options);
    remembered.map(|reading| reading.settings()).map_err(|error| {
        let place = &study.compiled.source.name;
        format!("{place}: `pair.bench_options`: {error}; they are those of cargo mixer identify --help")
    })
}

/// Runs the command.
pub fn run(args: &ReportArgs) -> Done {
    let inputs = args.bench.iter().chain(&args.log).chain([&args.airframe]);
    file::writable(&args.output, args.force, inputs)?;
    let compiled = crate::compile(&args.airframe)?;
    let study = Study::new(&compiled, args.thrust).of(args.pair.as_deref());
    let mut study = study.map_err(print_error)?;
    let bench = match args.bench.as_slice() {
        [] => None,
        files => {
            let texts = bench_files::texts(files);
            Some(bench_points(&study, &texts, args.reading.settings()).map_err(print_error)?)
        }
    };
    for doubt in bench.iter().flat_map(|bench| bench.doubts(&study)) {
        crate::print_note(format_args!("warning: {doubt}"));
    }
    study.flown = args
        .log
        .as_deref()
        .map(|log| args.flown(log, &compiled, study.index))
        .transpose()?;
    let digest = mixer_facts::input::read_small(&args.airframe)
        .ok()
        .map(|bytes| sha256(&bytes));
    let page = page::page(&study, bench.as_ref(), digest.as_deref());
    file::save(&args.output, &page).map_err(print_error)
}

/// The digest of a file's bytes in hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A thrust on the command line, N.
pub(crate) fn thrust(text: &str) -> Result<f64, String> {
    quantity(text, "newtons")
}
