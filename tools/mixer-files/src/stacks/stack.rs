//! Which flight stack.

use serde::Serialize;

/// A flight stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stack {
    /// PX4 Autopilot.
    #[default]
    Px4,
    /// ArduPilot's Copter.
    Ardupilot,
    /// Betaflight.
    Betaflight,
}

impl Stack {
    /// All, each with its word on the command line and what it is.
    pub const ALL: [(Stack, &'static str, &'static str); 3] = [
        (Stack::Px4, "px4", "PX4 Autopilot"),
        (Stack::Ardupilot, "ardupilot", "ArduPilot's Copter"),
        (Stack::Betaflight, "betaflight", "Betaflight"),
    ];

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Stack::Px4 => "PX4",
            Stack::Ardupilot => "ArduPilot",
            Stack::Betaflight => "Betaflight",
        }
    }
}
