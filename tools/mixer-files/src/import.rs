//! An airframe file from a flight stack's parameters.
//!
//! ```text
//! PX4's CA_ROTOR*, ArduPilot's FRAME_*                                 parameters.rs
//!   -> rotors: channel, place, axis, spin                              ../stacks/*/import.rs
//!   -> what the outputs send, and to which motor                       outputs.rs
//!   -> units: two rotors in one place, which is on top; single ones    pairs.rs
//!   -> what is said of each rotor and not used                         unused.rs
//!   -> the airframe file, with what the parameters do not say named    text.rs
//! ```

pub(crate) mod outputs;
mod pairs;
pub(crate) mod parameters;
pub(crate) mod rotors;
mod text;
mod unused;

use mixer_compiler::airframe::Airframe;
use mixer_compiler::diagnostic::content::{self, Content};
use mixer_compiler::model;
use mixer_compiler::{Source, symmetry};
use mixer_facts::checklist;
use mixer_identify::bench::header::{ByHand, known};
use mixer_identify::pair_file::PairFile;

use crate::params::bench_pulses;
use crate::stacks::ardupilot::frames::COAXIAL_MIXER;
use crate::stacks::{ardupilot, betaflight, px4};
pub use outputs::USUAL_US;
use parameters::Parameters;
use rotors::Imported;
pub use rotors::{Rotor, Stated};

/// What the parameters do not say.
#[derive(Clone, Debug, Default)]
pub struct Options<'a> {
    /// Distance of the units from the centre, m: only PX4's files have it.
    pub arm_m: Option<f64>,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds; without them those that the
    /// pair's file remembers, else 1000 and 2000.
    pub pulses_us: Option<[f64; 2]>,
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
    /// What the vehicle may differ in from the file.
    pub warnings: Vec<String>,
    /// Assumptions, and settings that the parameters lack.
    pub notes: Vec<String>,
    /// Whether the parameters have the place of each rotor, so that no arm counts.
    pub has_places: bool,
}

/// Reads what [`import`] begins with.
///
/// # Errors
/// Parameters of no vehicle with coaxial pairs.
pub fn stated(file: &Source) -> Result<Stated, String> {
    let parameters = Parameters::read(file)?;
    let pins = outputs::servos(&parameters);
    let is_dshot = outputs::is_dshot(&parameters);
    if parameters.whole("FRAME_CLASS") == Some(COAXIAL_MIXER as usize) {
        let pulses = outputs::pulses(&parameters).unwrap_or_default();
        return Ok(Stated {
            rotors: None,
            pins,
            pulses_us: pulses.map(|pulses| pulses.us),
            is_dshot,
        });
    }
    let imported = read(file, Some(1.0))?;
    Ok(Stated {
        rotors: Some(imported.rotors),
        pins,
        pulses_us: imported.pulses.map(|pulses| pulses.us),
        is_dshot,
    })
}

/// Makes an airframe file of a parameter file of PX4 or ArduPilot, a start script of PX4's, or the
/// `diff all` of Betaflight or INAV. `pair` is a file with the pair's model.
///
/// # Errors
/// A file that does not describe coaxial pairs: file, line, and what would serve.
pub fn import(file: &Source, pair: Option<&Source>, options: &Options<'_>) -> Result<Import, String> {
    let mut imported = read(file, options.arm_m)?;
    let units = pairs::pair(&imported.rotors, options.upper)?;
    imported.warnings.extend(unused::notes(&imported.rotors, &units)?);
    let pair = pair
        .map(|pair| PairFile::read(&pair.name, &pair.text))
        .transpose()?;
    let frame = units
        .iter()
        .map(|unit| (unit.position_m, unit.upper_spin, unit.channels));
    let frame = checklist::in_words(&frame.collect::<Vec<_>>()).join("; ");
    imported.notes.push(format!("the frame is {frame}"));
    imported.notes.extend(pairs::alone(&units));
    if imported.has_places && options.upper.is_empty() {
        imported.warnings.extend(pairs::upside_down(&units));
    }
    let places: Vec<[f64; 3]> = units.iter().map(|unit| unit.position_m).collect();
    imported
        .warnings
        .extend(symmetry::broken(&places).map(|(_, told)| told));
    let tables = text::tables(&mut imported, &units, pair.as_ref());
    if let Some(pulses) = &imported.pulses {
        let airframe = Source::new("airframe.toml", format!("name = \"a\"\n{tables}"));
        let airframe = Airframe::read(&airframe).ok();
        let of_bench = options.pulses_us.or_else(|| bench_pulses(airframe.as_ref()?));
        let map = airframe.map(|airframe| model::mean(&airframe, &model::maps(&airframe)));
        let told = pulses.mismatch(of_bench.unwrap_or(USUAL_US), map.as_ref());
        imported.warnings.extend(told);
    }
    let name = options
        .name
        .map_or_else(|| text::default_name(&units), str::to_owned);
    Ok(Import {
        text: text::airframe(&name, file, &imported, &tables),
        has_places: imported.has_places,
        warnings: imported.warnings,
        notes: imported.notes,
    })
}

fn read(file: &Source, arm_m: Option<f64>) -> Result<Imported, String> {
    let columns = file
        .text
        .lines()
        .next()
        .unwrap_or_default()
        .split([',', ';', '\t']);
    let columns: Vec<String> = columns.map(str::to_owned).collect();
    let mut imported = match content::of(&file.text) {
        _ if known(&columns, &ByHand::default()) > 1 => {
            let table = Content::Table.description();
            return Err(format!("{}: this is {table}", file.name));
        }
        Content::Betaflight => betaflight::import::read(file, arm_m)?,
        other @ (Content::Airframe | Content::Pair | Content::Foreign(_)) => {
            return Err(format!("{}: this is {}", file.name, other.description()));
        }
        _ => of_parameters(file, arm_m)?,
    };
    let told = imported.without_gap()?;
    imported.notes.extend(told);
    Ok(imported)
}

fn of_parameters(file: &Source, arm_m: Option<f64>) -> Result<Imported, String> {
    let parameters = Parameters::read(file)?;
    let mut imported = if parameters.has("CA_ROTOR_COUNT") || parameters.has("CA_ROTOR0_PX") {
        px4::import::read(&parameters)?
    } else if parameters.has("FRAME_CLASS") || ardupilot::import::is_quadplane(&parameters) {
        ardupilot::import::read(&parameters, arm_m)?
    } else {
        return Err(format!(
            "{}: no rotors: neither CA_ROTOR_COUNT and CA_ROTOR0_PX.. (PX4 1.13 or later) nor FRAME_CLASS or Q_FRAME_CLASS \
             (ArduPilot) among its {} parameters",
            file.name,
            parameters.count()
        ));
    };
    imported.notes.extend(outputs::order(&parameters));
    imported.notes.extend(parameters.included.clone());
    let pulses = outputs::own_pulses(&parameters);
    for rotor in &mut imported.rotors {
        let own = pulses.iter().find(|(motor, _)| *motor == rotor.channel);
        rotor.own.pulses_us = own.map(|(_, us)| *us);
    }
    match outputs::pulses(&parameters) {
        Ok(pulses) => imported.pulses = pulses,
        Err(note) => imported.notes.push(note),
    }
    Ok(imported)
}

#[cfg(test)]
mod tests;
