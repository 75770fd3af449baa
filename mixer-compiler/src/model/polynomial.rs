//! Polynomials of both throttles, and their sign over a box.
//!
//! On a box, a polynomial written in the Bernstein basis lies between its smallest and its largest
//! coefficient. Halving the box by de Casteljau's scheme makes those bounds converge quadratically,
//! so a sign is proven in a few halvings. Coefficients are intervals throughout: what is proven
//! holds in exact arithmetic.

use crate::bounds::interval::Interval;

/// A polynomial `sum c[i][j] u^i l^j` with as many coefficients in every row.
#[derive(Clone, Debug, PartialEq)]
pub struct Bivariate {
    coefficients: Vec<Vec<Interval>>,
}

/// A box of throttles, `[low, high]` for both rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrottleBox {
    /// Least throttle of both rotors.
    pub low: f64,
    /// Largest throttle of both rotors.
    pub high: f64,
}

/// Boxes looked at before giving up: enough to separate values of 1e-9 of the polynomial's size.
const MOST_BOXES: usize = 4096;

impl Bivariate {
    /// From terms `(exponent of u, exponent of l)` and their coefficients, taken as exact; one that
    /// is not finite may be any number, so that nothing is proven of it.
    pub(crate) fn from_terms(exponents: &[(u8, u8)], coefficients: &[f64]) -> Self {
        let most = |pick: fn(&(u8, u8)) -> u8| exponents.iter().map(pick).max().map_or(0, usize::from);
        let mut rows = vec![vec![Interval::ZERO; most(|e| e.1) + 1]; most(|e| e.0) + 1];
        for (&(i, j), &coefficient) in exponents.iter().zip(coefficients) {
            let slot = &mut rows[usize::from(i)][usize::from(j)];
            *slot = *slot
                + match coefficient.is_finite() {
                    true => Interval::exact(coefficient),
                    false => Interval {
                        low: f64::NEG_INFINITY,
                        high: f64::INFINITY,
                    },
                };
        }
        Bivariate { coefficients: rows }
    }

    fn degree_u(&self) -> usize {
        self.coefficients.len() - 1
    }

    fn degree_l(&self) -> usize {
        self.coefficients[0].len() - 1
    }

    /// The derivative by u.
    pub(crate) fn by_u(&self) -> Self {
        let mut rows: Vec<Vec<Interval>> = Vec::new();
        for (i, row) in self.coefficients.iter().enumerate().skip(1) {
            rows.push(row.iter().map(|&c| c * Interval::exact(i as f64)).collect());
        }
        if rows.is_empty() {
            rows.push(vec![Interval::ZERO; self.degree_l() + 1]);
        }
        Bivariate { coefficients: rows }
    }

    /// The derivative by l.
    pub(crate) fn by_l(&self) -> Self {
        self.transposed().by_u().transposed()
    }

    fn transposed(&self) -> Self {
        let columns = 0..=self.degree_l();
        let coefficients = columns
            .map(|j| self.coefficients.iter().map(|row| row[j]).collect())
            .collect();
        Bivariate { coefficients }
    }

    /// `self + factor * other`.
    pub(crate) fn plus(&self, factor: Interval, other: &Self) -> Self {
        let rows = self.degree_u().max(other.degree_u()) + 1;
        let columns = self.degree_l().max(other.degree_l()) + 1;
        let mut sum = vec![vec![Interval::ZERO; columns]; rows];
        for (i, row) in self.coefficients.iter().enumerate() {
            for (j, &c) in row.iter().enumerate() {
                sum[i][j] = sum[i][j] + c;
            }
        }
        for (i, row) in other.coefficients.iter().enumerate() {
            for (j, &c) in row.iter().enumerate() {
                sum[i][j] = sum[i][j] + factor * c;
            }
        }
        Bivariate { coefficients: sum }
    }

    /// The product with `other`.
    pub(crate) fn times(&self, other: &Self) -> Self {
        let rows = self.degree_u() + other.degree_u() + 1;
        let columns = self.degree_l() + other.degree_l() + 1;
        let mut product = vec![vec![Interval::ZERO; columns]; rows];
        for (i, row) in self.coefficients.iter().enumerate() {
            for (j, &a) in row.iter().enumerate() {
                for (k, other_row) in other.coefficients.iter().enumerate() {
                    for (m, &b) in other_row.iter().enumerate() {
                        product[i + k][j + m] = product[i + k][j + m] + a * b;
                    }
                }
            }
        }
        Bivariate {
            coefficients: product,
        }
    }

