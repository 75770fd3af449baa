//! State of the vehicle, and its derivative: the same fields.

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};

/// State of a vehicle of `R` channels. World axes north, east, down; body axes forward, right, down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const R: usize> {
    /// Position in the world, m; z is minus the altitude.
    pub position: Vector3<f64>,
    /// Velocity in the world, m/s.
    pub velocity: Vector3<f64>,
    /// Rotation from body to world. Of unit length after every step, not within one.
    pub attitude: Quaternion<f64>,
    /// Angular rate in the body, rad/s.
    pub rate: Vector3<f64>,
    /// Speed per channel over that of full throttle at the reference voltage.
    pub speed: SVector<f64, R>,
    /// Charge drawn from the battery, A h.
    pub charge_ah: f64,
}

impl<const R: usize> State<R> {
    /// At rest and level at `position` with all rotors at `speed` and a full battery.
    pub fn level(position: Vector3<f64>, speed: f64) -> Self {
        State {
            position,
            velocity: Vector3::zeros(),
            attitude: Quaternion::identity(),
            rate: Vector3::zeros(),
            speed: SVector::repeat(speed),
            charge_ah: 0.0,
        }
    }

    /// This state and `factor` times another, or a derivative.
    pub fn plus(&self, factor: f64, other: &State<R>) -> Self {
        State {
            position: self.position + other.position * factor,
            velocity: self.velocity + other.velocity * factor,
            attitude: self.attitude + other.attitude * factor,
            rate: self.rate + other.rate * factor,
            speed: self.speed + other.speed * factor,
            charge_ah: self.charge_ah + other.charge_ah * factor,
        }
    }

    /// The attitude as a rotation from body to world.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        UnitQuaternion::new_normalize(self.attitude)
    }

    /// Yaw, rad, in (-pi, pi]: clockwise from north, seen from above.
    pub fn yaw(&self) -> f64 {
        let forward = self.rotation() * Vector3::x();
        libm::atan2(forward.y, forward.x)
    }
}

/// An angle in (-pi, pi], rad.
pub fn wrapped(angle: f64) -> f64 {
    libm::atan2(libm::sin(angle), libm::cos(angle))
}
