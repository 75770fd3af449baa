//! The plant: six degrees of freedom under the coaxial map of the airframe file.
//!
//! With R the rotation from body to world, m the mass, I the inertia, r_i and a_i position and
//! thrust axis of unit i, J the inertia of a rotor, n_u and n_l the speeds of its rotors:
//!
//! ```text
//! m dv/dt = m g e_z + R sum_i a_i f_i + F
//! I dw/dt = sum_i (r_i x a_i f_i - s_i Q_i a_i) - dH/dt - w x (I w + H)
//! H       = -sum_i s_i J (n_u - n_l) a_i
//! dq/dt   = q (0, w) / 2
//! f_i     = (1 + flutter_i) c f(n_u, n_l; V, rho),   Q_i = c Q(n_u, n_l; V, rho)
//! ```
//!
//! The rotors are flywheels: what turns the frame is the reaction of the motors, of which the air takes s Q, and the rotors J dn/dt.
//! Written for frame and rotors as one, that is the second line: I w + H changes by the torque of the air alone, and in the
//! body's axes by its turning. The two rotors of a pair turn oppositely, so H is next to nothing as long as both
//! turn alike. In yaw one speeds up and the other one slows down, and both reactions add to the torque of the air. dn/dt is that of a [`motor`](crate::motor) under
//! `(1 + mismatch) throttle`.
//!
//! c is 1, or [the factor](Plant::scaled) by which every pair differs from the file. f and Q are eq. (1) with the f64 coefficients of the file where its
//! rotors have these speeds at the bench's voltage and density; elsewhere the motor says what becomes of them, not the mixer's laws, which are so put to the test.
//!
//! The share that each rotor has of Q is not known and not needed: the model of a motor's own load, k n^2, says how fast it follows, the
//! map what the air does to the frame. k is that of the map: the slope of Q in hover as one rotor turns faster and the other slower.
//!
//! Left out, since
//! the paper gives nothing to model them by: drag, ground effect, wake between units. The rotors' inertia about axes in their plane is the frame's.

use mixer_compiler::airframe::Airframe;
use mixer_compiler::flywheel::{self, Flywheel};
use mixer_compiler::{atmosphere, bisected};
use nalgebra::{Quaternion, SVector, Vector3};

use crate::battery::Battery;
use crate::integrator::runge_kutta;
use crate::motor::{Motor, NO_LOAD};
use crate::pair::Pair;
use crate::state::State;
use crate::vehicle::{Body, GRAVITY_M_S2};

/// Steps in which load and voltage settle.
const SETTLING: u32 = 30;

/// One unit as the plant sees it.
#[derive(Clone, Debug)]
struct Unit {
    position_m: Vector3<f64>,
    axis: Vector3<f64>,
    spin_sign: f64,
    channels: [usize; 2],
    pair: Pair,
    /// J times the speed at full throttle at the reference, N m s.
    momentum_nms: f64,
}

impl Unit {
    /// What the upper and the lower rotor have of a number per channel.
    fn of<const R: usize>(&self, rotors: &SVector<f64, R>) -> [f64; 2] {
        self.channels
            .map(|channel| rotors.get(channel).copied().unwrap_or(0.0))
    }
}

/// What the air does beyond the bench: held over one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance<const R: usize> {
    /// Force on the vehicle in the world, N.
    pub force_n: Vector3<f64>,
    /// Relative change of each unit's thrust; entries beyond the units have no effect.
    pub flutter: SVector<f64, R>,
}

impl<const R: usize> Default for Disturbance<R> {
    fn default() -> Self {
        Disturbance {
            force_n: Vector3::zeros(),
            flutter: SVector::zeros(),
        }
    }
}

/// A vehicle of at most `R` rotors.
#[derive(Clone, Debug)]
pub struct Plant<const R: usize> {
    units: Vec<Unit>,
    motor: Motor,
    /// Density of the air on the bench, that of the sea level where the file has none.
    bench_kg_m3: f64,
    /// Thrust and torque of every pair over those of the file.
    scale: f64,
    body: Body,
    battery: Battery,
    mismatch: SVector<f64, R>,
}

