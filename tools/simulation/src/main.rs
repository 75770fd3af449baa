//! Flies the paper's manoeuvre with both mixers, prints Table II and writes its figures.

use std::error::Error;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use simulation::figures;
use simulation::flight::Scenario;
use simulation::log;
use simulation::mixer::Method;
use simulation::table::Comparison;
use simulation::vehicle;

/// Flies the ISAE X8 through the paper's manoeuvre with the coaxial and with the conventional
/// mixer.
#[derive(Parser)]
struct Arguments {
    /// Number of seeds: rotor mismatch and air differ from seed to seed
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=1000))]
    seeds: u64,
    /// Write Fig. 8, 9 and 10 of the first seed as SVG into this folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Write the flights of the first seed and the errors of all flights as CSV into this folder
    #[arg(long, value_name = "DIR")]
    csv: Option<PathBuf>,
    /// Write the errors of all flights as CSV to this file
    #[arg(long, value_name = "FILE")]
    errors: Option<PathBuf>,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let airframe = vehicle::airframe()?;
    for folder in arguments.plots.iter().chain(&arguments.csv) {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let mut out = std::io::stdout().lock();
    let mut comparisons = Vec::new();
    for scenario in Scenario::ALL {
        let flights = (1..=arguments.seeds)
            .map(|seed| scenario.fly(&airframe, seed))
            .collect::<Result<_, _>>()?;
        let comparison = Comparison { scenario, flights };
        writeln!(out, "{comparison}")?;
        comparisons.push(comparison);
    }
    writeln!(out, "docs/flights.md says what this shows, and what it does not.")?;
    for Comparison { scenario, flights } in &comparisons {
        let Some(first) = flights.first() else { continue };
        if let Some(folder) = &arguments.plots {
            for (name, svg) in figures::draw(scenario, first) {
                fs::write(folder.join(name), svg)?;
            }
        }
        if let Some(folder) = &arguments.csv {
            for method in Method::BOTH {
                let path = folder.join(format!("{}-{method}.csv", scenario.slug()));
                log::write_flight(first.with(method), create(&path)?)?;
            }
        }
    }
    let tracking = arguments.csv.as_ref().map(|folder| folder.join("tracking.csv"));
    for path in tracking.iter().chain(&arguments.errors) {
        log::write_tracking(&comparisons, create(path)?)?;
    }
    Ok(())
}

fn create(path: &Path) -> Result<File, String> {
    File::create(path).map_err(|error| format!("{}: {error}", path.display()))
}
