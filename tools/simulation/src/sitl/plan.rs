//! The manoeuvres: which position and heading are asked for, and when.

use clap::ValueEnum;
use nalgebra::Vector3;

/// What is flown once the vehicle hovers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Manoeuvre {
    /// Hover for 30 s
    Hover,
    /// Steps of 3 m in height and of 4 m to the north, there and back
    Steps,
    /// Four steps of 90 and four of 175 degrees in heading
    Yaw,
    /// Four sidesteps of 6 m, the first two with a step of 90 degrees in heading
    Sidestep,
    /// Four steps of 15 degrees in roll, a second each, and back to the place
    Roll,
    /// A climb at full thrust, and in it three steps of 90 degrees in heading
    Climb,
    /// Output 0 stops, or that of --fail; then a step of 90 degrees in heading, there and back
    Failure,
}

/// What is asked for, in the axes of the vehicle's start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Target {
    /// North and east, and above the height of the hover, m.
    pub offset: Vector3<f64>,
    /// Heading, degrees.
    pub yaw_deg: f64,
    /// Roll, degrees; unless it is 0, the attitude is asked for and no place.
    pub roll_deg: f64,
    /// Level at full thrust: no place is asked for.
    pub is_climb: bool,
}

/// Targets from a time of the manoeuvre on, and its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// (s, target), in the order of time.
    pub steps: Vec<(f64, Target)>,
    /// s
    pub end_s: f64,
}

/// Time of the first step, s: before it the hover is measured.
pub const FIRST_S: f64 = 5.0;

/// End of a manoeuvre without steps, s.
const HOVER_S: f64 = 30.0;

/// Time from one step to the next, s, and from one in roll and in a climb: the vehicle gathers speed.
const BETWEEN_S: f64 = 8.0;
const ROLL_S: f64 = 1.0;
const CLIMB_S: f64 = 4.0;

impl Manoeuvre {
    /// When what is asked for.
    pub fn plan(self) -> Plan {
        const HOME: [f64; 5] = [0.0; 5];
        let yaw = |degrees| [0.0, 0.0, 0.0, degrees, 0.0];
        let roll = |degrees| [0.0, 0.0, 0.0, 0.0, degrees];
        let targets: &[[f64; 5]] = match self {
            Manoeuvre::Hover => &[],
            Manoeuvre::Steps => &[[0.0, 0.0, 3.0, 0.0, 0.0], HOME, [4.0, 0.0, 0.0, 0.0, 0.0], HOME],
            Manoeuvre::Yaw => &[90.0, 0.0, -90.0, 0.0, 175.0, 0.0, -175.0, 0.0].map(yaw),
            Manoeuvre::Sidestep => &[[0.0, 6.0, 0.0, 90.0, 0.0], HOME, [0.0, 6.0, 0.0, 0.0, 0.0], HOME],
            Manoeuvre::Roll => &[15.0, 0.0, -15.0, 0.0, 15.0, 0.0, -15.0, 0.0].map(roll),
            Manoeuvre::Climb => &[HOME, yaw(90.0), HOME, yaw(-90.0)],
            // The rotor stops at the first time.
            Manoeuvre::Failure => &[HOME, yaw(90.0), HOME],
        };
        let mut end_s = FIRST_S;
        let steps = targets.iter().map(|&[north, east, up, yaw_deg, roll_deg]| {
            let begin_s = end_s;
            let is_climb = self == Manoeuvre::Climb;
            end_s += match roll_deg == 0.0 {
                _ if is_climb => CLIMB_S,
                true => BETWEEN_S,
                false => ROLL_S,
            };
            let offset = Vector3::new(north, east, up);
            let target = Target {
                offset,
                yaw_deg,
                roll_deg,
                is_climb,
            };
            (begin_s, target)
        });
        let steps: Vec<_> = steps.collect();
        Plan {
            end_s: if steps.is_empty() { HOVER_S } else { end_s },
            steps,
        }
    }
}

impl Plan {
    /// The target at a time of the manoeuvre, s.
    pub fn target(&self, time_s: f64) -> Target {
        let begun = self.steps.iter().rev().find(|(start_s, _)| *start_s <= time_s);
        begun.map(|(_, target)| *target).unwrap_or_default()
    }
}