    /// An enclosure of the value at `(u, l)`.
    pub(crate) fn at(&self, [u, l]: [f64; 2]) -> Interval {
        let (u, l) = (Interval::exact(u), Interval::exact(l));
        self.coefficients.iter().rev().fold(Interval::ZERO, |value, row| {
            value * u + row.iter().rev().fold(Interval::ZERO, |value, &c| value * l + c)
        })
    }

    /// Proves that the polynomial is positive on the whole box: a lower bound of it, above 0.
    ///
    /// # Errors
    /// Throttles `(u, l)` where it is not positive, or around which it is neither proven nor refuted
    /// within the work allowed.
    pub(crate) fn prove_positive(&self, throttle: ThrottleBox) -> Result<f64, [f64; 2]> {
        let mut bound = f64::INFINITY;
        let mut open = vec![Patch {
            polynomial: self.bernstein(throttle),
            low: [throttle.low; 2],
            high: [throttle.high; 2],
        }];
        let mut looked_at = 0;
        while let Some(patch) = open.pop() {
            looked_at += 1;
            let coefficients = patch.polynomial.coefficients.iter().flatten();
            let least = coefficients.map(|c| c.low).fold(f64::INFINITY, f64::min);
            if least > 0.0 {
                bound = bound.min(least);
                continue;
            }
            let corners = patch.corners();
            if let Some(at) = corners.into_iter().find(|&at| self.at(at).is_not_positive()) {
                return Err(at);
            }
            if looked_at + open.len() >= MOST_BOXES {
                return Err(corners[0]);
            }
            open.extend(patch.halves());
        }
        Ok(bound)
    }

    /// An upper bound of the polynomial's magnitude on the box.
    pub(crate) fn largest_magnitude(&self, throttle: ThrottleBox) -> f64 {
        let bernstein = self.bernstein(throttle);
        let coefficients = bernstein.coefficients.iter().flatten();
        coefficients.fold(0.0, |most, c| most.max(c.magnitude()))
    }

    /// De Casteljau at one half on every row of Bernstein coefficients: those of both halves.
    fn split(self) -> [Self; 2] {
        let (first, second) = self
            .coefficients
            .into_iter()
            .map(|mut row| {
                let (mut first, mut second) = (Vec::new(), Vec::new());
                while let (Some(&left), Some(&right)) = (row.first(), row.last()) {
                    first.push(left);
                    second.push(right);
                    row = row.windows(2).map(|pair| (pair[0] + pair[1]).half()).collect();
                }
                second.reverse();
                (first, second)
            })
            .unzip();
        [first, second].map(|coefficients| Bivariate { coefficients })
    }

    /// Bernstein coefficients on the box.
    fn bernstein(&self, throttle: ThrottleBox) -> Self {
        let of_rows = |polynomial: &Self| Bivariate {
            coefficients: polynomial
                .coefficients
                .iter()
                .map(|row| univariate_bernstein(row, throttle))
                .collect(),
        };
        of_rows(&of_rows(self).transposed()).transposed()
    }
}

/// Bernstein coefficients on `[low, high]` of `sum c[i] x^i`: substitute `x = low + (high - low) t`
/// (Horner), then `b[k] = sum over i <= k of C(k, i) / C(n, i) c[i]`.
fn univariate_bernstein(coefficients: &[Interval], throttle: ThrottleBox) -> Vec<Interval> {
    let degree = coefficients.len() - 1;
    let low = Interval::exact(throttle.low);
    let width = Interval::exact(throttle.high) - low;
    let mut shifted = vec![Interval::ZERO; degree + 1];
    for &coefficient in coefficients.iter().rev() {
        for i in (0..=degree).rev() {
            let carried = if i > 0 {
                shifted[i - 1] * width
            } else {
                Interval::ZERO
            };
            shifted[i] = shifted[i] * low + carried;
        }
        shifted[0] = shifted[0] + coefficient;
    }
    (0..=degree)
        .map(|k| {
            (0..=k).fold(Interval::ZERO, |sum, i| {
                let (over, under) = (binomial(k, i), binomial(degree, i));
                let ratio = Interval {
                    low: (over / under).next_down(),
                    high: (over / under).next_up(),
                };
                let ratio = if over == under {
                    Interval::exact(1.0)
                } else {
                    ratio
                };
                sum + ratio * shifted[i]
            })
        })
        .collect()
}

