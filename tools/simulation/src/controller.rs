//! The controller, the same for both mixers: a cascade of position PID, attitude P and rate PID at
//! 5 ms, as in PX4.
//!
//! It commands a thrust in newtons and torques in newton metres, so that no gain depends on a
//! mixer. The gains are poles placed on the nominal vehicle with a mixer that delivers what is
//! asked; none was tried out against a flight:
//!
//! * position, on 1/s^2: a triple pole at -p, from s^3 + 3 p s^2 + 3 p^2 s + p^3; the derivative
//!   acts on the measured velocity. p is [`HORIZONTAL_POLE`] and [`VERTICAL_POLE`]: delay, filter,
//!   attitude loop and rotors lag by some 0.25 s and 0.13 s, which is 1/(5 p) for both.
//! * attitude, on 1/s: a pole at -[`ATTITUDE_POLE`], a third of the rate loop's.
//! * rate, on 1/(J s) behind the rotors' lag: the derivative term cancels the lag, proportional and
//!   integral place poles at -0.8 w and -0.2 w, w = [`RATE_POLE`], from s^2 + w s + 0.16 w^2. Yaw
//!   is a third of roll and pitch, because the rotors' torque is small.
//!
//! Thrust is the demanded vertical force over the cosine of the present tilt. How the tilt setpoint
//! follows from the demanded acceleration is a choice that matters to this comparison: see
//! [`Tilt`].

use nalgebra::{Rotation3, UnitQuaternion, Vector3, Vector4};

use crate::manoeuvre::Reference;
use crate::vehicle::{GRAVITY_M_S2, INERTIA_KG_M2, MASS_KG, ROTOR_LAG_S};

/// Sampling time, s (section V-B).
pub const PERIOD_S: f64 = 0.005;

/// Triple pole of the horizontal position, rad/s.
pub const HORIZONTAL_POLE: f64 = 0.8;

/// Triple pole of the altitude, rad/s.
pub const VERTICAL_POLE: f64 = 1.5;

/// Poles of roll, pitch and yaw, rad/s.
pub const ATTITUDE_POLE: Vector3<f64> = Vector3::new(8.0, 8.0, 2.6);

/// Crossover of the rate loops about x, y, z, rad/s.
pub const RATE_POLE: Vector3<f64> = Vector3::new(24.0, 24.0, 8.0);

/// Time constant of the filter on the velocity from position differences, s.
const VELOCITY_FILTER_S: f64 = 0.02;

/// Time constant of the filter on the derivative of the rate, s.
const DERIVATIVE_FILTER_S: f64 = 0.01;

/// Largest demanded horizontal acceleration, m/s2: 17 degrees of tilt.
const HORIZONTAL_LIMIT_M_S2: f64 = 3.0;

/// Largest demanded vertical acceleration, m/s2: the demanded force always points upwards.
const VERTICAL_LIMIT_M_S2: f64 = 8.0;

/// Tilt beyond which the thrust is not raised further: 60 degrees.
const LEAST_COSINE: f64 = 0.5;

/// What the controller knows of the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// Position in the world, m, as old as the motion capture is.
    pub position: Vector3<f64>,
    /// Rotation from body to world, from the autopilot's own sensors.
    pub attitude: UnitQuaternion<f64>,
    /// Angular rate in the body, rad/s.
    pub rate: Vector3<f64>,
}

/// The tilt setpoint for a demanded acceleration a (z down), gravity g.
///
/// If the mixer under-delivers, the altitude's integrator holds the vehicle up by a lasting upward
/// a_z. A tilt that counts it in is then too small by the same factor: the mixer's thrust error
/// becomes a gain error in x and y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tilt {
    /// The thrust axis along (a_x, a_y, -g), PX4's default (`MPC_ACC_DECOUPLE` = 1).
    Decoupled,
    /// The thrust axis along the demanded force (a_x, a_y, a_z - g), as in geometric control.
    Coupled,
}

/// The controller with its memory.
#[derive(Clone, Debug)]
pub struct Controller {
    tilt: Tilt,
    position_integral: Vector3<f64>,
    rate_integral: Vector3<f64>,
    velocity: Vector3<f64>,
    rate_derivative: Vector3<f64>,
    last: Option<(Vector3<f64>, Vector3<f64>)>,
}

impl Controller {
    /// A controller without memory.
    pub fn new(tilt: Tilt) -> Self {
        Controller {
            tilt,
            position_integral: Vector3::zeros(),
            rate_integral: Vector3::zeros(),
            velocity: Vector3::zeros(),
            rate_derivative: Vector3::zeros(),
            last: None,
        }
    }

    /// The wrench `[roll, pitch, yaw (N m), thrust (N)]` for the next period.
    pub fn update(&mut self, measured: &Measurement, reference: &Reference) -> Vector4<f64> {
        self.differentiate(measured);
        let demanded = self.acceleration(measured, reference);
        let vertical = match self.tilt {
            Tilt::Decoupled => -GRAVITY_M_S2,
            Tilt::Coupled => demanded.z - GRAVITY_M_S2,
        };
        let axis = Vector3::new(demanded.x, demanded.y, vertical);
        let attitude = attitude_setpoint(&axis, reference.yaw).unwrap_or(measured.attitude);
        let torque = self.torque(measured, &attitude);
        let cosine = (measured.attitude * Vector3::z()).z.max(LEAST_COSINE);
        let thrust = MASS_KG * (GRAVITY_M_S2 - demanded.z) / cosine;
        Vector4::new(torque.x, torque.y, torque.z, thrust)
    }

