//! The curve that a single rotor leaves its unit.

use crate::arithmetic::Scalar;
use crate::divisor;
use crate::pair::inverse::ThrottleRange;

/// Newton steps that invert a single rotor's thrust. The start is exact for a thrust that grows
/// with the square of the throttle, which bench maps follow to a few percent.
const STEPS: usize = 3;

/// The least rise of a thrust that is divided by, N: a thrust that does not grow with its throttle
/// takes the step to the end of the range.
const LEAST_RISE: f32 = 1e-6;

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
        let value =
            |[a4, a3, a2, a1]: [f32; 4]| (((throttle * a4 + a3) * throttle + a2) * throttle + a1) * throttle;
        [value(self.thrust), value(self.torque)]
    }

    /// The thrust at a throttle and its slope. The thrust has the bits of [`SingleRotor::efforts`].
    #[inline]
    fn thrust_and_slope(&self, x: f32) -> [f32; 2] {
        let [a4, a3, a2, a1] = self.thrust;
        let leading = x * a4;
        let inner = leading + a3;
        let (outer, outer_slope) = (inner * x + a2, leading + inner);
        let (value, slope) = (outer * x + a1, outer_slope * x + outer);
        [value * x, slope * x + value]
    }

    /// The throttle within the range at which the rotor gives the thrust `f` (N): Newton's method, each
    /// step limited to the range. Where the thrust does not rise with the throttle it is a throttle near
    /// there, so that what it gives is to be read off the curve.
    #[inline(never)]
    pub(crate) fn invert(&self, range: &ThrottleRange, f: f32) -> f32 {
        let [least, most] = [range.min, range.max].map(|throttle| self.efforts(throttle)[0]);
        let (low, high) = (range.min * range.min, range.max * range.max);
        let span = most - least;
        let share = if span > LEAST_RISE {
            (f - least) / divisor(span)
        } else {
            0.0
        };
        let square = low + share * (high - low);
        let mut throttle = range.clamp(square.root());
        for _ in 0..STEPS {
            let [value, slope] = self.thrust_and_slope(throttle);
            let slope = if slope > LEAST_RISE { slope } else { LEAST_RISE };
            throttle = range.clamp(throttle + (f - value) / slope);
        }
        throttle
    }
}
