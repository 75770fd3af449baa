//! `cargo mixer params`: an airframe's parameters as files that a flight stack loads.

use std::path::PathBuf;

use mixer_files::params::Stack;
use mixer_files::params::{Betaflight, Format, Options, params};

use crate::bench_args::{pwm_range, words};
use crate::{Done, file, print_error};

/// Writes an airframe's parameters for a flight stack, each with its reason
///
/// Without --own they are for this mixer: `examples/px4`, `examples/ardupilot` or
/// `examples/betaflight` puts out the throttles. With it they are for the stack's own mixer on the same vehicle, to compare with.
///
/// PX4:       CA_* in motor order, hover and least thrust, failure detection, what must be off.
///            `--format airframe` writes a start script for PX4's simulator and, beside it as
///            FILE.post, what starts this mixer in place of control_allocator.
/// ArduPilot: FRAME_CLASS, with --own FRAME_TYPE, and MOT_*.
/// Betaflight: lines of the CLI, mixer or mmix, idle, hover, what must be off.
///
/// Parameters that need more than the airframe file says are named on stderr and in the file.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct ParamsArgs {
    /// The airframe file
    airframe: PathBuf,
    /// The flight stack
    #[arg(long, value_parser = words(&Stack::ALL))]
    stack: Stack,
    /// The file's form
    #[arg(long, value_parser = words(&Format::ALL), default_value = "parameters")]
    format: Format,
    /// For the stack's own mixer instead of this one
    #[arg(long)]
    own: bool,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds, as `1000,2000` [default: those
    /// that identify needed]
    #[arg(long, value_name = "LOW,HIGH", value_parser = pwm_range)]
    pwm_range: Option<[f64; 2]>,
    /// Betaflight's version, or the last one before it
    #[arg(long, value_parser = words(&Betaflight::ALL), default_value = "2026.6")]
    version: Betaflight,
    /// The file to write; without it stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite the file if it is there
    #[arg(long)]
    force: bool,
}

/// Runs the command.
pub fn run(args: &ParamsArgs) -> Done {
    let compiled = crate::compile(&args.airframe)?;
    let options = Options {
        stack: args.stack,
        format: args.format,
        own: args.own,
        pulses_us: args.pwm_range,
        betaflight: args.version,
    };
    let name = args.airframe.file_name().unwrap_or_default().to_string_lossy();
    let made = params(&compiled, &name, &options).map_err(print_error)?;
    match (&args.output, made.post) {
        (None, None) => crate::print(&made.text)?,
        (None, Some(_)) => {
            let message = "--format airframe writes two files: -o FILE names the first";
            return Err(print_error(message));
        }
        (Some(path), post) => {
            let mut beside = path.clone().into_os_string();
            beside.push(".post");
            let beside = PathBuf::from(beside);
            let files = [(path, Some(made.text.as_str())), (&beside, post)];
            let files = files.iter().filter_map(|(path, text)| Some((path, (*text)?)));
            for (path, _) in files.clone() {
                file::writable(path, args.force, [&args.airframe])?;
            }
            for (path, text) in files {
                file::save(path, text).map_err(print_error)?;
            }
        }
    }
    crate::print_notes("note", &made.notes);
    Ok(())
}
