//! `cargo mixer review`: a flight log over the model.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mixer_compiler::Compiled;
use mixer_files::review::{Options, Review, scaled};

use crate::bench_args::{pwm_range, quantity};
use crate::{Done, airframe_file, file, print_error, print_note};

/// Holds a flight log against the model of an airframe: thrust, hover, torque left, saturation
///
/// The log is PX4's ULog (.ulg) or ArduPilot's DataFlash log (.bin), flown with this mixer or with the
/// stack's own. From the logged outputs and voltage the model says thrust and torque; the
/// accelerometer says thrust over mass.
#[derive(clap::Args, Debug)]
pub struct ReviewArgs {
    /// The flight log
    log: PathBuf,
    /// The airframe file
    airframe: PathBuf,
    /// Write the airframe file with its thrust over the scale that the log gives: one scale, to 5 %, that is not 1
    #[arg(short, long, value_name = "SCALED.toml")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there, and write a scale that the log leaves open
    #[arg(long)]
    force: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Mass in this flight, kg [default: that of the airframe file]
    #[arg(long, value_name = "KG", value_parser = mass, allow_negative_numbers = true)]
    mass: Option<f64>,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds, as `1000,2000` [default: those
    /// that identify needed]
    #[arg(long, value_name = "LOW,HIGH", value_parser = pwm_range)]
    pwm_range: Option<[f64; 2]>,
}

/// A mass on the command line, kg.
pub(crate) fn mass(text: &str) -> Result<f64, String> {
    quantity(text, "kilograms")
}

/// A log over a model.
pub(crate) fn review(log: &Path, compiled: &Compiled, options: &Options) -> Result<Review, String> {
    let bytes = file::read_log(log)?;
    Review::new(&log.display().to_string(), &bytes, compiled, options)
}

/// Runs the command.
pub fn run(args: &ReviewArgs) -> Done {
    if let Some(output) = &args.output {
        file::writable(output, args.force, [&args.log, &args.airframe])?;
    }
    let compiled = crate::compile(&args.airframe)?;
    let options = Options {
        mass_kg: args.mass,
        bench_us: args.pwm_range,
    };
    let review = review(&args.log, &compiled, &options).map_err(|error| refused(args, &error))?;
    if args.json {
        let json = serde_json::to_value(&review).unwrap_or_default();
        crate::print(&format!("{json:#}\n"))?;
    } else {
        crate::print(&review.to_string())?;
    }
    let Some(output) = &args.output else {
        return Ok(());
    };
    if let Some(reason) = review.undecided().filter(|_| !args.force) {
        let message = format!("{reason}; --force writes {} all the same", output.display());
        return Err(print_error(message));
    }
    let log = args.log.file_name().unwrap_or_default().to_string_lossy();
    let text = scaled(&compiled.source.text, &review, &log).map_err(print_error)?;
    airframe_file::write(output, &text, Some(&args.airframe))?;
    print_note(format_args!("next: cargo mixer check {}", output.display()));
    Ok(())
}

/// Says what is wrong with the log, on standard output, too, where the report is JSON.
fn refused(args: &ReviewArgs, error: &str) -> ExitCode {
    if args.json {
        let fault = crate::fault(&args.log.display().to_string(), None, error, "");
        let _ = crate::print(&format!("{:#}\n", crate::errors([fault])));
    }
    print_error(error)
}
