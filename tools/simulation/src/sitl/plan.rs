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
    /// Roll, degrees.
    pub roll_deg: f64,
    /// What is held.
    pub hold: Hold,
}

/// What is asked for beside the heading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// The place.
    #[default]
    Place,
    /// The attitude, at the thrust of hover.
    Attitude,
    /// The attitude, at full thrust.
    FullThrust,
}

/// Targets from a time of the manoeuvre on, and its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// (s, target), in the order of time.
    pub steps: Vec<(f64, Target)>,
    /// s
    pub end_s: f64,
}

/// Time of the first step, s: before it the vehicle comes to rest, and the hover is measured.
pub const FIRST_S: f64 = 20.0;

/// End of a manoeuvre without steps, s.
const HOVER_S: f64 = 30.0;

/// Time from one step to the next, s, by what is held: without a place the vehicle gathers speed.
const BETWEEN_S: f64 = 8.0;
const ATTITUDE_S: f64 = 1.0;
const CLIMB_S: f64 = 4.0;

impl Manoeuvre {
    /// When what is asked for.
    pub fn plan(self) -> Plan {
        let to = |north, east, up, yaw_deg| Target {
            offset: Vector3::new(north, east, up),
            yaw_deg,
            ..Target::default()
        };
        let home = Target::default();
        let yaw = |yaw_deg| to(0.0, 0.0, 0.0, yaw_deg);
        let holding = |hold, target| Target { hold, ..target };
        // A controller of the place asks for a tilt of its own until its last setpoint is replaced: a step in attitude begins at an
        // attitude.
        let level = holding(Hold::Attitude, home);
        let roll = |roll_deg| [level, Target { roll_deg, ..level }, home];
        let climb = |yaw_deg| holding(Hold::FullThrust, yaw(yaw_deg));
        let targets = match self {
            Manoeuvre::Hover => Vec::new(),
            Manoeuvre::Steps => vec![to(0.0, 0.0, 3.0, 0.0), home, to(4.0, 0.0, 0.0, 0.0), home],
            Manoeuvre::Yaw => [90.0, 0.0, -90.0, 0.0, 175.0, 0.0, -175.0, 0.0].map(yaw).to_vec(),
            Manoeuvre::Sidestep => vec![to(0.0, 6.0, 0.0, 90.0), home, to(0.0, 6.0, 0.0, 0.0), home],
            Manoeuvre::Roll => [15.0, -15.0, 15.0, -15.0].map(roll).concat(),
            Manoeuvre::Climb => vec![level, climb(0.0), climb(90.0), climb(0.0), climb(-90.0)],
            // The rotor stops at the first time.
            Manoeuvre::Failure => vec![home, yaw(90.0), home],
        };
        let mut end_s = FIRST_S;
        let steps = targets.into_iter().map(|target| {
            let begin_s = end_s;
            end_s += match target.hold {
                Hold::Place => BETWEEN_S,
                Hold::Attitude => ATTITUDE_S,
                Hold::FullThrust => CLIMB_S,
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
