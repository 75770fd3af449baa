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

    /// The throttle, within the range, at which the parabola of the thrust at `throttle` has a thrust (N), and the torque
    /// (N m) there by its parabola. Thrust that is missing then has torque by the slope dQ/df at `throttle`.
    #[inline(always)]
    pub(crate) fn parabola(&self, range: &ThrottleRange, throttle: f32, thrust: f32) -> [f32; 2] {
        let [[f, q], [by_f, by_q], [half_f, half_q]] = self.expansion(throttle);
        let off = thrust - f;
        let root = sqrt(larger(by_f * by_f + 4.0 * half_f * off, 0.0));
        let next = range.clamp(throttle + divided(2.0 * off, larger(by_f + root, LEAST_RISE)));
        let step = next - throttle;
        let missing = off - (half_f * step + by_f) * step;
        let slope = divided(by_q, larger(by_f, LEAST_RISE));
        [next, q + (half_q * step + by_q) * step + slope * missing]
    }

    /// The throttle of a thrust (N), or the nearest one of the range.
    #[inline(never)]
    pub fn throttle(&self, range: &ThrottleRange, thrust: f32) -> f32 {
        let mut throttle = self.start(range, thrust);
        for _ in rolled(0..STEPS) {
            let [[f, _], [slope, _], _] = self.expansion(throttle);
            throttle = range.clamp(throttle + divided(thrust - f, larger(slope, LEAST_RISE)));
        }
        throttle
    }
}
