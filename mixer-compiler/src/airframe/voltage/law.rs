//! How thrust and torque follow the supply voltage: f(V) = k_f(V) f, Q(V) = k_Q(V) Q, with k = 1 at
//! the reference voltage.

/// A law k(V) for thrust or torque.
#[derive(Clone, Debug, PartialEq)]
pub enum VoltageLaw {
    /// k = (V / Vref)^e.
    Exponent(f64),
    /// (V, k) by ascending V, joined by straight lines.
    Points(Vec<[f64; 2]>),
}

impl VoltageLaw {
    /// k at `volts`, dimensionless. Beyond the points of [`VoltageLaw::Points`], k of the nearest.
    pub(crate) fn factor(&self, volts: f64, reference_v: f64) -> f64 {
        match self {
            VoltageLaw::Exponent(exponent) => libm::pow(volts / reference_v, *exponent),
            VoltageLaw::Points(points) => between_points(points, volts),
        }
    }
}

fn between_points(points: &[[f64; 2]], volts: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= volts);
    match (
        after.checked_sub(1).map(|before| points[before]),
        points.get(after),
    ) {
        (Some([v0, k0]), Some([v1, k1])) => k0 + (k1 - k0) * ((volts - v0) / (v1 - v0)),
        (Some([_, k]), None) | (None, Some(&[_, k])) => k,
        (None, None) => 1.0,
    }
}

/// The supply and its effect.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Voltage {
    /// Voltage of the bench model, V, within the range.
    pub reference_v: f64,
    /// Lowest and highest voltage in flight, V, 0.1 <= lowest < highest <= 1000. Beyond it the
    /// mixer clamps and flags.
    pub range_v: [f64; 2],
    /// Law of the thrust, positive over the range (k >= 1e-3), 1 within 1e-3 at the reference.
    pub thrust: VoltageLaw,
    /// Law of the torque, likewise.
    pub torque: VoltageLaw,
}

impl Voltage {
    /// k_f at `volts`, dimensionless.
    pub fn thrust_factor(&self, volts: f64) -> f64 {
        self.thrust.factor(volts, self.reference_v)
    }

    /// k_Q at `volts`, dimensionless.
    pub fn torque_factor(&self, volts: f64) -> f64 {
        self.torque.factor(volts, self.reference_v)
    }

    /// `[k_f, k_Q]` at `volts`.
    pub fn factors(&self, volts: f64) -> [f64; 2] {
        [self.thrust_factor(volts), self.torque_factor(volts)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_give_their_factors() {
        let reference = 14.8;
        assert_eq!(VoltageLaw::Exponent(2.0).factor(29.6, reference), 4.0);
        let points = VoltageLaw::Points(vec![[10.0, 0.5], [14.0, 1.0], [15.0, 2.0]]);
        assert_eq!(
            [9.0, 10.0, 12.0, 14.0, 14.5, 15.0, 16.0].map(|v| points.factor(v, reference)),
            [0.5, 0.5, 0.75, 1.0, 1.5, 2.0, 2.0]
        );
    }
}