    /// Velocity and angular acceleration from the differences to the last sample, filtered to the
    /// first order.
    fn differentiate(&mut self, measured: &Measurement) {
        let (position, rate) = self.last.unwrap_or((measured.position, measured.rate));
        let velocity = (measured.position - position) / PERIOD_S;
        let derivative = (measured.rate - rate) / PERIOD_S;
        self.velocity += (velocity - self.velocity) * (PERIOD_S / (VELOCITY_FILTER_S + PERIOD_S));
        self.rate_derivative +=
            (derivative - self.rate_derivative) * (PERIOD_S / (DERIVATIVE_FILTER_S + PERIOD_S));
        self.last = Some((measured.position, measured.rate));
    }

    /// The acceleration that is demanded in the world, m/s2: position PID.
    fn acceleration(&mut self, measured: &Measurement, reference: &Reference) -> Vector3<f64> {
        let pole = Vector3::new(HORIZONTAL_POLE, HORIZONTAL_POLE, VERTICAL_POLE);
        let error = reference.position - measured.position;
        self.position_integral += error * PERIOD_S;
        let demanded = pole.map(|p| p * p * p).component_mul(&self.position_integral)
            + pole.map(|p| 3.0 * p * p).component_mul(&error)
            - pole.map(|p| 3.0 * p).component_mul(&self.velocity);
        let horizontal = demanded.xy().cap_magnitude(HORIZONTAL_LIMIT_M_S2);
        let vertical = demanded.z.clamp(-VERTICAL_LIMIT_M_S2, VERTICAL_LIMIT_M_S2);
        Vector3::new(horizontal.x, horizontal.y, vertical)
    }

    /// The torque that the rotors are to give in the body, N m: attitude P, rate PID.
    fn torque(&mut self, measured: &Measurement, setpoint: &UnitQuaternion<f64>) -> Vector3<f64> {
        let turn = measured.attitude.inverse() * setpoint;
        // q and -q are one rotation: take the shorter way.
        let angle = turn.imag() * (2.0 * 1.0f64.copysign(turn.w));
        let error = ATTITUDE_POLE.component_mul(&angle) - measured.rate;
        self.rate_integral += error * PERIOD_S;
        let acceleration = RATE_POLE.component_mul(&error)
            + RATE_POLE.map(|w| 0.16 * w * w).component_mul(&self.rate_integral)
            - RATE_POLE.component_mul(&self.rate_derivative) * ROTOR_LAG_S;
        INERTIA_KG_M2.component_mul(&acceleration)
    }
}

/// The attitude whose thrust axis is along `axis` (world) and whose nose points to `yaw`; none if
/// there is none.
fn attitude_setpoint(axis: &Vector3<f64>, yaw: f64) -> Option<UnitQuaternion<f64>> {
    let down = (-axis).try_normalize(1e-9)?;
    let (sin, cos) = libm::sincos(yaw);
    let right = down.cross(&Vector3::new(cos, sin, 0.0)).try_normalize(1e-9)?;
    let forward = right.cross(&down);
    let rotation = Rotation3::from_basis_unchecked(&[forward, right, down]);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::WEIGHT_N;

    fn at(position: Vector3<f64>, attitude: UnitQuaternion<f64>) -> Measurement {
        Measurement {
            position,
            attitude,
            rate: Vector3::zeros(),
        }
    }

    const HERE: Reference = Reference {
        position: Vector3::new(0.0, 0.0, -1.0),
        yaw: 0.0,
    };

    #[test]
    fn on_the_spot_it_commands_the_weight() {
        let wrench =
            Controller::new(Tilt::Decoupled).update(&at(HERE.position, UnitQuaternion::identity()), &HERE);
        assert!(
            (wrench - Vector4::new(0.0, 0.0, 0.0, WEIGHT_N)).norm() < 1e-12,
            "{wrench}"
        );
    }

    #[test]
    fn every_axis_acts_against_its_error() {
        let level = UnitQuaternion::identity();
        let answer = |offset: Vector3<f64>, attitude| {
            Controller::new(Tilt::Decoupled).update(&at(HERE.position + offset, attitude), &HERE)
        };
        // South of the reference the nose goes down, west of it the right side does, below it
        // thrust rises.
        assert!(answer(-Vector3::x(), level)[1] < -0.1);
        assert!(answer(-Vector3::y(), level)[0] > 0.1);
        assert!(answer(0.1 * Vector3::z(), level)[3] > WEIGHT_N + 1.0);
        // A turned nose is turned back.
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.1);
        assert!(answer(Vector3::zeros(), turned)[2] < -0.1);
    }

    #[test]
    fn a_lasting_upward_demand_shrinks_the_coupled_tilt_alone() {
        // Below and south of the reference: nose down by a_x / g, or by a_x / (g - a_z).
        let offset = Vector3::new(-0.5, 0.0, 0.3);
        let pitch = |tilt| {
            Controller::new(tilt).update(&at(HERE.position + offset, UnitQuaternion::identity()), &HERE)[1]
        };
        let climb = 3.0 * VERTICAL_POLE * VERTICAL_POLE * 0.3;
        let expected = GRAVITY_M_S2 / (GRAVITY_M_S2 + climb);
        let shrunk = pitch(Tilt::Coupled) / pitch(Tilt::Decoupled);
        assert!((shrunk / expected - 1.0).abs() < 0.01, "{shrunk} {expected}");
    }
}
