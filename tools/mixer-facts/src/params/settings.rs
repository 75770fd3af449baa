//! What a flight stack's normalised setpoints are on an airframe, and the parameters that must fit
//! it: what `check` prints and its JSON has.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::GRAVITY;
use mixer_rt::Wrench;
use serde::Serialize;

use crate::params::ardupilot;
use crate::params::parameter::Parameters;
pub use crate::params::parameter::{Parameter, Value};
use crate::params::px4::{self, Currents};

/// Scales and parameters that keep a stack from correcting a second time for the rotors' curve and
/// for the battery's voltage; the `Display` is what `check --verbose` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Stacks {
    /// Wrench of one unit of PX4's normalised setpoints: `SCALE` of the generated module.
    pub normalised: Normalised,
    /// Wrench of one unit of ArduPilot's inputs: `ARDUPILOT_SCALE` of the generated module.
    pub normalised_ardupilot: Normalised,
    /// PX4's parameters.
    pub px4: Vec<Parameter>,
    /// ArduPilot's parameters.
    pub ardupilot: Vec<Parameter>,
}

/// One unit of a normalised setpoint.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Normalised {
    /// N m.
    pub roll_nm: f32,
    /// N m.
    pub pitch_nm: f32,
    /// N m.
    pub yaw_nm: f32,
    /// All rotors at full throttle, N.
    pub thrust_n: f32,
    /// Hover throttle per kilogram of the vehicle: PX4's `MPC_THR_HOVER`, ArduPilot's
    /// `MOT_THST_HOVER`.
    pub hover_per_kg: f64,
    /// At which voltage, V; 0 where the airframe has no correction.
    pub voltage_v: f64,
}

impl Normalised {
    fn new(scale: Wrench, voltage_v: f64) -> Self {
        Normalised {
            roll_nm: scale.roll_nm,
            pitch_nm: scale.pitch_nm,
            yaw_nm: scale.yaw_nm,
            thrust_n: scale.thrust_n,
            hover_per_kg: GRAVITY / f64::from(scale.thrust_n),
            voltage_v,
        }
    }
}

impl Stacks {
    /// What follows from an airframe.
    pub fn new(compiled: &Compiled) -> Self {
        let (mut px4, mut ardupilot) = (Parameters::default(), Parameters::default());
        px4::settings(compiled, Currents::Measured, &mut px4);
        ardupilot::settings(compiled, &mut ardupilot);
        Stacks {
            normalised: Normalised::new(compiled.scale(), compiled.airframe.reference_v()),
            normalised_ardupilot: Normalised::new(compiled.ardupilot_scale(), compiled.highest_v()),
            px4: px4.list,
            ardupilot: ardupilot.list,
        }
    }
}

impl fmt::Display for Stacks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut stack = |name: &str, unit: &Normalised, list: &[Parameter], hover: &str| {
            let volts = match unit.voltage_v {
                0.0 => String::new(),
                volts => format!(" at {volts:?} V"),
            };
            writeln!(
                f,
                "{name:<15} one unit is {:.4} N m roll, {:.4} N m pitch, {:.4} N m yaw, {:.3} N thrust{volts}",
                unit.roll_nm, unit.pitch_nm, unit.yaw_nm, unit.thrust_n
            )?;
            let mut words: Vec<String> = list
                .iter()
                .map(|parameter| format!("{} {}", parameter.name, parameter.value))
                .collect();
            // A file without a mass leaves the last multiplication to the reader.
            if !list.iter().any(|parameter| parameter.name == hover) {
                words.push(format!("{hover} {:.4} per kg of the vehicle", unit.hover_per_kg));
            }
            writeln!(f, "                {}", words.join(", "))
        };
        stack("PX4", &self.normalised, &self.px4, "MPC_THR_HOVER")?;
        let ardupilot = &self.normalised_ardupilot;
        stack("ArduPilot", ardupilot, &self.ardupilot, "MOT_THST_HOVER")
    }
}
