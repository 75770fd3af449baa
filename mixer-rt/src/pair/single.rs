//! The curve that a single rotor leaves its unit.

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
    pub(super) fn thrust_and_slope(&self, x: f32) -> [f32; 2] {
        let [a4, a3, a2, a1] = self.thrust;
        let leading = x * a4;
        let inner = leading + a3;
        let (outer, outer_slope) = (inner * x + a2, leading + inner);
        let (value, slope) = (outer * x + a1, outer_slope * x + outer);
        [value * x, slope * x + value]
    }
}
