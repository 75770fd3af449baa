//! A request to a mixer and its answer.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Allocation;
use mixer_rt::{Axis, Conditions, Health, Saturation, SetpointError, Wrench};

use crate::physics::Physics;
use mixer_setpoints::Random;

/// A compiled frame with what its answers are judged by.
pub struct Frame {
    /// The frame.
    pub compiled: Compiled,
    /// Its physics.
    pub physics: Physics,
    /// The largest `[roll, pitch, yaw, thrust]` at the reference voltage, N m and N.
    pub authority: [f64; 4],
}

impl Frame {
    /// Takes a compiled frame.
    pub fn new(compiled: Compiled) -> Self {
        let physics = Physics::new(&compiled);
        let authority = physics.authority();
        Frame {
            compiled,
            physics,
            authority,
        }
    }

    /// The authority of an axis (N m, N) to divide by: 1 of one that no unit has a part in.
    pub fn size(&self, axis: usize) -> f64 {
        let authority = self.authority[axis];
        if authority > 0.0 { authority } else { 1.0 }
    }

    /// Its priorities.
    pub fn allocation(&self) -> &Allocation {
        &self.compiled.airframe.allocation
    }

    /// Which of `[roll, pitch, yaw, thrust]` are controlled.
    pub fn served(&self) -> [bool; 4] {
        Axis::ALL.map(|axis| self.allocation().controls(axis))
    }

    /// A request of up to `size` times the authority in torque and 1.2 times in thrust, all rotors
    /// working.
    pub fn draw(&self, random: &mut Random, size: f64, volts: f32) -> Request {
        let size = random.uniform(0.0, size);
        let [roll, pitch, yaw, thrust] = self.authority;
        let mut torque = |authority: f64| (random.uniform(-size, size) * authority) as f32;
        let torques = [torque(roll), torque(pitch), torque(yaw)];
        let thrust = (random.uniform(-0.05, 1.2) * thrust) as f32;
        Request {
            wrench: [torques[0], torques[1], torques[2], thrust],
            volts,
            density: None,
            health: Health::GOOD,
        }
    }

    /// A voltage within the declared range; any where there is none.
    pub fn draw_volts(&self, random: &mut Random) -> f32 {
        let [low, high] = self.physics.voltage_range().unwrap_or([14.0, 14.0]);
        random.uniform(low, high) as f32
    }

    /// A density within the declared range; none where it is ignored.
    pub fn draw_density(&self, random: &mut Random) -> Option<f32> {
        let [low, high] = self.physics.density_range()?;
        Some(random.uniform(low, high) as f32)
    }
}

/// What is asked of a mixer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Roll, pitch, yaw (N m), thrust (N).
    pub wrench: [f32; 4],
    /// The battery's voltage, V.
    pub volts: f32,
    /// The air's density, kg/m3; `None` for a mix at the bench's.
    pub density: Option<f32>,
    /// The rotors that work.
    pub health: Health,
}

/// What a mixer makes of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Per output.
    pub throttle: Vec<f32>,
    /// Roll, pitch, yaw (N m), thrust (N), as the mixer says.
    pub achieved: [f64; 4],
    /// What could not be delivered, as the mixer says.
    pub saturation: Saturation,
}

impl Request {
    /// The correction `[k_f, k_Q]` of the frame under its conditions.
    pub fn factors(&self, frame: &Frame) -> [f64; 2] {
        frame.physics.factors_in(self.volts, self.density)
    }

    /// `[roll, pitch, yaw, thrust]` asked, N m and N.
    pub fn asked(&self) -> [f64; 4] {
        self.wrench.map(f64::from)
    }

    /// Has the frame's mixer answer.
    ///
    /// # Errors
    /// The request is not finite.
    pub fn mix(&self, frame: &Frame) -> Result<Answer, SetpointError> {
        let setpoint = Wrench::from_array(self.wrench);
        let tables = &frame.compiled.tables;
        let mut conditions = Conditions::at_voltage(self.volts);
        conditions.density_kg_m3 = self.density;
        let (throttle, achieved, saturation) = tables.mix_with_health(&setpoint, conditions, self.health)?;
        Ok(Answer {
            throttle,
            achieved: achieved.to_array().map(f64::from),
            saturation,
        })
    }
}

impl Answer {
    /// The largest difference of a throttle to that of another answer.
    pub fn change(&self, other: &Answer) -> f32 {
        let pairs = self.throttle.iter().zip(&other.throttle);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }
}
