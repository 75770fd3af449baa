//! The two mixers behind one face. The conventional one is that of the paper's section V, every rotor taken as isolated:
//! `isolated_rotors` on the airframe's tables, in f32 as in a flight controller.

use std::fmt;

use isolated_rotors::IsolatedTables;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_compiler::model::law::CorrectionTables;
use mixer_rt::{SetpointError, Wrench};
use nalgebra::{SVector, Vector4};

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

impl Method {
    /// In the paper's order.
    pub const BOTH: [Method; 2] = [Method::Coaxial, Method::Conventional];
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
    Conventional(Box<IsolatedTables>),
}

impl Mixer {
    /// The mixer of `airframe` by name.
    ///
    /// # Errors
    /// For the conventional one an airframe of other than eight rotors, or rotors that cannot produce all four axes.
    pub fn new(method: Method, airframe: &Airframe) -> Result<Self, &'static str> {
        if method == Method::Coaxial {
            return Ok(Mixer::Coaxial);
        }
        if airframe.rotors() != ROTORS {
            return Err("the airframe has not eight rotors");
        }
        let effectiveness =
            Effectiveness::new(airframe).map_err(|_| "the rotors cannot produce all four axes")?;
        let voltage = CorrectionTables::new(airframe).voltage;
        let tables = IsolatedTables::of(airframe, &effectiveness, voltage);
        Ok(Mixer::Conventional(Box::new(tables)))
    }

    /// Throttle per channel for `[roll, pitch, yaw (N m), thrust (N)]`, and whether anything was
    /// saturated.
    ///
    /// # Errors
    /// A wrench or voltage that is not finite.
    pub fn mix(&self, wrench: &Vector4<f64>, voltage_v: f64) -> Result<Mixed, SetpointError> {
        let (setpoint, volts) = (
            Wrench::from_array(wrench.map(|x| x as f32).into()),
            voltage_v as f32,
        );
        let (throttle, is_saturated) = match self {
            Mixer::Coaxial => {
                let mix = isae_x8::mix(&setpoint, volts)?;
                (mix.throttle, mix.saturation.any_axis())
            }
            Mixer::Conventional(tables) => {
                let (throttle, is_within) = tables.conventional(&setpoint, volts)?;
                (std::array::from_fn(|channel| throttle[channel]), !is_within)
            }
        };
        Ok((SVector::from(throttle).map(f64::from), is_saturated))
    }
}
