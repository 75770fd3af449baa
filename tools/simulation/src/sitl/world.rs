//! The vehicle in its place: in the air, or held by the ground.
//!
//! On the ground the legs hold position, attitude and heading as long as the rotors lift less than
//! the weight; tipping over is not modelled.

use nalgebra::{SVector, UnitQuaternion, Vector3};

use super::vehicle::{MOST_ROTORS, Throttles, Vehicle};
use crate::plant::Disturbance;
use crate::state::State;
use crate::vehicle::GRAVITY_M_S2;

/// Longest step of the plant, s.
const LONGEST_STEP_S: f64 = 0.001;

/// Speed (m/s) and cosine of the tilt at which touching the ground is a crash.
const CRASH_SPEED_M_S: f64 = 4.0;
const CRASH_COSINE: f64 = 0.7;

/// The vehicle, its state and the time.
#[derive(Clone, Debug)]
pub struct World {
    /// What flies.
    pub vehicle: Vehicle,
    /// What pushes it from outside over its mass, in the body, m/s2: drag, which a test of `review` sets.
    pub push_m_s2: Vector3<f64>,
    /// Its state.
    pub state: State<MOST_ROTORS>,
    /// Simulated time, microseconds.
    pub time_us: u64,
    /// What an accelerometer measures, m/s2 in the body.
    pub specific_force: Vector3<f64>,
    /// Whether the ground holds it.
    pub on_ground: bool,
    /// Time of a crash, s.
    pub crashed_s: Option<f64>,
    stopped: [bool; MOST_ROTORS],
}

impl World {
    /// On the ground at the origin, level, nose to the north.
    pub fn new(vehicle: Vehicle) -> World {
        World {
            vehicle,
            push_m_s2: Vector3::zeros(),
            state: State::level(Vector3::zeros(), 0.0),
            time_us: 0,
            specific_force: -Vector3::z() * GRAVITY_M_S2,
            on_ground: true,
            crashed_s: None,
            stopped: [false; MOST_ROTORS],
        }
    }

    /// Simulated time, s.
    pub fn time_s(&self) -> f64 {
        self.time_us as f64 * 1e-6
    }

    /// Stops the rotor on an output for good: it is braked by its motor.
    pub fn stop(&mut self, output: usize) {
        if let Some(stopped) = self.stopped.get_mut(output) {
            *stopped = true;
        }
    }

    /// Voltage under load, V.
    pub fn voltage_v(&self) -> f64 {
        self.vehicle.plant.voltage_v(&self.state)
    }

    /// Current, A.
    pub fn current_a(&self) -> f64 {
        self.vehicle.plant.current_a(&self.state)
    }

    /// Thrust of all rotors along the body's upward axis, N.
    pub fn thrust_n(&self) -> f64 {
        -self.rotor_force().z
    }

    /// Roll, pitch, yaw, rad.
    pub fn euler(&self) -> Vector3<f64> {
        let q = self.state.rotation();
        let forward = q * Vector3::x();
        // The third row of the rotation: down in the body.
        let down = q.inverse() * Vector3::z();
        Vector3::new(
            libm::atan2(down.y, down.z),
            libm::asin((-forward.z).clamp(-1.0, 1.0)),
            self.state.yaw(),
        )
    }

    /// Flies on for `duration_us` under `command`.
    pub fn advance(&mut self, command: &Throttles, duration_us: u64) {
        let duration_s = duration_us as f64 * 1e-6;
        let steps = (duration_s / LONGEST_STEP_S).ceil().max(1.0);
        let rotors = self.vehicle.rotors;
        let command = Throttles::from_fn(|rotor, _| {
            let turns = rotor < rotors && !self.stopped[rotor];
            // NaN, and what is below 0, is a rotor at rest.
            let is_driven = turns && command[rotor] > 0.0;
            if is_driven { command[rotor].min(1.0) } else { 0.0 }
        });
        for _ in 0..steps as u32 {
            self.step(&command, duration_s / steps);
        }
        self.time_us += duration_us;
    }

    fn rotor_force(&self) -> Vector3<f64> {
        self.vehicle.plant.rotor_wrench(&self.state, &SVector::zeros()).0
    }

    fn step(&mut self, command: &Throttles, step_s: f64) {
        let (plant, mass_kg) = (&self.vehicle.plant, self.vehicle.mass_kg);
        let disturbance = Disturbance {
            force_n: self.state.rotation() * self.push_m_s2 * mass_kg,
            ..Disturbance::default()
        };
        self.state = plant.step(&self.state, command, &disturbance, step_s);
        let force = self.rotor_force();
        self.specific_force = force / mass_kg + self.push_m_s2;
        self.on_ground = false;
        if self.state.position.z < 0.0 {
            return;
        }
        let rotation = self.state.rotation();
        let cosine = (rotation * Vector3::z()).z;
        if self.state.velocity.z > CRASH_SPEED_M_S || cosine < CRASH_COSINE {
            let time_s = self.time_s();
            self.crashed_s.get_or_insert(time_s);
        }
        self.state.position.z = 0.0;
        self.state.velocity.z = self.state.velocity.z.min(0.0);
        let lift = -(rotation * force).z;
        if lift < self.vehicle.weight_n() {
            let upright = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.state.yaw());
            self.state.velocity = Vector3::zeros();
            self.state.rate = Vector3::zeros();
            self.state.attitude = upright.into_inner();
            self.specific_force = -Vector3::z() * GRAVITY_M_S2;
            self.on_ground = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::sitl::arguments::Arguments;

    #[test]
    fn the_accelerometer_measures_thrust_and_drag() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/simulator/x8.toml");
        let arguments = Arguments::try_parse_from(["sitl", file, "--px4"]).unwrap();
        let vehicle = Vehicle::new(&arguments).unwrap();
        let command = Throttles::repeat(1.02 * vehicle.hover_throttle);
        let mut world = World::new(vehicle);
        world.push_m_s2 = Vector3::new(2.0, 0.0, 0.0);
        world.advance(&command, 3_000_000);
        for _ in 0..100 {
            let before = world.state.velocity;
            world.advance(&command, 1000);
            let felt = (world.state.velocity - before) / 0.001 - Vector3::z() * GRAVITY_M_S2;
            let measured = world.state.rotation() * world.specific_force;
            assert!((felt - measured).norm() < 1e-4, "{felt} {measured}");
        }
        assert!(world.state.velocity.x > 4.0, "{}", world.state.velocity);
        assert!(world.specific_force.xy().norm() > 0.5, "{}", world.specific_force);
    }
}
