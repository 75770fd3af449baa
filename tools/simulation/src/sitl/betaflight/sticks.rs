//! A pilot who has sticks: for Betaflight in acro mode. Sees the truth, turns by rates, and leaves the throttle alone from a step
//! in heading on, so that what the thrust does then is the mixer's.

use nalgebra::Vector3;

use crate::sitl::arguments::Arguments;
use crate::sitl::pilot::{Channels, Phase, Pilot, climbed};
use crate::sitl::plan::{Hold, Manoeuvre, Plan, Target};
use crate::sitl::world::World;
use crate::state::wrapped;
use crate::vehicle::GRAVITY_M_S2;

/// Rates of the full sticks, degrees/s: `examples/betaflight/simulator.txt` has them.
const RATES_DEG_S: [f64; 3] = [400.0, 400.0, 200.0];

/// When the switch is turned, s: Betaflight takes 5 s from its start on, in which its gyroscopes calibrate; and until when the rotors
/// are to turn.
const ARM_S: f64 = 9.0;
const ARMED_S: f64 = 15.0;

/// Longest time until the vehicle hovers, s.
const PATIENCE_S: f64 = 60.0;

/// Height of the manoeuvre, m.
const HEIGHT_M: f64 = 20.0;

/// Time of a step in heading, roll or failure for which the throttle is left alone, s.
const CONSTANT_S: f64 = 3.0;

/// Gains: acceleration per error of place and of speed, and of the height's integral; rate per error of attitude.
const PLACE: f64 = 1.0;
const SPEED: f64 = 1.6;
const INTEGRAL: f64 = 0.4;
const ATTITUDE: [f64; 3] = [3.0, 3.0, 2.0];

/// Largest acceleration sideways, over gravity, and upward speed, m/s.
const TILT: f64 = 0.35;
const CLIMB_M_S: f64 = 2.0;

/// The pilot.
#[derive(Debug)]
pub struct Sticks {
    plan: Option<Plan>,
    phase: Phase,
    /// The present estimate of the stick that hovers, and its error.
    hover: f64,
    trim: f64,
    /// When it last looked, s.
    updated_s: f64,
    throttle: f64,
    /// Of the full stick: roll, pitch, yaw.
    rates: [f64; 3],
}

impl Sticks {
    /// A pilot who guesses the stick of the hover.
    pub fn new(hover: f64, arguments: &Arguments) -> Sticks {
        Sticks {
            plan: arguments.fly.map(Manoeuvre::plan),
            phase: Phase::Arming,
            hover,
            trim: 0.0,
            updated_s: 0.0,
            throttle: 0.0,
            rates: [0.0; 3],
        }
    }

    /// Whether Betaflight holds the altitude: in the manoeuvre without steps.
    fn is_held(&self) -> bool {
        let has_steps = self.plan.as_ref().is_none_or(|plan| !plan.steps.is_empty());
        !has_steps && matches!(self.phase, Phase::Flying(_))
    }

    /// Whether the throttle is left alone: in the first seconds of a step that is not in height or place.
    fn is_constant(&self, time_s: f64) -> bool {
        let (Some(now_s), Some(plan)) = (self.manoeuvre_s(time_s), &self.plan) else {
            return false;
        };
        let moves = plan
            .steps
            .iter()
            .any(|(_, target)| target.offset != Vector3::zeros());
        let has_begun = |begin_s: f64| (begin_s..begin_s + CONSTANT_S).contains(&now_s);
        self.is_held() || !moves && plan.steps.iter().any(|(begin_s, _)| has_begun(*begin_s))
    }

    fn fly(&mut self, world: &World, target: Target, height_m: f64) {
        let (state, time_s) = (&world.state, world.time_s());
        let dt = time_s - self.updated_s;
        let wanted = Vector3::new(target.offset.x, target.offset.y, -height_m - target.offset.z);
        let error = wanted - state.position;
        // A height is approached at a limited speed.
        let up_m_s = (-error.z * PLACE / SPEED).clamp(-CLIMB_M_S, CLIMB_M_S) + state.velocity.z;
        if target.hold == Hold::FullThrust {
            self.throttle = 1.0;
        } else if !self.is_constant(time_s) {
            // Thrust goes with about the square of the stick.
            let per_stick = 2.0 * GRAVITY_M_S2 / self.hover;
            self.trim = (self.trim + INTEGRAL * up_m_s / per_stick * dt).clamp(-0.3, 0.3);
            self.throttle = self.hover + self.trim + SPEED * up_m_s / per_stick;
        }
        let pull = (error * PLACE - state.velocity * SPEED) / GRAVITY_M_S2;
        let (sine, cosine) = (libm::sin(state.yaw()), libm::cos(state.yaw()));
        let [forward, right] = [cosine * pull.x + sine * pull.y, cosine * pull.y - sine * pull.x];
        let [forward, right] = [forward, right].map(|tilt| tilt.clamp(-TILT, TILT));
        let attitude = if target.hold == Hold::Place {
            [right, -forward, target.yaw_deg.to_radians()]
        } else {
            [target.roll_deg.to_radians(), 0.0, target.yaw_deg.to_radians()]
        };
        let euler = world.euler();
        self.rates = std::array::from_fn(|axis| {
            let rate = ATTITUDE[axis] * wrapped(attitude[axis] - euler[axis]).to_degrees();
            (rate / RATES_DEG_S[axis]).clamp(-1.0, 1.0)
        });
        self.updated_s = time_s;
    }
}

