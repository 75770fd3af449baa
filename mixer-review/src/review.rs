//! What a flight says of the model.

use serde::Serialize;

use crate::flight::Stack;
use crate::saturated::{Margin, Saturated};
use crate::thrust::Thrust;

/// What the log does not have.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Mass in this flight, kg; without it that of the airframe file.
    pub mass_kg: Option<f64>,
    /// Pulse widths of throttle 0 and 1 on the bench, microseconds; without them those that the airframe
    /// file remembers, else 1000 and 2000.
    pub bench_us: Option<[f64; 2]>,
}

/// A log over a model.
#[derive(Clone, Debug, Serialize)]
pub struct Review {
    /// Name of the airframe.
    pub airframe: String,
    /// The stack that wrote the log.
    pub stack: Stack,
    /// Times, s: of the log, in the air away from the ground, and in hover with all rotors.
    pub seconds: [f64; 3],
    /// Mass that the measured thrust is of, kg.
    pub mass_kg: f64,
    /// The model's thrust over the measured one.
    pub thrust: Thrust,
    /// Hover.
    pub hover: Hover,
    /// The battery's voltage, V; `None` where it was not logged, or the airframe ignores it.
    pub voltage: Option<Range>,
    /// The air's density, kg/m3; `None` where it was not logged.
    pub density: Option<Range>,
    /// Who was cut, and how often.
    pub saturated: Saturated,
    /// The least that was left to a rotor.
    pub margin: Margin,
    /// Rotors that stopped in the air.
    pub stopped: Vec<Stopped>,
    /// What deserves a look, a sentence each.
    pub warnings: Vec<String>,
    /// What no log, or not this one, tells.
    pub not_told: Vec<String>,
    /// Throttles `[upper, lower]` of all pairs in the air, some hundreds of them.
    #[serde(skip)]
    pub flown: Vec<[f64; 2]>,
}

/// Hover by the log, all rotors turning; `None` where it does not hover.
#[derive(Clone, Debug, Serialize)]
pub struct Hover {
    /// Mean throttle of the upper rotors.
    pub upper: Option<f64>,
    /// Mean throttle of the lower rotors.
    pub lower: Option<f64>,
    /// Both by the model, for the mass and the voltage of the log; `None` where it carries no such weight.
    pub model: Option<[f64; 2]>,
    /// Torque that the model leaves in a straight hover, where there is none, N m.
    pub roll_nm: Option<f64>,
    /// Likewise.
    pub pitch_nm: Option<f64>,
    /// Likewise.
    pub yaw_nm: Option<f64>,
    /// Where the centre of gravity is for that, forward and right of the file's, m.
    pub centre_m: Option<[f64; 2]>,
}

/// A measured quantity in the air.
#[derive(Clone, Debug, Serialize)]
pub struct Range {
    /// Least.
    pub least: f64,
    /// Largest.
    pub largest: f64,
    /// The range in the airframe file; `None` where it has none.
    pub range: Option<[f64; 2]>,
    /// Share of the time outside of it.
    pub outside: f64,
}

/// A rotor that stopped.
#[derive(Clone, Debug, Serialize)]
pub struct Stopped {
    /// Its output.
    pub output: usize,
    /// When, s of the log.
    pub time_s: f64,
}
