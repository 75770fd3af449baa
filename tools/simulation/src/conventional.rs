//! The conventional mixer of the paper's section V, every rotor taken as isolated:
//! `isolated_rotors` on the airframe's tables, in f32 as in a flight controller.

use isolated_rotors::IsolatedTables;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::model::effectiveness::Effectiveness;
use mixer_compiler::model::law::CorrectionTables;
use mixer_rt::{SetpointError, Wrench};
use nalgebra::{SVector, Vector4};

use crate::vehicle::ROTORS;

/// The mixer: constants only.
#[derive(Clone, Debug)]
pub struct ConventionalMixer {
    tables: IsolatedTables,
}

impl ConventionalMixer {
    /// The conventional mixer of `airframe` with effectiveness M.
    ///
    /// # Errors
    /// An airframe of other than eight rotors.
    pub fn new(airframe: &Airframe, effectiveness: &Effectiveness) -> Result<Self, &'static str> {
        if airframe.rotors() != ROTORS {
            return Err("the airframe has not eight rotors");
        }
        let voltage = CorrectionTables::new(airframe).voltage;
        Ok(ConventionalMixer {
            tables: IsolatedTables::of(airframe, effectiveness, voltage),
        })
    }

    /// Throttles for the wrench `[roll, pitch, yaw (N m), thrust (N)]` at `voltage_v`, limited to
    /// the range, and whether any was limited.
    ///
    /// # Errors
    /// A wrench or voltage that is not finite.
    pub fn mix(
        &self,
        wrench: &Vector4<f64>,
        voltage_v: f64,
    ) -> Result<(SVector<f64, ROTORS>, bool), SetpointError> {
        let setpoint = Wrench::from_array(wrench.map(|x| x as f32).into());
        let (throttle, within) = self.tables.conventional(&setpoint, voltage_v as f32)?;
        let throttle = SVector::from_fn(|channel, _| f64::from(throttle[channel]));
        Ok((throttle, !within))
    }
}