impl<const R: usize> Plant<R> {
    /// The plant of `airframe`, whose channels must be 0 to R - 1 (those beyond stand still).
    /// `mismatch` is each rotor's relative deviation in effective throttle, 0.01 being a rotor that
    /// turns one per cent faster than commanded.
    pub fn new(airframe: &Airframe, body: Body, battery: Battery, mismatch: SVector<f64, R>) -> Self {
        let reference_v = airframe.voltage.as_ref().map(|voltage| voltage.reference);
        let motor = Motor::new(flywheel::exponent(airframe), NO_LOAD, reference_v);
        // What cannot hover turns without reaction.
        let of_kind = |rotor: Option<Flywheel>| {
            let rotor = rotor.map(|rotor| rotor.with_lag(body.rotor_lag_s));
            let [throttle, momentum_nms] = rotor.map_or([1.0, 0.0], |rotor| {
                [rotor.hover_throttle, 2.0 * rotor.lead_s * rotor.torque_nm]
            });
            let speed = motor.speed_at_reference(throttle);
            (speed, momentum_nms / speed)
        };
        let kinds = Flywheel::of_mass(airframe, body.mass_kg, None).into_iter();
        let kinds: Vec<(f64, f64)> = kinds.map(of_kind).collect();
        let units = airframe.units.iter().map(|unit| Unit {
            position_m: Vector3::from(unit.position_m),
            axis: Vector3::from(unit.axis),
            spin_sign: airframe.spin_sign(unit),
            channels: [unit.upper_channel, unit.lower_channel.unwrap_or(usize::MAX)],
            pair: Pair::new(airframe.kind_of(unit), &airframe.throttle),
            // The spin's sign is that of the torque, which counts negative for the upper rotor of a pair alone.
            momentum_nms: match unit.lower_channel {
                Some(_) => kinds[unit.kind].1,
                None => -kinds[unit.kind].1,
            },
        });
        // All rotors have one lag, at the mean of their speeds in hover where kinds differ.
        let speed = kinds.iter().map(|(speed, _)| speed).sum::<f64>() / kinds.len() as f64;
        let brakes = airframe
            .vehicle
            .as_ref()
            .is_none_or(|vehicle| vehicle.rotor_brakes);
        Plant {
            units: units.collect(),
            motor: motor.with_lag(body.rotor_lag_s, speed).braking(brakes),
            bench_kg_m3: airframe
                .air
                .as_ref()
                .map_or_else(|| atmosphere::density_at(0.0), |air| air.reference),
            scale: 1.0,
            body,
            battery,
            mismatch,
        }
    }

    /// The same vehicle in air of a density, kg/m3.
    ///
    /// # Errors
    /// A voltage's exponent that is not a motor's.
    pub fn in_air(self, density_kg_m3: f64) -> Result<Self, String> {
        let motor = self.motor.in_air(density_kg_m3 / self.bench_kg_m3)?;
        Ok(Plant { motor, ..self })
    }