impl Pilot for Sticks {
    fn update(&mut self, world: &World) -> Result<(), String> {
        let time_s = world.time_s();
        let turns = world.state.speed.max() > 0.01;
        match self.phase {
            _ if self.plan.is_none() => {}
            Phase::Arming if time_s > ARMED_S => {
                return Err(format!("the rotors do not turn within {ARMED_S} s"));
            }
            Phase::Arming if turns => self.phase = Phase::Climbing(None),
            Phase::Arming => {}
            Phase::Climbing(_) if time_s > PATIENCE_S => {
                return Err(format!("no hover within {PATIENCE_S} s"));
            }
            Phase::Climbing(still_since_s) => {
                self.fly(world, Target::default(), HEIGHT_M);
                self.phase = climbed(still_since_s, HEIGHT_M - 0.3, world);
            }
            Phase::Flying(_) if !turns => return Err("Betaflight has disarmed".to_owned()),
            Phase::Flying(_) => self.fly(world, self.wanted(time_s).unwrap_or_default(), HEIGHT_M),
        }
        if self.phase == Phase::Arming {
            self.updated_s = time_s;
        }
        Ok(())
    }

    fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    fn phase(&self) -> Phase {
        self.phase
    }

    fn thrust_setpoint(&self) -> f64 {
        self.throttle
    }

    fn sticks(&self) -> Channels {
        let around = |share: f64| (1500.0 + 500.0 * share).round() as u16;
        let mut channels = [1000; 16];
        // The pitch stick is positive nose down, Betaflight's rates positive with the stick.
        let [roll, pitch, yaw] = self.rates;
        (channels[0], channels[1], channels[3]) = (around(roll), around(-pitch), around(yaw));
        channels[2] = (1000.0 + 1000.0 * self.throttle.clamp(0.0, 1.0)).round() as u16;
        // Betaflight's altitude hold keeps the height of a hover, level.
        if self.is_held() {
            (channels[0], channels[1], channels[3], channels[5]) = (1500, 1500, 1500, 2000);
        }
        channels[4] = if self.updated_s > ARM_S { 2000 } else { 1000 };
        channels
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use mixer_compiler::{Source, compile};

    use super::*;
    use crate::sitl::flight::{End, Flight};
    use crate::sitl::score::Score;
    use crate::sitl::vehicle::{Throttles, Vehicle};

    /// Betaflight in little: rates by the sticks, its mix without a curve.
    fn motors(world: &World, channels: &Channels, factors: &[[f64; 3]], idle: f64) -> Throttles {
        let around = |channel: usize| (f64::from(channels[channel]) - 1500.0) / 500.0;
        let rate = world.state.rate.map(f64::to_degrees);
        // Positive nose down.
        let errors = [
            around(0) * RATES_DEG_S[0] - rate.x,
            around(1) * RATES_DEG_S[1] + rate.y,
            around(3) * RATES_DEG_S[2] - rate.z,
        ];
        let throttle = (f64::from(channels[2]) - 1000.0) / 1000.0;
        let gains = [5e-4, 5e-4, 5e-3];
        Throttles::from_fn(|motor, _| match factors.get(motor) {
            Some(factors) if channels[4] > 1700 => {
                let mix: f64 = (0..3)
                    .map(|axis| gains[axis] * errors[axis] * factors[axis])
                    .sum();
                idle + (1.0 - idle) * (throttle + mix).clamp(0.0, 1.0)
            }
            _ => 0.0,
        })
    }

    #[test]
    fn the_sticks_fly_a_manoeuvre() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let compiled = compile(&Source::new("x8.toml", std::fs::read_to_string(file).unwrap())).unwrap();
        let factors = compiled.betaflight_factors();
        for (fly, kinds) in [("yaw", 2), ("sidestep", 2), ("roll", 1)] {
            let arguments = ["sitl", file, "--betaflight", "--speed", "0", "--fly", fly];
            let arguments = Arguments::try_parse_from(arguments).unwrap();
            let vehicle = Vehicle::new(&arguments).unwrap();
            let pilot = Box::new(Sticks::new(vehicle.hover_throttle, &arguments));
            let mut flight = Flight::new(vehicle, Some(pilot), &arguments);
            let end = loop {
                let channels = flight.pilot.as_ref().unwrap().sticks();
                let throttles = motors(&flight.world, &channels, &factors, compiled.airframe.throttle.min);
                if let Some(end) = flight.advance(&throttles, 2000).unwrap() {
                    break end;
                }
            };
            assert_eq!(end, End::Done, "{fly}");
            let score = Score::new(&flight);
            assert_eq!(score.rows.len(), kinds, "{score}");
            // Every step arrives, and tilts no more than it is to.
            let arrives = score
                .rows
                .iter()
                .flat_map(|(_, steps)| steps)
                .all(|step| !step[0].is_nan() && step[6] < 30.0);
            assert!(arrives, "{score}");
        }
    }
}
