//! `cargo mixer import`: an airframe file from a flight stack's parameters.

use std::path::PathBuf;

use mixer_compiler::Source;
use mixer_files::import::{self, Import, Options};

use crate::bench_args::pwm_range;
use crate::{Done, file};

/// Makes an airframe file of a flight stack's parameters
///
/// FILE is a parameter file or a start script of PX4 1.13 or later (CA_ROTOR*), a parameter file
/// of ArduPilot (FRAME_CLASS, FRAME_TYPE, MOT_*; of a QuadPlane Q_*), or the `diff all` of
/// Betaflight or INAV (mixer, mmix).
///
/// PX4:        two rotors in one place are a unit, the one with the smaller z is the upper;
///             KM > 0 turns counter-clockwise; tilted axes are kept.
/// ArduPilot:  the table of the frame gives angles, spins and layers; --arm gives their
///             distance, which the file lacks.
/// Betaflight: two motors with the same roll and pitch are a unit; --arm gives the distance.
///
/// What the parameters do not say is named on stderr and in the file.
#[derive(clap::Args, Debug)]
#[command(verbatim_doc_comment)]
pub struct ImportArgs {
    /// The parameter file
    pub file: PathBuf,
    /// The pair's model: what `cargo mixer identify` writes, or another airframe file
    #[arg(long, value_name = "FILE")]
    pub pair: Option<PathBuf>,
    /// Distance of the units from the centre, m: only PX4's files have it
    #[arg(long, value_name = "METRES")]
    arm: Option<f64>,
    /// The outputs, from 0, of the upper rotors: where the file does not say which they are, or
    /// says it wrongly
    #[arg(long, value_name = "CHANNELS", value_delimiter = ',')]
    upper: Vec<usize>,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds [default: those that
    /// identify needed, else 1000,2000]
    #[arg(long, value_name = "LOW,HIGH", value_parser = pwm_range)]
    pwm_range: Option<[f64; 2]>,
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

impl ImportArgs {
    /// The airframe of these parameters and this pair.
    ///
    /// # Errors
    /// A file that does not describe coaxial pairs, and an arm beside places.
    pub fn answer(&self, parameters: &Source, pair: Option<&Source>) -> Result<Import, String> {
        let options = Options {
            arm_m: self.arm,
            upper: &self.upper,
            pulses_us: self.pwm_range,
            name: self.name.as_deref(),
        };
        let made = import::import(parameters, pair, &options)?;
        match self.arm {
            Some(_) if made.has_places => Err(format!(
                "{}: --arm has nothing to work on: the file has the place of each rotor; leave it out",
                parameters.name
            )),
            _ => Ok(made),
        }
    }
}

fn import(args: &ImportArgs) -> Result<(), String> {
    let parameters = file::source(&args.file)?;
    let pair = args.pair.as_deref().map(file::source).transpose()?;
    let made = args.answer(&parameters, pair.as_ref())?;
    file::save(&args.output, &made.text)?;
    crate::print_notes("warning", &made.warnings);
    crate::print_notes("note", &made.notes);
    Ok(())
}
