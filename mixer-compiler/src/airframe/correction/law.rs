//! How thrust and torque follow a measured quantity x, the battery's voltage or the air's density:
//! f = k_f(x) f(u, l), Q = k_Q(x) Q(u, l), with k = 1 at the bench's x.

/// A law k(x) for thrust or torque.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// k = (x / reference)^e.
    Exponent(f64),
    /// (x, k) by ascending x, joined by straight lines.
    Points(Vec<[f64; 2]>),
}

impl Law {
    /// k at `x`, dimensionless. Beyond the points of [`Law::Points`], k of the nearest.
    pub(crate) fn factor(&self, x: f64, reference: f64) -> f64 {
        match self {
            Law::Exponent(exponent) => libm::pow(x / reference, *exponent),
            Law::Points(points) => between_points(points, x),
        }
    }
}

fn between_points(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= x);
    match (
        after.checked_sub(1).map(|before| points[before]),
        points.get(after),
    ) {
        (Some([x0, k0]), Some([x1, k1])) => k0 + (k1 - k0) * ((x - x0) / (x1 - x0)),
        (Some([_, k]), None) | (None, Some(&[_, k])) => k,
        (None, None) => 1.0,
    }
}

/// The correction of thrust and torque for one measured quantity: voltage in V, or density in kg/m3.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Correction {
    /// The quantity on the bench, within the range.
    pub reference: f64,
    /// Its least and largest value in flight: 0.1 <= least < largest, at most 1000 V or 2 kg/m3. Beyond
    /// it the mixer clamps and flags.
    pub range: [f64; 2],
    /// Law of the thrust, positive over the range (k >= 1e-3), 1 within 1e-3 at the reference.
    pub thrust: Law,
    /// Law of the torque, likewise.
    pub torque: Law,
}

impl Correction {
    /// A correction that was not read from a file.
    #[cfg(test)]
    pub(crate) fn of(reference: f64, range: [f64; 2], [thrust, torque]: [Law; 2]) -> Self {
        Correction {
            reference,
            range,
            thrust,
            torque,
        }
    }

    /// k_f at `x`, dimensionless.
    pub fn thrust_factor(&self, x: f64) -> f64 {
        self.thrust.factor(x, self.reference)
    }

    /// k_Q at `x`, dimensionless.
    pub fn torque_factor(&self, x: f64) -> f64 {
        self.torque.factor(x, self.reference)
    }

    /// `[k_f, k_Q]` at `x`.
    pub fn factors(&self, x: f64) -> [f64; 2] {
        [self.thrust_factor(x), self.torque_factor(x)]
    }

    /// Exponents `[of thrust, of torque]`. Points have that of least squares over the range, which
    /// is of ln k over ln (x / reference).
    pub fn exponents(&self) -> [f64; 2] {
        [&self.thrust, &self.torque].map(|law| match law {
            Law::Exponent(exponent) => *exponent,
            Law::Points(_) => {
                let [low, high] = self.range;
                let (mut products, mut squares) = (0.0, 0.0);
                for step in 0..=SAMPLES {
                    let x = low + (high - low) * f64::from(step) / f64::from(SAMPLES);
                    let along = libm::log(x / self.reference);
                    products += along * libm::log(law.factor(x, self.reference));
                    squares += along * along;
                }
                products / squares
            }
        })
    }
}

/// Steps of the range to which the exponent of points is fitted.
const SAMPLES: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_give_their_factors() {
        let reference = 14.8;
        assert_eq!(Law::Exponent(2.0).factor(29.6, reference), 4.0);
        let points = Law::Points(vec![[10.0, 0.5], [14.0, 1.0], [15.0, 2.0]]);
        assert_eq!(
            [9.0, 10.0, 12.0, 14.0, 14.5, 15.0, 16.0].map(|v| points.factor(v, reference)),
            [0.5, 0.5, 0.75, 1.0, 1.5, 2.0, 2.0]
        );
    }

    #[test]
    fn points_of_a_power_have_its_exponent() {
        let of = |k: f64| {
            let points = (0..=40).map(|i| 12.8 + 0.1 * f64::from(i));
            Law::Points(points.map(|v| [v, libm::pow(v / 14.8, k)]).collect())
        };
        let correction = Correction::of(14.8, [12.8, 16.8], [of(1.62), Law::Exponent(1.9)]);
        let [thrust, torque] = correction.exponents();
        assert!((thrust - 1.62).abs() < 1e-4 && torque == 1.9, "{thrust} {torque}");
    }
}
