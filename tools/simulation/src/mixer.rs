//! The two mixers behind one face.

use std::fmt;

use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_compiler::tables::MixerTables;
use mixer_rt::{Health, SetpointError, Wrench};
use nalgebra::{SVector, Vector4};

use crate::conventional::ConventionalMixer;
use crate::vehicle::{ROTORS, isae_x8};

/// Throttle per channel, and whether anything was saturated.
pub type Mixed = (SVector<f64, ROTORS>, bool);

/// Name of a mixer, as Table II has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The airframe's mixer from the macro.
    Coaxial,
    /// The conventional mixer, isolated rotors.
    Conventional,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Method::Coaxial => "coaxial",
            Method::Conventional => "conventional",
        })
    }
}

/// A mixer that is ready to run.
#[derive(Clone, Debug)]
pub enum Mixer {
    /// The airframe's mixer from the macro.
    Coaxial,
    /// The conventional mixer.
    Conventional(Box<ConventionalMixer>),
    /// The mixer of another airframe with as many rotors.
    Compiled(Box<MixerTables>),
}

impl Mixer {
    /// The mixer of `airframe` by name.
    ///
    /// # Errors
    /// A conventional mixer that does not exist: see [`ConventionalMixer::new`]; rotors that cannot
    /// produce all four axes.
    pub fn new(method: Method, airframe: &Airframe) -> Result<Self, &'static str> {
        Ok(match method {
            Method::Coaxial => Mixer::Coaxial,
            Method::Conventional => {
                let effectiveness =
                    Effectiveness::new(airframe).map_err(|_| "the rotors cannot produce all four axes")?;
                Mixer::Conventional(Box::new(ConventionalMixer::new(airframe, &effectiveness)?))
            }
        })
    }

    /// Throttle per channel for `[roll, pitch, yaw (N m), thrust (N)]`, and whether anything was
    /// saturated.
    ///
    /// # Errors
    /// A wrench or voltage that is not finite.
    pub fn mix(&self, wrench: &Vector4<f64>, voltage_v: f64) -> Result<Mixed, SetpointError> {
        match self {
            Mixer::Coaxial => {
                let mix = isae_x8::mix(&setpoint(wrench), voltage_v as f32)?;
                let throttle = SVector::from(mix.throttle).map(f64::from);
                Ok((throttle, mix.saturation.any_axis()))
            }
            Mixer::Conventional(mixer) => mixer.mix(wrench, voltage_v),
            Mixer::Compiled(tables) => mix(tables, wrench, voltage_v, Health::GOOD),
        }
    }
}

fn setpoint(wrench: &Vector4<f64>) -> Wrench {
    Wrench::from_array(wrench.map(|x| x as f32).into())
}

/// [`Mixer::mix`] by the tables of an airframe of at most eight rotors, with some out.
///
/// # Errors
/// A wrench or voltage that is not finite.
pub fn mix(
    tables: &MixerTables,
    wrench: &Vector4<f64>,
    voltage_v: f64,
    health: Health,
) -> Result<Mixed, SetpointError> {
    let (throttle, _, saturation) = tables.mix_with_health(&setpoint(wrench), voltage_v as f32, health)?;
    let rotors = throttle.into_iter().map(f64::from).chain([0.0; ROTORS]);
    Ok((SVector::from_iterator(rotors.take(ROTORS)), saturation.any_axis()))
}