/// Binomial coefficient, exact for the small degrees that occur here.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// A part of the box with its Bernstein coefficients `[in u][in l]`.
struct Patch {
    polynomial: Bivariate,
    low: [f64; 2],
    high: [f64; 2],
}

impl Patch {
    fn corners(&self) -> [[f64; 2]; 5] {
        let ([u0, l0], [u1, l1]) = (self.low, self.high);
        let middle = [0.5 * (u0 + u1), 0.5 * (l0 + l1)];
        [middle, [u0, l0], [u0, l1], [u1, l0], [u1, l1]]
    }

    /// Halves the longer side. The middle is a float; de Casteljau at one half is about the exact
    /// middle, which differs by rounding only, and corners are used for refutation, never for the
    /// proof.
    fn halves(self) -> [Patch; 2] {
        let Patch {
            polynomial,
            low,
            high,
        } = self;
        let along_u = high[0] - low[0] >= high[1] - low[1];
        let halves = match along_u {
            true => polynomial.transposed().split().map(|half| half.transposed()),
            false => polynomial.split(),
        };
        let (mut middle_high, mut middle_low) = (high, low);
        let axis = usize::from(!along_u);
        middle_high[axis] = 0.5 * (low[axis] + high[axis]);
        middle_low[axis] = middle_high[axis];
        let mut boxes = [(low, middle_high), (middle_low, high)].into_iter();
        halves.map(|polynomial| {
            let (low, high) = boxes.next().unwrap_or((low, high));
            Patch {
                polynomial,
                low,
                high,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: ThrottleBox = ThrottleBox { low: 0.0, high: 1.0 };

    #[test]
    fn signs_are_decided_on_both_sides_of_zero() {
        // (u - 1/2)^2 + (l - 1/4)^2 + c
        let bowl = |c: f64| {
            let exponents = [(2, 0), (1, 0), (0, 2), (0, 1), (0, 0)];
            Bivariate::from_terms(&exponents, &[1.0, -1.0, 1.0, -0.5, 0.3125 + c])
        };
        assert!(bowl(1e-4).prove_positive(BOX).is_ok_and(|bound| bound <= 1e-4));
        let [u, l] = bowl(-1e-4).prove_positive(BOX).unwrap_err();
        assert!((u - 0.5).abs() < 0.02 && (l - 0.25).abs() < 0.02);
        // A double zero that no corner of a halving hits exactly can be neither proven nor refuted.
        let thirds = Bivariate::from_terms(&[(2, 0), (1, 0), (0, 0)], &[9.0, -6.0, 1.0]);
        let [u, _] = thirds.prove_positive(BOX).unwrap_err();
        assert!((u - 1.0 / 3.0).abs() < 0.01);
    }

    #[test]
    fn a_coefficient_that_is_no_number_proves_nothing() {
        let line = |c: f64| Bivariate::from_terms(&[(1, 0), (0, 0)], &[c, 1.0]);
        let positive = |p: Bivariate| p.prove_positive(BOX).is_ok();
        for c in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!positive(line(c)) && !positive(line(c).times(&line(c))), "{c}");
        }
        assert!(positive(line(1e200).times(&line(1e200))), "overflow is no loss");
    }

    #[test]
    fn derivative_and_product_match_the_definition() {
        let p = Bivariate::from_terms(&[(2, 1), (0, 3), (1, 0)], &[2.0, -1.0, 0.5]);
        let q = Bivariate::from_terms(&[(0, 1), (1, 1)], &[3.0, 1.0]);
        let (u, l) = (0.75, 0.5);
        let close = |x: Interval, y: f64| assert!(x.low <= y + 1e-12 && x.high >= y - 1e-12, "{x:?} {y}");
        close(p.at([u, l]), 2.0 * u * u * l - l * l * l + 0.5 * u);
        close(p.by_u().at([u, l]), 4.0 * u * l + 0.5);
        close(p.by_l().at([u, l]), 2.0 * u * u - 3.0 * l * l);
        close(
            p.times(&q).at([u, l]),
            (2.0 * u * u * l - l * l * l + 0.5 * u) * (3.0 * l + u * l),
        );
        let (value_p, value_q) = (2.0 * u * u * l - l * l * l + 0.5 * u, 3.0 * l + u * l);
        close(
            p.plus(Interval::exact(-2.0), &q).at([u, l]),
            value_p - 2.0 * value_q,
        );
    }
}