    /// The same vehicle, thrust and torque of every pair multiplied by a factor.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Plant { scale, ..self }
    }

    /// The same vehicle with another battery.
    #[must_use]
    pub fn on(self, battery: Battery) -> Self {
        Plant { battery, ..self }
    }

    /// The state with all rotors in steady state under `command`.
    #[must_use]
    pub fn steady(&self, state: &State<R>, command: &SVector<f64, R>) -> State<R> {
        let mut state = *state;
        // The load sets the voltage, the voltage the speeds.
        for _ in 0..SETTLING {
            let volts = self.voltage_v(&state);
            state.speed = command.map(|throttle| self.motor.speed(throttle, volts));
        }
        state
    }

    /// Level with a full battery, all rotors in steady state at one throttle.
    pub fn alike(&self, throttle: f64) -> State<R> {
        let rotors = 2 * self.units.len();
        let command = SVector::from_fn(|channel, _| if channel < rotors { throttle } else { 0.0 });
        self.steady(&State::level(Vector3::zeros(), 0.0), &command)
    }

    /// Throttle of all rotors that carries the weight with the battery full; `None` where full throttle does not.
    pub fn hover_throttle(&self) -> Option<f64> {
        let lifts = |throttle| {
            let (force, _) = self.rotor_wrench(&self.alike(throttle), &SVector::zeros());
            -force.z > self.body.mass_kg * GRAVITY_M_S2
        };
        lifts(1.0).then(|| bisected([0.0, 1.0], lifts))
    }

    /// Current of the battery, A.
    pub fn current_a(&self, state: &State<R>) -> f64 {
        self.battery.current_a(&state.speed)
    }

    /// Voltage of the battery under the present load, V.
    pub fn voltage_v(&self, state: &State<R>) -> f64 {
        self.battery.voltage_v(state.charge_ah, &state.speed)
    }

    /// Force (N) and torque (N m) of the air on the rotors, in the body.
    pub fn rotor_wrench(&self, state: &State<R>, flutter: &SVector<f64, R>) -> (Vector3<f64>, Vector3<f64>) {
        let volts = self.voltage_v(state);
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for (unit, flutter) in self.units.iter().zip(flutter) {
            let (factor, throttles) = self.motor.at_reference(unit.of(&state.speed), volts);
            let [f, q] = unit
                .pair
                .efforts(throttles)
                .map(|effort| self.scale * factor * effort);
            let thrust = unit.axis * ((1.0 + flutter) * f);
            force += thrust;
            torque += unit.position_m.cross(&thrust) - unit.axis * (unit.spin_sign * q);
        }
        (force, torque)
    }

    /// Angular momentum of the rotors in the frame, H, or its change, of speeds or their changes; N m s.
    pub fn rotor_momentum(&self, speed: &SVector<f64, R>) -> Vector3<f64> {
        let of_unit = |unit: &Unit| {
            let [upper, lower] = unit.of(speed);
            unit.axis * (-unit.spin_sign * unit.momentum_nms * (upper - lower))
        };
        self.units.iter().map(of_unit).sum()
    }

    /// The state `step` seconds later, `command` (throttle per channel) and `disturbance` held.
    pub fn step(
        &self,
        state: &State<R>,
        command: &SVector<f64, R>,
        disturbance: &Disturbance<R>,
        step: f64,
    ) -> State<R> {
        let driven = command + command.component_mul(&self.mismatch);
        let mut next = runge_kutta(state, step, |state| self.derivative(state, &driven, disturbance));
        next.attitude = next.rotation().into_inner();
        next
    }

    fn derivative(
        &self,
        state: &State<R>,
        driven: &SVector<f64, R>,
        disturbance: &Disturbance<R>,
    ) -> State<R> {
        let volts = self.voltage_v(state);
        let (force, torque) = self.rotor_wrench(state, &disturbance.flutter);
        let speed = state.speed.zip_map(driven, |speed, throttle| {
            self.motor.acceleration(speed, throttle, volts)
        });
        let gravity = Vector3::z() * GRAVITY_M_S2;
        let Body {
            mass_kg,
            inertia_kg_m2,
            ..
        } = self.body;
        let momentum = inertia_kg_m2.component_mul(&state.rate) + self.rotor_momentum(&state.speed);
        let turning = torque - self.rotor_momentum(&speed) - state.rate.cross(&momentum);
        State {
            position: state.velocity,
            velocity: gravity + (state.rotation() * force + disturbance.force_n) / mass_kg,
            attitude: state.attitude * Quaternion::from_imag(state.rate) * 0.5,
            rate: turning.component_div(&inertia_kg_m2),
            speed,
            charge_ah: self.current_a(state) / 3600.0,
        }
    }
}
