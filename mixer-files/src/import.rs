//! An airframe file from a flight stack's parameters.
//!
//! ```text
//! PX4's CA_ROTOR*, ArduPilot's FRAME_*                                 parameters.rs
//!   -> rotors: channel, place, axis, spin                              px4.rs, ardupilot.rs
//!   -> units: two rotors in one place, which is on top                 pairs.rs
//!   -> the airframe file, with what the parameters do not say named    text.rs
//! ```

mod ardupilot;
mod pairs;
mod parameters;
mod px4;
mod rotors;
mod text;

use mixer_compiler::Source;
use mixer_identify::pair_file::PairFile;

use parameters::Parameters;
use rotors::Imported;

/// What the parameters do not say.
#[derive(Clone, Debug, Default)]
pub struct Options<'a> {
    /// Distance of the units from the centre, m: ArduPilot's files do not have it.
    pub arm_m: Option<f64>,
    /// The outputs, from 0, of the upper rotors, where the file does not say which they are.
    pub upper: &'a [usize],
    /// Name of the airframe.
    pub name: Option<&'a str>,
}

/// An airframe file, and what its user has to know of it.
#[derive(Clone, Debug)]
pub struct Import {
    /// The file.
    pub text: String,
    /// Assumptions, and settings that the parameters lack.
    pub notes: Vec<String>,
}

/// Makes an airframe file of a parameter file of PX4 or ArduPilot. `pair` is a file with the pair's
/// model.
///
/// # Errors
/// A file that does not describe coaxial pairs: file, line, and what would serve.
pub fn import(file: &Source, pair: Option<&Source>, options: &Options<'_>) -> Result<Import, String> {
    let mut imported = read(file, options.arm_m)?;
    let units = pairs::pair(&imported.rotors, options.upper)?;
    let pair = pair
        .map(|pair| PairFile::read(&pair.name, &pair.text))
        .transpose()?;
    let text = text::airframe(options.name, file, &mut imported, &units, pair.as_ref());
    Ok(Import {
        text,
        notes: imported.notes,
    })
}

fn read(file: &Source, arm_m: Option<f64>) -> Result<Imported, String> {
    let parameters = Parameters::read(file)?;
    if parameters.has("CA_ROTOR_COUNT") || parameters.has("CA_ROTOR0_PX") {
        px4::read(&parameters)
    } else if parameters.has("FRAME_CLASS") {
        ardupilot::read(&parameters, arm_m)
    } else {
        Err(format!(
            "{}: no rotors: neither CA_ROTOR_COUNT and CA_ROTOR0_PX.. (PX4 1.13 or later) nor FRAME_CLASS (ArduPilot) \
             among its {} parameters",
            file.name,
            parameters.count()
        ))
    }
}
