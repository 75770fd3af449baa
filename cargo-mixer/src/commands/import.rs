//! `cargo mixer import`: an airframe file from a flight stack's parameters.

use std::path::PathBuf;

use mixer_files::import::{self, Options};

use crate::{Done, file};

/// Makes an airframe file of a flight stack's parameters
///
/// FILE is a parameter file of PX4 1.13 or later (CA_ROTOR*, as QGroundControl saves it) or of
/// ArduPilot (FRAME_CLASS, FRAME_TYPE, MOT_*).
///
/// PX4:       two rotors in one place are a unit, the one with the smaller z is the upper;
///            KM > 0 turns counter-clockwise; tilted axes are kept.
/// ArduPilot: the table of the frame gives angles, spins and layers; --arm gives their
///            distance, which the file lacks.
///
/// What the parameters do not say is named on stderr and in the file.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct ImportArgs {
    /// The parameter file
    file: PathBuf,
    /// The pair's model: what `cargo mixer identify` writes, or another airframe file
    #[arg(long, value_name = "FILE")]
    pair: Option<PathBuf>,
    /// Distance of the units from the centre, m: ArduPilot's files do not have it
    #[arg(long, value_name = "METRES")]
    arm: Option<f64>,
    /// The outputs, from 0, of the upper rotors: where the file does not say which they are, or
    /// says it wrongly
    #[arg(long, value_name = "CHANNELS", value_delimiter = ',')]
    upper: Vec<usize>,
    /// Name of the airframe
    #[arg(long)]
    name: Option<String>,
    /// The airframe file to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Overwrites it
    #[arg(long)]
    force: bool,
}

/// Runs the command.
pub fn run(args: &ImportArgs) -> Done {
    file::writable(&args.output, args.force, args.pair.iter().chain([&args.file]))?;
    import(args).map_err(crate::print_error)
}

fn import(args: &ImportArgs) -> Result<(), String> {
    let parameters = file::source(&args.file)?;
    let pair = args.pair.as_deref().map(file::source).transpose()?;
    let options = Options {
        arm_m: args.arm,
        upper: &args.upper,
        name: args.name.as_deref(),
    };
    let made = import::import(&parameters, pair.as_ref(), &options)?;
    file::save(&args.output, &made.text)?;
    crate::print_notes(&made.notes);
    Ok(())
}
