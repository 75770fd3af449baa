//! The plant: six degrees of freedom under the coaxial map of the airframe file.
//!
//! With R the rotation from body to world, m the mass, J the inertia, r_i and a_i position and
//! thrust axis of unit i:
//!
//! ```text
//! m dv/dt     = m g e_z + R sum_i a_i f_i + F
//! J dw/dt     = sum_i (r_i x a_i f_i - s_i Q_i a_i) - w x J w
//! dq/dt       = q (0, w) / 2
//! tau de_k/dt = (1 + mismatch_k) throttle_k - e_k
//! f_i = (1 + flutter_i) c k_f(V) f(e_upper, e_lower),   Q_i = c k_Q(V) Q(e_upper, e_lower)
//! ```
//!
//! c is 1, or [the factor](Plant::scaled) by which every pair differs from the file. k_f and k_Q are the file's laws of the voltage. In [the air of an altitude](Plant::in_air) they and the throttles
//! of the map are those of a [`motor`](crate::motor) instead, so that the mixer's laws are put to the test.
//!
//! f and Q are eq. (1) with the f64 coefficients of the file: the map that the coaxial mixer
//! inverts. Unlike the mixer it has no f32 tables, and its rotors lag and differ. Left out, since
//! the paper gives nothing to model them by: drag, ground effect, wake between units, the rotors'
//! own angular momentum (it cancels in a contra-rotating pair).

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use mixer_compiler::airframe::{Airframe, Correction};
use mixer_compiler::atmosphere;
use nalgebra::{Quaternion, SVector, Vector3};

use crate::battery::Battery;
use crate::integrator::runge_kutta;
use crate::motor::{Motor, NO_LOAD};
use crate::pair::Pair;
use crate::state::State;
use crate::vehicle::{Body, GRAVITY_M_S2};

/// One unit as the plant sees it.
#[derive(Clone, Debug)]
struct Unit {
    position_m: Vector3<f64>,
    axis: Vector3<f64>,
    spin_sign: f64,
    channels: [usize; 2],
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
    pair: Pair,
    voltage: Option<Correction>,
    motor: Option<Motor>,
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
        let units = airframe.units.iter().map(|unit| Unit {
            position_m: Vector3::from(unit.position_m),
            axis: Vector3::from(unit.axis),
            spin_sign: unit.spin_sign(airframe.pair.upper_spin),
            channels: [unit.upper_channel, unit.lower_channel],
        });
        Plant {
            units: units.collect(),
            pair: Pair::new(&airframe.pair, &airframe.throttle),
            voltage: airframe.voltage.clone(),
            motor: None,
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

    /// The same vehicle in air of a density, kg/m3, its rotors on motors with [`NO_LOAD`]. The ohmic share is that of the thrust's exponent in the file.
    ///
    /// # Errors
    /// An exponent that is not a motor's.
    pub fn in_air(self, density_kg_m3: f64) -> Result<Self, String> {
        let voltage = self.voltage.as_ref();
        let exponent = voltage.map_or(TYPICAL_EXPONENT, |voltage| voltage.exponents()[0]);
        let reference_v = voltage.map(|voltage| voltage.reference);
        let sigma = density_kg_m3 / self.bench_kg_m3;
        let motor = Motor::new(exponent, NO_LOAD, reference_v, sigma).ok_or_else(|| {
            format!("thrust follows the voltage by the power {exponent:.2}: motors have 1 to 2")
        })?;
        Ok(Plant {
            motor: Some(motor),
            ..self
        })
    }

    /// The same vehicle, thrust and torque of every pair multiplied by a factor.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Plant { scale, ..self }
    }

    /// Current of the battery, A.
    pub fn current_a(&self, state: &State<R>) -> f64 {
        self.battery.current_a(&state.throttle)
    }

    /// Voltage of the battery under the present load, V.
    pub fn voltage_v(&self, state: &State<R>) -> f64 {
        self.battery.voltage_v(state.charge_ah, &state.throttle)
    }

    /// Force (N) and torque (N m) of the rotors in the body.
    pub fn rotor_wrench(&self, state: &State<R>, flutter: &SVector<f64, R>) -> (Vector3<f64>, Vector3<f64>) {
        let volts = self.voltage_v(state);
        let [k_f, k_q] = self
            .voltage
            .as_ref()
            .map_or([1.0; 2], |voltage| voltage.factors(volts));
        let effective = |channel: usize| state.throttle.get(channel).copied().unwrap_or(0.0);
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for (unit, flutter) in self.units.iter().zip(flutter) {
            let throttles = unit.channels.map(effective);
            let ([k_f, k_q], throttles) = match &self.motor {
                None => ([k_f, k_q], throttles),
                Some(motor) => {
                    let (factor, throttles) = motor.at_reference(throttles, volts);
                    ([factor; 2], throttles)
                }
            };
            let [f, q] = self.pair.efforts(throttles).map(|effort| self.scale * effort);
            let thrust = unit.axis * ((1.0 + flutter) * k_f * f);
            force += thrust;
            torque += unit.position_m.cross(&thrust) - unit.axis * (unit.spin_sign * k_q * q);
        }
        (force, torque)
    }

    /// The state `step` seconds later, `command` (throttle per channel) and `disturbance` held.
    pub fn step(
        &self,
        state: &State<R>,
        command: &SVector<f64, R>,
        disturbance: &Disturbance<R>,
        step: f64,
    ) -> State<R> {
        let target = command + command.component_mul(&self.mismatch);
        let mut next = runge_kutta(state, step, |state| self.derivative(state, &target, disturbance));
        next.attitude = next.rotation().into_inner();
        next
    }

    fn derivative(
        &self,
        state: &State<R>,
        target: &SVector<f64, R>,
        disturbance: &Disturbance<R>,
    ) -> State<R> {
        let (force, torque) = self.rotor_wrench(state, &disturbance.flutter);
        let gravity = Vector3::z() * GRAVITY_M_S2;
        let Body {
            mass_kg,
            inertia_kg_m2,
            rotor_lag_s,
        } = self.body;
        let momentum = inertia_kg_m2.component_mul(&state.rate);
        State {
            position: state.velocity,
            velocity: gravity + (state.rotation() * force + disturbance.force_n) / mass_kg,
            attitude: state.attitude * Quaternion::from_imag(state.rate) * 0.5,
            rate: (torque - state.rate.cross(&momentum)).component_div(&inertia_kg_m2),
            throttle: (target - state.throttle) / rotor_lag_s,
            charge_ah: self.current_a(state) / 3600.0,
        }
    }
}
