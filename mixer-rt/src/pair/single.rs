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
}
