//! The two mixers behind one face.

use std::fmt;

use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_rt::{SetpointError, Wrench};
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
                let setpoint = Wrench::from_array(wrench.map(|x| x as f32).into());
                let mix = isae_x8::mix(&setpoint, voltage_v as f32)?;
                let throttle = SVector::from(mix.throttle).map(f64::from);
                Ok((throttle, mix.saturation.any_axis()))
            }
            Mixer::Conventional(mixer) => mixer.mix(wrench, voltage_v),
        }
    }
}
