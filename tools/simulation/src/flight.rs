//! One flight: plant, controller and mixer in a closed loop over the manoeuvre.

use std::collections::VecDeque;
use std::error::Error;
use std::fmt;

use mixer_compiler::airframe::Airframe;
use mixer_rt::SetpointError;
use nalgebra::{SVector, Vector3, Vector4};

use crate::air::{Air, Room};
use crate::battery;
use crate::controller::{Controller, Measurement, PERIOD_S, Tilt};
use crate::manoeuvre::{END_S, Reference, SETTLING_S, reference};
use crate::mixer::{Method, Mixed, Mixer};
use crate::plant::Plant;
use crate::state::State;
use crate::vehicle::{BODY, ROTORS};

/// Step of the plant, s.
const STEP_S: f64 = 0.001;

/// Steps of the plant in one period of the controller.
const STEPS: usize = 5;

/// Age of the position measurement in periods of the controller: 50 ms (section V-B).
const DELAY: usize = 10;

/// Speed of all rotors at the start; the settling makes hover of it.
const START_SPEED: f64 = 0.5;

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

/// Plant, controller and room in a closed loop.
#[derive(Clone, Debug)]
pub struct ClosedLoop {
    plant: Plant<ROTORS>,
    controller: Controller,
    room: Room,
    /// The last positions, the oldest first: those that the controller knows.
    positions: VecDeque<Vector3<f64>>,
    /// The true state.
    pub state: State<ROTORS>,
}

impl ClosedLoop {
    /// At the manoeuvre's start, the controller's tilt by `tilt`.
    pub fn new(airframe: &Airframe, tilt: Tilt, room: Room) -> Self {
        let state = State::level(reference(-SETTLING_S).position, START_SPEED);
        ClosedLoop {
            plant: Plant::new(airframe, BODY, battery::PAPER, room.mismatch),
            controller: Controller::new(tilt),
            room,
            positions: VecDeque::from(vec![state.position; DELAY]),
            state,
        }
    }

    /// Flies a period by its number; `mix` has the throttles for a command and a voltage, and whether they
    /// are short of it. The state at its beginning.
    ///
    /// # Errors
    /// A command that is not finite: the loop has diverged.
    pub fn period(
        &mut self,
        number: i32,
        reference: &Reference,
        mix: impl FnOnce(&Vector4<f64>, f64) -> Result<Mixed, SetpointError>,
    ) -> Result<Sample, String> {
        let (state, time_s) = (self.state, f64::from(number) * PERIOD_S);
        self.positions.push_back(state.position);
        let measured = Measurement {
            position: self.positions.pop_front().unwrap_or(state.position),
            attitude: state.rotation(),
            rate: state.rate,
        };
        let command = self.controller.update(&measured, reference);
        let voltage_v = self.plant.voltage_v(&state);
        let (throttle, saturated) =
            mix(&command, voltage_v).map_err(|reason| format!("lost at {time_s:.2} s: {reason}"))?;
        let disturbance = self.room.next(PERIOD_S);
        for _ in 0..STEPS {
            self.state = self.plant.step(&self.state, &throttle, &disturbance, STEP_S);
        }
        Ok(Sample {
            time_s,
            reference: *reference,
            position: state.position,
            yaw: state.yaw(),
            command,
            throttle,
            voltage_v,
            saturated,
        })
    }
}

/// Periods of the controller in a time, s.
pub fn periods(time_s: f64) -> i32 {
    (time_s / PERIOD_S).round() as i32
}

/// Flies the manoeuvre with `mixer` in `room`, the controller's tilt by `tilt`.
///
/// # Errors
/// A command that is not finite: the loop has diverged.
pub fn fly(airframe: &Airframe, mixer: &Mixer, tilt: Tilt, room: Room) -> Result<Flight, String> {
    let mut flown = ClosedLoop::new(airframe, tilt, room);
    let mut samples = Vec::new();
    for number in -periods(SETTLING_S)..periods(END_S) {
        let reference = reference(f64::from(number) * PERIOD_S);
        let sample = flown.period(number, &reference, |wrench, volts| mixer.mix(wrench, volts))?;
        if number >= 0 {
            samples.push(sample);
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
