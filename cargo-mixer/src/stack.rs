//! Numbers of an airframe that a flight stack takes: the scales of its normalised setpoints, and
//! the parameters that keep it from correcting a second time for the rotors' curve and for the
//! battery's voltage.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::GRAVITY;
use serde::Serialize;

/// Scales and parameters; its `Display` is what `check` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Stack {
    /// What one unit of a normalised setpoint asks for: `SCALE` of the generated module.
    pub normalised: Normalised,
    /// PX4's parameters.
    pub px4: Vec<Parameter>,
    /// ArduPilot's parameters.
    pub ardupilot: Vec<Parameter>,
}

/// One unit of a normalised setpoint at the reference voltage.
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
    /// Hover throttle (PX4's `MPC_THR_HOVER`, ArduPilot's `MOT_THST_HOVER`) per kilogram of the
    /// vehicle.
    pub hover_per_kg: f64,
}

/// A parameter of a flight stack.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
}

impl Stack {
    /// What follows from an airframe.
    pub fn new(compiled: &Compiled) -> Self {
        let scale = compiled.scale();
        let airframe = &compiled.airframe;
        let parameter = |name, value| Parameter { name, value };
        let mut px4 = vec![parameter("THR_MDL_FAC", 0.0)];
        let mut ardupilot = vec![
            parameter("MOT_THST_EXPO", 0.0),
            parameter("MOT_SPIN_MIN", airframe.throttle.min),
            parameter("MOT_SPIN_MAX", airframe.throttle.max),
        ];
        if airframe.voltage.is_some() {
            px4.push(parameter("MC_BAT_SCALE_EN", 0.0));
            ardupilot.push(parameter("MOT_BAT_VOLT_MAX", 0.0));
            ardupilot.push(parameter("MOT_BAT_VOLT_MIN", 0.0));
        }
        let hover_per_kg = GRAVITY / f64::from(scale.thrust_n);
        if let Some(vehicle) = &airframe.vehicle {
            // Four decimals, as ground stations show it.
            let hover = (1e4 * hover_per_kg * vehicle.mass_kg).round() / 1e4;
            px4.push(parameter("MPC_THR_HOVER", hover));
            ardupilot.push(parameter("MOT_THST_HOVER", hover));
        }
        Stack {
            normalised: Normalised {
                roll_nm: scale.roll_nm,
                pitch_nm: scale.pitch_nm,
                yaw_nm: scale.yaw_nm,
                thrust_n: scale.thrust_n,
                hover_per_kg,
            },
            px4,
            ardupilot,
        }
    }
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Normalised {
            roll_nm,
            pitch_nm,
            yaw_nm,
            thrust_n,
            hover_per_kg,
        } = self.normalised;
        writeln!(
            f,
            "normalised      one unit is {roll_nm:.4} N m roll, {pitch_nm:.4} N m pitch, {yaw_nm:.4} N m yaw, {thrust_n:.3} N thrust"
        )?;
        let list = |parameters: &[Parameter]| -> String {
            let words = parameters
                .iter()
                .map(|Parameter { name, value }| format!("{name} {value}"));
            words.collect::<Vec<_>>().join(", ")
        };
        // A file without a mass leaves the last multiplication to the reader.
        let hover = |name: &'static str, parameters: &[Parameter]| -> String {
            if parameters.iter().any(|parameter| parameter.name == name) {
                String::new()
            } else {
                format!(", {name} {hover_per_kg:.4} per kg of the vehicle")
            }
        };
        writeln!(
            f,
            "  PX4           {}{}",
            list(&self.px4),
            hover("MPC_THR_HOVER", &self.px4)
        )?;
        writeln!(
            f,
            "  ArduPilot     {}{}",
            list(&self.ardupilot),
            hover("MOT_THST_HOVER", &self.ardupilot)
        )
    }
}
