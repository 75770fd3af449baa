//! One flight: plant, controller and mixer in a closed loop over the manoeuvre.

use std::collections::VecDeque;
use std::error::Error;
use std::fmt;

use mixer_compiler::airframe::Airframe;
use nalgebra::{SVector, Vector3, Vector4};

use crate::air::{Air, Room};
use crate::battery;
use crate::controller::{Controller, Measurement, PERIOD_S, Tilt};
use crate::manoeuvre::{END_S, Reference, SETTLING_S, reference};
use crate::mixer::{Method, Mixer};
use crate::plant::Plant;
use crate::state::State;
use crate::vehicle::{BODY, ROTORS};

/// Step of the plant, s.
const STEP_S: f64 = 0.001;

/// Steps of the plant in one period of the controller.
const STEPS: usize = 5;

/// Age of the position measurement in periods of the controller: 50 ms (section V-B).
const DELAY: usize = 10;

/// Throttle of all rotors at the start; the settling makes hover of it.
const START_THROTTLE: f64 = 0.5;

/// One period of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of the manoeuvre, s.
    pub time_s: f64,
    /// What was to be followed.
    pub reference: Reference,
    /// True position, m.
    pub position: Vector3<f64>,
    /// True yaw, rad.
    pub yaw: f64,
    /// The controller's command `[roll, pitch, yaw (N m), thrust (N)]`.
    pub command: Vector4<f64>,
    /// The mixer's throttle per channel.
    pub throttle: SVector<f64, ROTORS>,
    /// Battery voltage, V.
    pub voltage_v: f64,
    /// Whether the mixer could not deliver.
    pub saturated: bool,
}

/// A flown manoeuvre.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Every period from 0 to the end of the manoeuvre; the settling before is left out.
    pub samples: Vec<Sample>,
}

/// Flies the manoeuvre with `mixer` in `room`, the controller's tilt by `tilt`.
///
/// # Errors
/// A command that is not finite: the loop has diverged.
pub fn fly(airframe: &Airframe, mixer: &Mixer, tilt: Tilt, mut room: Room) -> Result<Flight, String> {
    let plant = Plant::new(airframe, BODY, battery::PAPER, room.mismatch());
    let start = reference(-SETTLING_S);
    let mut state = State::level(start.position, START_THROTTLE);
    let mut controller = Controller::new(tilt);
    let mut positions = VecDeque::from(vec![state.position; DELAY]);
    let settling = (SETTLING_S / PERIOD_S).round() as i32;
    let end = (END_S / PERIOD_S).round() as i32;
    let mut samples = Vec::new();
    for period in -settling..end {
        let time_s = f64::from(period) * PERIOD_S;
        let reference = reference(time_s);
        positions.push_back(state.position);
        let measured = Measurement {
            position: positions.pop_front().unwrap_or(state.position),
            attitude: state.rotation(),
            rate: state.rate,
        };
        let command = controller.update(&measured, &reference);
        let voltage_v = plant.voltage_v(&state);
        let (throttle, saturated) = mixer
            .mix(&command, voltage_v)
            .map_err(|reason| format!("lost at {time_s:.2} s: {reason}"))?;
        if period >= 0 {
            samples.push(Sample {
                time_s,
                reference,
                position: state.position,
                yaw: state.yaw(),
                command,
                throttle,
                voltage_v,
                saturated,
            });
        }
        let disturbance = room.next(PERIOD_S);
        for _ in 0..STEPS {
            state = plant.step(&state, &throttle, &disturbance, STEP_S);
        }
    }
    Ok(Flight { samples })
}

/// What is held equal for a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scenario {
    /// The air.
    pub air: Air,
    /// The controller's way to tilt.
    pub tilt: Tilt,
}

impl Scenario {
    /// What the program flies.
    pub const ALL: [Scenario; 3] = [
        Scenario::new(Air::Still, Tilt::Decoupled),
        Scenario::new(Air::Unsteady, Tilt::Decoupled),
        Scenario::new(Air::Unsteady, Tilt::Coupled),
    ];

    const fn new(air: Air, tilt: Tilt) -> Self {
        Scenario { air, tilt }
    }

    /// The name in file names.
    pub fn slug(&self) -> String {
        self.to_string().replace(", ", "-").replace(' ', "-")
    }

    /// Flies `seed` with both mixers.
    ///
    /// # Errors
    /// No conventional mixer, or a flight that was lost.
    pub fn fly(&self, airframe: &Airframe, seed: u64) -> Result<FlightPair, Box<dyn Error>> {
        let flight = |method| -> Result<Flight, Box<dyn Error>> {
            let mixer = Mixer::new(method, airframe)?;
            Ok(fly(airframe, &mixer, self.tilt, Room::new(self.air, seed))?)
        };
        Ok(FlightPair {
            seed,
            coaxial: flight(Method::Coaxial)?,
            conventional: flight(Method::Conventional)?,
        })
    }
}

impl fmt::Display for Scenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let air = match self.air {
            Air::Still => "still air",
            Air::Unsteady => "unsteady air",
        };
        let tilt = match self.tilt {
            Tilt::Decoupled => "decoupled tilt",
            Tilt::Coupled => "coupled tilt",
        };
        write!(f, "{air}, {tilt}")
    }
}

/// The flights of one seed with either mixer: the same mismatch, the same air.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightPair {
    /// The seed of mismatch and air.
    pub seed: u64,
    /// With the airframe's mixer.
    pub coaxial: Flight,
    /// With the conventional one.
    pub conventional: Flight,
}

impl FlightPair {
    /// The flight with the mixer of that name.
    pub fn with(&self, method: Method) -> &Flight {
        match method {
            Method::Coaxial => &self.coaxial,
            Method::Conventional => &self.conventional,
        }
    }
}
