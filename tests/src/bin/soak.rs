//! Draws frames of the zoo and requests for some minutes and holds every answer to the physics:
//! `cargo soak --minutes 60 --seed 7`. With `MIXER_BENCH_DATA` pairs of its maps are drawn,
//! too.

use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Parser;
use mixer_tests::frames;
use mixer_tests::soak::{Failure, Soak};

/// Draws frames and requests, and prints each failure with an airframe and a CSV row that reproduce
/// it. The exit status is 1 where something failed.
#[derive(Parser)]
struct Arguments {
    /// How long
    #[arg(long, default_value_t = 10.0)]
    minutes: f64,
    /// Of frames and requests
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The frame to begin with, or with --only the one to run
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// One frame and no more
    #[arg(long)]
    only: bool,
    /// Frames of two pairs
    #[arg(long)]
    unlike: bool,
    /// Frames with single rotors
    #[arg(long)]
    single_rotors: bool,
    /// Where the airframes of failures are written
    #[arg(short, long, value_name = "FOLDER", default_value = "target/soak")]
    output: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(failures) => {
            println!("{failures} failures");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The number of failures.
fn run(arguments: &Arguments) -> Result<usize, String> {
    let zoo = match std::env::var_os("MIXER_BENCH_DATA") {
        Some(data) => frames::zoo_with_bench_data(arguments.seed, Path::new(&data))?,
        None => frames::zoo(arguments.seed)?,
    };
    let zoo = if arguments.unlike { zoo.unlike() } else { zoo };
    let zoo = match arguments.single_rotors {
        true => zoo.with_single_rotors(),
        false => zoo,
    };
    let end = Instant::now() + Duration::from_secs_f64(60.0 * arguments.minutes);
    let mut soak = Soak::new(zoo, arguments.seed);
    let mut failures = 0;
    for index in arguments.from.. {
        let found = soak
            .frame(index)
            .map_err(|error| format!("frame {index}: {error}"))?;
        failures += found.len();
        print(found.iter(), &arguments.output)?;
        let left = end.saturating_duration_since(Instant::now());
        progress(&soak, failures, left);
        if left.is_zero() || arguments.only {
            break;
        }
    }
    println!(
        "seed {}, {} frames, {} mixes\n{soak}",
        arguments.seed,
        soak.frames(),
        soak.mixes()
    );
    print(soak.misses(), &arguments.output)?;
    Ok(failures + soak.misses().count())
}

fn print<'a>(failures: impl Iterator<Item = &'a Failure>, folder: &Path) -> Result<(), String> {
    for failure in failures {
        let report = failure.report(folder);
        let report = report.map_err(|error| format!("{}: {error}", folder.display()))?;
        clear();
        print!("{report}");
        io::stdout().flush().map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// One line on a terminal, written over.
fn progress(soak: &Soak, failures: usize, left: Duration) {
    if io::stderr().is_terminal() {
        let seconds = left.as_secs();
        eprint!(
            "\r{} frames, {} mixes, {failures} failures, {}:{:02} left ",
            soak.frames(),
            soak.mixes(),
            seconds / 60,
            seconds % 60
        );
    }
}

fn clear() {
    if io::stderr().is_terminal() {
        eprint!("\r\x1b[K");
    }
}
