//! A rotor alone: a single rotor, or one whose partner is out.

use super::inverse::ThrottleRange;
use crate::{divided, larger, sqrt};

/// Least thrust per throttle that is divided by, N.
pub(crate) const LEAST_RISE: f32 = 1e-6;

/// A rotor alone, the other one of its unit at rest: its thrust (N) and torque (N m, signed as on
/// the bench) as polynomials of its throttle without a constant, coefficients from the fourth
/// power down to the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorAlone {
    /// Of thrust.
    pub thrust: [f32; 4],
    /// Of torque.
    pub torque: [f32; 4],
}

impl RotorAlone {
    /// That of a rotor that does not exist.
    pub(crate) const NOTHING: RotorAlone = RotorAlone {
        thrust: [0.0; 4],
        torque: [0.0; 4],
    };

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

    /// About the throttle of a thrust (N), within the range: that of the parabola in its middle.
    #[inline(never)]
    pub(crate) fn throttle(&self, range: &ThrottleRange, thrust: f32) -> f32 {
        let middle = 0.5 * (range.min + range.max);
        let [[f, _], [slope, _], [half, _]] = self.expansion(middle);
        let off = thrust - f;
        let root = sqrt(larger(slope * slope + 4.0 * half * off, 0.0));
        range.clamp(middle + divided(2.0 * off, larger(slope + root, LEAST_RISE)))
    }
}
