//! `cargo mixer import`: an airframe file from a flight stack's parameters.
//!
//! ```text
//! PX4's CA_ROTOR*, ArduPilot's FRAME_*, PX4's geometry files           parameters.rs
//!   -> rotors: channel, place, axis, spin                              px4.rs, ardupilot.rs, geometry.rs
//!   -> units: two rotors in one place, which is on top                 pairs.rs
//!   -> the airframe file, with what the parameters do not say named    text.rs
//! ```

mod ardupilot;
mod geometry;
mod pairs;
mod parameters;
mod px4;
mod rotors;
mod text;

use std::path::PathBuf;
use std::process::ExitCode;

use parameters::Parameters;
use rotors::Imported;

/// Makes an airframe file of a flight stack's parameters
///
/// FILE is a parameter file of PX4 1.13 or later (CA_ROTOR*, as QGroundControl saves it) or of
/// ArduPilot (FRAME_CLASS, FRAME_TYPE, MOT_*), or PX4's geometry files (tables `rotors`; those of
/// two layers together, the upper one first).
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
    /// The parameter file, or geometry files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
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
pub fn run(args: &ImportArgs) -> ExitCode {
    let inputs = args.files.iter().chain(&args.pair).map(PathBuf::as_path);
    if let Err(status) = crate::file::writable(&args.output, args.force, inputs) {
        return status;
    }
    match import(args) {
        Ok(notes) => {
            for note in notes {
                crate::print_note(format_args!("note: {note}"));
            }
            ExitCode::SUCCESS
        }
        Err(message) => crate::print_error(message),
    }
}

/// Writes the airframe file; what its user has to know of it.
fn import(args: &ImportArgs) -> Result<Vec<String>, String> {
    let mut imported = read(args)?;
    let units = pairs::pair(&imported.rotors, &args.upper)?;
    let pair = args.pair.as_deref().map(crate::bench_files::pair).transpose()?;
    let text = text::airframe(
        args.name.as_deref(),
        &args.files,
        &mut imported,
        &units,
        pair.as_ref(),
    );
    crate::file::save(&args.output, &text)?;
    Ok(imported.notes)
}

fn read(args: &ImportArgs) -> Result<Imported, String> {
    let mut texts = Vec::new();
    for path in &args.files {
        texts.push((path.display().to_string(), crate::file::read_text(path)?));
    }
    if texts.iter().any(|(_, text)| geometry::is_geometry(text)) {
        return geometry::read(&texts);
    }
    let [(name, text)] = &texts[..] else {
        return Err(
            "one parameter file makes one airframe; only PX4's geometry files come by layer".to_owned(),
        );
    };
    let parameters = Parameters::read(name, text)?;
    if parameters.has("CA_ROTOR_COUNT") || parameters.has("CA_ROTOR0_PX") {
        px4::read(&parameters)
    } else if parameters.has("FRAME_CLASS") {
        ardupilot::read(&parameters, args.arm)
    } else {
        Err(format!(
            "{name}: no rotors: neither CA_ROTOR_COUNT and CA_ROTOR0_PX.. (PX4 1.13 or later) nor FRAME_CLASS (ArduPilot) \
             among its {} parameters",
            parameters.count()
        ))
    }
}
