//! The conventional mixer of the paper's section V: every rotor is taken as isolated.
//!
//! Its thrust is the upper rotor's alone, f(d, 0) = a d^2 + b d, its torque kappa f with kappa by least squares over
//! the throttle's range. Rotor k of unit i then contributes the column M_f,i -/+ kappa M_Q,i to the wrench (upper -,
//! lower +), a 4 x 2n matrix B; the thrusts are B^T (B B^T)^-1 u, and each throttle is the root of a d^2 + b d = f.
//! Voltage is corrected by the airframe's law, as in the coaxial mixer. `tests/oracle.py conventional` is the same
//! in Python.

use mixer_compiler::airframe::{Airframe, Throttle, Voltage};
use mixer_compiler::effectiveness::Effectiveness;
use mixer_compiler::model::PairMap;
use nalgebra::{DMatrix, SMatrix, SVector, Vector4};

use crate::vehicle::ROTORS;

/// Samples of the throttle's range for kappa.
const SAMPLES: u32 = 50;

/// The mixer: constants only.
#[derive(Clone, Debug)]
pub struct ConventionalMixer {
    /// B+, thrust per channel and wrench component.
    allocation: SMatrix<f64, ROTORS, 4>,
    /// [a, b] of f = a d^2 + b d, N.
    thrust_n: [f64; 2],
    throttle: Throttle,
    voltage: Option<Voltage>,
}

/// Why there is no conventional mixer for an airframe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsuited {
    /// It has not eight rotors.
    Rotors,
    /// A single rotor's thrust is not quadratic in its throttle: the basis is not biquadratic.
    Thrust,
    /// The rotors cannot produce all four axes.
    Rank,
}

impl std::fmt::Display for Unsuited {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Unsuited::Rotors => "the airframe has not eight rotors",
            Unsuited::Thrust => "the thrust of a single rotor is not quadratic in its throttle",
            Unsuited::Rank => "isolated rotors cannot produce all four axes",
        })
    }
}

impl std::error::Error for Unsuited {}

impl ConventionalMixer {
    /// The conventional mixer of `airframe` with effectiveness M.
    ///
    /// # Errors
    /// See [`Unsuited`].
    pub fn new(airframe: &Airframe, effectiveness: &Effectiveness) -> Result<Self, Unsuited> {
        if airframe.rotors() != ROTORS {
            return Err(Unsuited::Rotors);
        }
        let map = PairMap::new(&airframe.pair, &airframe.throttle);
        let coefficient = |powers: (u8, u8)| {
            let terms = airframe.pair.basis.exponents().iter();
            terms
                .zip(&airframe.pair.thrust_n)
                .find_map(|(term, &c)| (*term == powers).then_some(c))
        };
        let alone = |degree: u8| coefficient((degree, 0));
        let (Some(a), Some(b), None) = (alone(2), alone(1), alone(3)) else {
            return Err(Unsuited::Thrust);
        };
        let kappa = torque_per_thrust(&map);
        let mut rotors = DMatrix::zeros(4, ROTORS);
        for (i, unit) in airframe.units.iter().enumerate() {
            let by_thrust = effectiveness.matrix.column(i);
            let by_torque = effectiveness.matrix.column(airframe.units.len() + i) * kappa;
            rotors.set_column(unit.upper_channel, &(by_thrust - by_torque));
            rotors.set_column(unit.lower_channel, &(by_thrust + by_torque));
        }
        let gram = &rotors * rotors.transpose();
        let inverse = gram.try_inverse().ok_or(Unsuited::Rank)?;
        let allocation = rotors.transpose() * inverse;
        Ok(ConventionalMixer {
            allocation: SMatrix::from_fn(|i, j| allocation[(i, j)]),
            thrust_n: [a, b],
            throttle: airframe.throttle,
            voltage: airframe.voltage.clone(),
        })
    }

    /// The same mixer, its thrust commands multiplied by `factor`: what a controller does that knows, from an estimator
    /// or from a test flight, how much more than the weight it must command in hover.
    #[must_use]
    pub fn with_thrust_factor(mut self, factor: f64) -> Self {
        for rotor in 0..ROTORS {
            self.allocation[(rotor, 3)] *= factor;
        }
        self
    }

    /// Throttles for the wrench `[roll, pitch, yaw (N m), thrust (N)]` at `voltage_v`, limited to the range, and
    /// whether any was limited.
    pub fn mix(&self, wrench: &Vector4<f64>, voltage_v: f64) -> (SVector<f64, ROTORS>, bool) {
        let factor = self.voltage.as_ref().map_or(1.0, |law| {
            let [low, high] = law.range_v;
            law.thrust_factor(voltage_v.clamp(low, high))
        });
        let [a, b] = self.thrust_n;
        let wanted = (self.allocation * wrench / factor)
            .map(|f| ((b * b + 4.0 * a * f.max(0.0)).sqrt() - b) / (2.0 * a));
        let throttle = wanted.map(|d| d.clamp(self.throttle.min, self.throttle.max));
        (throttle, throttle != wanted)
    }
}

/// kappa of an isolated rotor, m: |Q(d, 0)| = kappa f(d, 0) by least squares over the throttle's range.
fn torque_per_thrust(map: &PairMap) -> f64 {
    let [low, high] = map.range();
    let (mut product, mut square) = (0.0, 0.0);
    for k in 0..=SAMPLES {
        let throttle = low + (high - low) * f64::from(k) / f64::from(SAMPLES);
        let [f, q] = map.efforts([throttle, 0.0]);
        product += f * q.abs();
        square += f * f;
    }
    product / square
}
