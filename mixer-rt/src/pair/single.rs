//! The curve of a rotor alone: of a single rotor, or of one whose partner is out.

use super::inverse::ThrottleRange;
use crate::{clamp, divided, divisor, larger, rolled, sqrt};

/// Least thrust per throttle that is divided by, N.
pub(crate) const LEAST_RISE: f32 = 1e-6;

/// Newton steps to the throttle of a thrust.
const STEPS: u32 = 4;

/// A rotor alone, the other one of its unit at rest: its thrust (N) and torque (N m, signed as on
/// the bench) as polynomials of its throttle without a constant, coefficients from the fourth
/// power down to the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleRotor {
    /// Of thrust.
    pub thrust: [f32; 4],
    /// Of torque.
    pub torque: [f32; 4],
}

impl SingleRotor {
    /// The efforts `[f, Q]` at a throttle, by Horner's rule.
    #[inline]
    pub fn efforts(&self, throttle: f32) -> [f32; 2] {
        let [value, ..] = self.expansion(throttle);
        value
    }

    /// The efforts `[f, Q]` at a throttle, their slopes, and half their second derivatives.
    #[inline(never)]
    pub(crate) fn expansion(&self, x: f32) -> [[f32; 2]; 3] {
        let [f, q] = [self.thrust, self.torque].map(|[a4, a3, a2, a1]| {
            let leading = x * a4;
            let (inner, inner_slope) = (leading + a3, a4);
            let (middle, slope) = (inner * x + a2, inner_slope * x + inner);
            let half = leading + slope;
            let (outer, outer_slope) = (middle * x + a1, slope * x + middle);
            [outer * x, outer_slope * x + outer, half * x + outer_slope]
        });
        [[f[0], q[0]], [f[1], q[1]], [f[2], q[2]]]
    }

    /// The throttle that has a thrust (N) where the thrust is in proportion to its square: where Newton's method begins.
    #[inline(always)]
    pub(crate) fn start(&self, range: &ThrottleRange, thrust: f32) -> f32 {
        let [most, _] = self.efforts(range.max);
        let share = clamp(divided(thrust, divisor(most)), 0.0, 1.0);
        range.clamp(range.max * sqrt(share))
    }

    /// A Newton step from a throttle towards a thrust (N), within the range, and the torque (N m) of that thrust along the
    /// tangent, also beyond the range.
    #[inline(always)]
    pub(crate) fn step(&self, range: &ThrottleRange, throttle: f32, thrust: f32) -> [f32; 2] {
        let [[f, q], [by_f, by_q], _] = self.expansion(throttle);
        let step = divided(thrust - f, larger(by_f, LEAST_RISE));
        [range.clamp(throttle + step), q + by_q * step]
    }

    /// The throttle of a thrust (N), or the nearest one of the range.
    #[inline(never)]
    pub fn throttle(&self, range: &ThrottleRange, thrust: f32) -> f32 {
        let mut throttle = self.start(range, thrust);
        for _ in rolled(0..STEPS) {
            [throttle, _] = self.step(range, throttle, thrust);
        }
        throttle
    }
}
