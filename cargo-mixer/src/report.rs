//! `cargo mixer report`: an airframe in pictures, one self-contained page.

mod bench;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};
use std::{env, fs};

use mixer_report::origin::Origin;
use mixer_report::page;
use mixer_report::study::Study;

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
    /// Bench files of the pair, to be shown beside the model
    #[arg(long, value_name = "BENCH.csv")]
    bench: Vec<PathBuf>,
    /// Total thrust of the comparison at constant thrust, N [default: about 40 % of the largest
    /// bare thrust]
    #[arg(long, value_name = "NEWTON", value_parser = thrust, allow_negative_numbers = true)]
    thrust: Option<f64>,
}

/// Runs the command.
pub fn run(args: &ReportArgs) -> ExitCode {
    if let Some(status) = overwriting(&args.output, args.bench.iter().chain([&args.airframe])) {
        return status;
    }
    let compiled = match crate::compile(&args.airframe) {
        Ok(compiled) => compiled,
        Err(refusal) => return refusal.report(),
    };
    let bench = match args.bench.as_slice() {
        [] => None,
        files => match bench::read(&compiled, files) {
            Ok(bench) => Some(bench),
            Err(refusal) => return crate::print_error(refusal),
        },
    };
    for doubt in bench.iter().flat_map(|bench| bench.doubts(&compiled)) {
        crate::print_note(format_args!("warning: {doubt}"));
    }
    let study = Study::new(&compiled, args.thrust);
    let page = page::page(&study, bench.as_ref(), &origin(&args.airframe));
    match crate::file::write(&args.output, &page) {
        Ok(()) => {
            crate::print_note(format_args!("wrote {}", args.output.display()));
            ExitCode::SUCCESS
        }
        Err(message) => crate::print_error(message),
    }
}

/// The origin of a page that is made now of this file. `SOURCE_DATE_EPOCH`, seconds since 1970,
/// stands for now (reproducible-builds.org).
fn origin(airframe: &Path) -> Origin {
    let stated = env::var("SOURCE_DATE_EPOCH")
        .ok()
        .and_then(|text| text.parse().ok());
    let seconds = stated.or_else(|| {
        let passed = SystemTime::now().duration_since(UNIX_EPOCH);
        passed.ok().map(|passed| passed.as_secs())
    });
    Origin {
        sha256: fs::read(airframe).ok().map(|bytes| crate::file::sha256(&bytes)),
        date: seconds.map(date),
    }
}

/// The date (UTC) of seconds since 1970. Days are counted from 1 March of year 0, so that leap days
/// end their years; 400 years have 146,097 days.
fn date(seconds: u64) -> String {
    let days = seconds / 86_400 + 719_468;
    let (cycle, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    // Months from March on have 153 days in five.
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * cycle + year + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Complains where the output is one of the inputs; the exit status for bad usage.
pub(crate) fn overwriting<'a>(
    output: &Path,
    inputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Option<ExitCode> {
    let same = |input: &PathBuf| match (input.canonicalize(), output.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => input == output,
    };
    inputs.into_iter().any(same).then(|| {
        crate::print_error(format_args!(
            "{} is an input and would be overwritten",
            output.display()
        ));
        ExitCode::from(2)
    })
}

/// A thrust on the command line, N.
pub(crate) fn thrust(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(thrust) if thrust > 0.0 && thrust.is_finite() => Ok(thrust),
        _ => Err(format!("{text:?} is not a positive number of newtons")),
    }
}

#[cfg(test)]
mod tests {
    use super::date;

    /// By GNU date.
    #[test]
    fn dates_are_those_of_the_calendar() {
        let days = [
            (0, "1970-01-01"),
            (951_782_399, "2000-02-28"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_735_689_599, "2024-12-31"),
            (1_795_392_000, "2026-11-23"),
            (4_107_542_400, "2100-03-01"),
        ];
        for (seconds, day) in days {
            assert_eq!(date(seconds), day);
        }
    }
}
