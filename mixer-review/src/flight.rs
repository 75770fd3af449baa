//! What a flight log says, in one form for both stacks.

use std::fmt;

use serde::Serialize;

use crate::log::Series;

/// The stack that wrote a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stack {
    /// PX4.
    Px4,
    /// ArduPilot.
    ArduPilot,
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stack::Px4 => "PX4",
            Stack::ArduPilot => "ArduPilot",
        })
    }
}

/// A flight: SI units, body axes and the earth's forward or north, right or east, down. Whatever the
/// log lacks is `None` or empty.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Who wrote it.
    pub stack: Stack,
    /// Throttle of each output; not finite where the output is off.
    pub throttle: Series,
    /// Specific force of the accelerometer, m/s2, three axes: about -9.81 down in hover.
    pub force: Series,
    /// The earth's downward direction in body axes, a unit vector.
    pub down: Option<Series>,
    /// Velocity, m/s: north, east, down.
    pub velocity: Option<Series>,
    /// Rates about the body axes, rad/s.
    pub rates: Option<Series>,
    /// 1 where the vehicle stands on the ground, else 0.
    pub landed: Option<Series>,
    /// Of the battery, V.
    pub voltage: Option<Series>,
    /// Of the air, kg/m3.
    pub density: Option<Series>,
    /// Normalised setpoints of roll, pitch, yaw and thrust (upward), in the stack's units.
    pub setpoint: Option<Series>,
    /// What the stack's allocator says that it left out, in the same units.
    pub unallocated: Option<Series>,
    /// Mask of the rotors that the stack has found dead.
    pub failed: Option<Series>,
    /// What is missing of a log that is damaged or cut off.
    pub damage: Option<String>,
}

impl Flight {
    /// A flight of which only the outputs and the accelerometer are known.
    pub fn new(stack: Stack, throttle: Series, force: Series) -> Flight {
        Flight {
            stack,
            throttle,
            force,
            down: None,
            velocity: None,
            rates: None,
            landed: None,
            voltage: None,
            density: None,
            setpoint: None,
            unallocated: None,
            failed: None,
            damage: None,
        }
    }
}
