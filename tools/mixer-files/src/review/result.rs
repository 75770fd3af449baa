//! What a flight says of the model.

use serde::Serialize;

use crate::review::rotors::{Lag, Speed, Stopped};
use crate::review::saturated::Saturated;
use crate::review::thrust::Thrust;
use crate::stacks::stack::Stack;

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
    /// Electrical power; `None` where the log has no current, or the airframe no `[pair.power]`.
    pub power: Option<Power>,
    /// Which axes were cut, and how often.
    pub saturated: Saturated,
    /// Speeds of the rotors against their fellows'; empty where they were not logged.
    pub speeds: Vec<Speed>,
    /// How fast rotors follow; `None` where the log does not tell.
    pub lag: Option<Lag>,
    /// Rotors that stopped in the air.
    pub stopped: Vec<Stopped>,
    /// What deserves a look, a sentence each.
    pub warnings: Vec<String>,
    /// Throttles `[upper, lower]` of units in the air, some hundreds of them, each after where its pair stands among the
    /// airframe's.
    #[serde(skip)]
    pub flown: Vec<(usize, [f64; 2])>,
}

/// Hover by the log, all rotors turning; `None` where it does not hover.
#[derive(Clone, Debug, Serialize)]
pub struct Hover {
    /// Median of the upper rotors' mean throttle.
    pub upper: Option<f64>,
    /// Likewise of the lower rotors.
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
    /// Intervals of both that hold in 19 of 20 flights, m.
    pub centre_interval_m: Option<[[f64; 2]; 2]>,
}

/// Electrical power in hover.
#[derive(Clone, Debug, Serialize)]
pub struct Power {
    /// The model's over the measured one.
    pub scale: f64,
    /// The battery's current times its voltage, W.
    pub measured_w: f64,
    /// How long the charge that is left at the end of the log lasts in this hover, s; `None` where the battery's capacity
    /// is not among the parameters.
    pub hover_left_s: Option<f64>,
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

/// Widest interval of a scale that is written without being forced, as a share.
const WIDEST: f64 = 0.05;

impl Review {
    /// Why the scale does not belong into an airframe file, and what to do; `None` where it does.
    pub fn undecided(&self) -> Option<String> {
        let thrust = &self.thrust;
        let [low, high] = thrust.interval;
        if thrust.scale.is_none() {
            return Some(format!(
                "the parts of the log have scales from {low:.3} to {high:.3}, not one: review a log of a steady flight of known mass (--mass)"
            ));
        }
        if high - low > WIDEST * thrust.median {
            return Some(format!(
                "the interval {low:.3} to {high:.3} is wider than 5 %: hover longer, in less wind, with voltage and velocity logged"
            ));
        }
        (low <= 1.0 && 1.0 <= high).then(|| {
            format!(
                "the interval {low:.3} to {high:.3} holds 1: the log does not contradict the file's thrust"
            )
        })
    }
}
