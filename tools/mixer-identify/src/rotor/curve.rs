//! Thrust and torque of one rotor alone over its throttle: c1 x + c2 x^2 + c3 x^3 that grows over
//! [0, 1].
//!
//! In Bernstein form, b1 3x(1-x)^2 + b2 3x^2(1-x) + b3 x^3, the curve grows if 0 <= b1 <= b2 <= b3.
//! Increments d1 = b1, d2 = b2 - b1, d3 = b3 - b2 are then free but for their sign, and the least
//! squares under d >= 0 are those of the best subset of them: there are seven. So a table of five
//! rows from half throttle on, whose plain cubic would swing below zero, has a curve, too.

use serde::Serialize;

use crate::fit::normal::solve;

/// c1, c2, c3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Curve(pub [f64; 3]);

/// One rotor alone: thrust (N) and size of the torque (N m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotor {
    /// Thrust, N.
    pub thrust: Curve,
    /// Size of the torque, N m.
    pub torque: Curve,
}

impl Curve {
    /// The value at a throttle.
    pub fn at(&self, x: f64) -> f64 {
        let Curve([c1, c2, c3]) = self;
        ((c3 * x + c2) * x + c1) * x
    }

    /// Multiplied by a number.
    #[must_use]
    pub fn times(&self, factor: f64) -> Curve {
        Curve(self.0.map(|c| factor * c))
    }

    /// The growing curve nearest to the points `[x, y]` with y > 0 on the whole; `None` where no
    /// growing curve fits better than zero.
    pub fn fit(points: &[[f64; 2]]) -> Option<Curve> {
        let mut best: Option<(f64, [f64; 3])> = None;
        for subset in 1..8_usize {
            let used: Vec<usize> = (0..3).filter(|k| subset >> k & 1 == 1).collect();
            let row = |[x, _]: &[f64; 2]| used.iter().map(|&k| increments(*x)[k]).collect();
            let rows: Vec<Vec<f64>> = points.iter().map(row).collect();
            let values: Vec<f64> = points.iter().map(|[_, y]| *y).collect();
            let found = solve(&rows, &values).filter(|found| found.iter().all(|d| *d >= 0.0));
            let Some(found) = found else { continue };
            let mut increment = [0.0; 3];
            for (&k, d) in used.iter().zip(&found) {
                increment[k] = *d;
            }
            let missed = |[x, y]: &[f64; 2]| {
                let value: f64 = increments(*x).iter().zip(increment).map(|(b, d)| b * d).sum();
                (value - y) * (value - y)
            };
            let squares: f64 = points.iter().map(missed).sum();
            if best.is_none_or(|(least, _)| squares < least) {
                best = Some((squares, increment));
            }
        }
        let (_, [d1, d2, d3]) = best?;
        let [b1, b2, b3] = [d1, d1 + d2, d1 + d2 + d3];
        Some(Curve([3.0 * b1, 3.0 * b2 - 6.0 * b1, 3.0 * b1 - 3.0 * b2 + b3]))
    }
}

/// What a unit of each increment adds at x.
fn increments(x: f64) -> [f64; 3] {
    let y = 1.0 - x;
    let [b1, b2, b3] = [3.0 * x * y * y, 3.0 * x * x * y, x * x * x];
    [b1 + b2 + b3, b2 + b3, b3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_growing_cubic_comes_back() {
        let truth = Curve([1.0, 8.0, -2.0]);
        let points: Vec<[f64; 2]> = (1..=9)
            .map(|k| 0.1 * f64::from(k))
            .map(|x| [x, truth.at(x)])
            .collect();
        let found = Curve::fit(&points).expect("a curve");
        for (a, b) in found.0.iter().zip(truth.0) {
            assert!((a - b).abs() < 1e-8, "{found:?}");
        }
    }

    #[test]
    fn every_curve_grows_from_zero() {
        // From half throttle on, and bent so that a plain cubic swings below zero.
        let points = [[0.5, 4.0], [0.65, 8.2], [0.75, 10.1], [0.85, 11.5], [0.95, 12.0]];
        let found = Curve::fit(&points).expect("a curve");
        let values: Vec<f64> = (0..=100).map(|k| found.at(0.01 * f64::from(k))).collect();
        assert!(values.windows(2).all(|v| v[1] >= v[0] - 1e-12), "{found:?}");
        assert!(
            points.iter().all(|[x, y]| (found.at(*x) - y).abs() < 1.5),
            "{found:?}"
        );
        assert!(Curve::fit(&[[0.5, -1.0], [0.9, -2.0]]).is_none());
    }
}
