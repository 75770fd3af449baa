//! Parameters of flight stacks for an airframe: what `check --verbose` and `params` print.

pub mod ardupilot;
pub(crate) mod frames;
pub mod px4;

use std::fmt;

use clap::ValueEnum;
use mixer_compiler::Compiled;
use mixer_compiler::airframe::GRAVITY;
use mixer_rt::Wrench;
use serde::Serialize;

/// A flight stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Stack {
    /// PX4 Autopilot.
    Px4,
    /// ArduPilot's Copter.
    Ardupilot,
}

impl Stack {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stack::Px4 => "PX4",
            Stack::Ardupilot => "ArduPilot",
        }
    }
}

/// A parameter of a flight stack.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: Value,
    /// Why it has this value; parameters of one reason follow each other.
    pub why: String,
}

/// A parameter's value, in the type that the stack holds it in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A whole number.
    Whole(i32),
    /// A number in single precision.
    Real(f64),
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Whole(value) => write!(f, "{value}"),
            Value::Real(value) => write!(f, "{value}"),
        }
    }
}

fn whole(name: impl Into<String>, value: i32, why: &str) -> Parameter {
    Parameter {
        name: name.into(),
        value: Value::Whole(value),
        why: why.to_owned(),
    }
}

/// With four significant digits and at least four decimals: more is not known of any of them.
fn real(name: impl Into<String>, value: f64, why: &str) -> Parameter {
    let digits = 3.0 - libm::floor(libm::log10(value.abs().max(1e-12)));
    let unit = libm::pow(10.0, digits.max(4.0));
    Parameter {
        name: name.into(),
        value: Value::Real((value * unit).round() / unit + 0.0),
        why: why.to_owned(),
    }
}

/// Parameters, and what of them cannot be known or deserves a look.
#[derive(Clone, Debug, Default)]
pub struct Parameters {
    /// In the order in which they are written.
    pub list: Vec<Parameter>,
    /// A sentence each.
    pub notes: Vec<String>,
}

/// The vehicle's weight, N; `None` without a mass.
fn weight_n(compiled: &Compiled) -> Option<f64> {
    let vehicle = compiled.airframe.vehicle.as_ref()?;
    Some(GRAVITY * vehicle.mass_kg)
}

/// Slope in hover of the share of the largest thrust over the throttle, both rotors alike: what a
/// stack's loop gain is multiplied by that takes the one for the other. `None` without a hover.
fn slope_in_hover(compiled: &Compiled) -> Option<f64> {
    let h = compiled.equal_hover_throttle()?;
    let [[f_u, f_l], _] = compiled.pair.jacobian([h, h]);
    Some((f_u + f_l) / largest_thrust(compiled))
}

/// Of one unit at the reference voltage, N.
fn largest_thrust(compiled: &Compiled) -> f64 {
    let [_, max] = compiled.pair.range();
    compiled.pair.efforts([max, max])[0]
}

/// Points at which a curve is fitted.
const POINTS: u32 = 50;

/// The a in [0, 1] with which a t^2 + (1 - a) t is nearest to the share of the largest thrust that
/// both rotors give at the throttle t, least squares over the airframe's range; both stacks
/// describe a rotor by this curve. `stretched` counts t from 0 at the least throttle to 1 at the
/// largest.
fn curve(compiled: &Compiled, stretched: bool) -> f64 {
    let [min, max] = compiled.pair.range();
    let full = largest_thrust(compiled);
    let (mut products, mut squares) = (0.0, 0.0);
    for k in 0..=POINTS {
        let share = f64::from(k) / f64::from(POINTS);
        let throttle = min + (max - min) * share;
        let t = if stretched { share } else { throttle };
        let bend = t * t - t;
        products += bend * (compiled.pair.efforts([throttle, throttle])[0] / full - t);
        squares += bend * bend;
    }
    (products / squares).clamp(0.0, 1.0)
}

/// Value of such a curve.
fn on_curve(a: f64, t: f64) -> f64 {
    a * t * t + (1.0 - a) * t
}

/// Scales and parameters that keep a stack from correcting a second time for the rotors' curve and
/// for the battery's voltage; the `Display` is what `check --verbose` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Stacks {
    /// What one unit of PX4's normalised setpoints asks for: `SCALE` of the generated module.
    pub normalised: Normalised,
    /// What one unit of ArduPilot's inputs asks for: `ARDUPILOT_SCALE` of the generated module.
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
        Stacks {
            normalised: Normalised::new(compiled.scale(), compiled.airframe.reference_v()),
            normalised_ardupilot: Normalised::new(compiled.ardupilot_scale(), compiled.highest_v()),
            px4: px4::settings(compiled).list,
            ardupilot: ardupilot::settings(compiled).list,
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
        stack(
            "ArduPilot",
            &self.normalised_ardupilot,
            &self.ardupilot,
            "MOT_THST_HOVER",
        )
    }
}
