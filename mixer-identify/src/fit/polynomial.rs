//! Polynomials in both throttles, in floating point.
//!
//! The compiler's [`Bivariate`](mixer_compiler::model::polynomial::Bivariate) carries an interval
//! for each coefficient: it proves. These are for what only looks for a map, over many candidates,
//! or draws one; proofs come after.

use mixer_compiler::airframe::Basis;

/// A dense polynomial: `c[i][j]` multiplies u^i l^j.
#[derive(Debug, Clone)]
pub struct Polynomial {
    /// Coefficients, rows by the power of u.
    pub c: Vec<Vec<f64>>,
}

impl Polynomial {
    /// The polynomial of these coefficients, one per term of the basis.
    pub fn of(basis: Basis, coefficients: &[f64]) -> Self {
        let mut p = Polynomial::zero(4, 4);
        for (&(i, j), &c) in basis.exponents().iter().zip(coefficients) {
            p.c[usize::from(i)][usize::from(j)] = c;
        }
        p
    }

    /// The zero polynomial with room up to u^`du` l^`dl`.
    pub fn zero(du: usize, dl: usize) -> Self {
        Self {
            c: vec![vec![0.0; dl + 1]; du + 1],
        }
    }

    /// Value at (u, l), by Horner's rule.
    pub fn at(&self, u: f64, l: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |s, row| {
            s * u + row.iter().rev().fold(0.0, |t, &c| t * l + c)
        })
    }

    /// Partial derivative by u.
    pub fn du(&self) -> Polynomial {
        let c = self.c.iter().enumerate().skip(1);
        Polynomial {
            c: c.map(|(i, row)| row.iter().map(|&x| x * i as f64).collect())
                .collect(),
        }
    }

    /// Partial derivative by l.
    pub fn dl(&self) -> Polynomial {
        let rows = self.c.iter();
        Polynomial {
            c: rows
                .map(|r| r.iter().enumerate().skip(1).map(|(j, &x)| x * j as f64).collect())
                .collect(),
        }
    }

    /// The same polynomial with room up to u^`degree` l^`degree`, beyond which it must have no
    /// terms.
    pub fn resized(mut self, degree: usize) -> Polynomial {
        self.c.resize(degree + 1, Vec::new());
        self.c.iter_mut().for_each(|row| row.resize(degree + 1, 0.0));
        self
    }

    /// Product.
    pub fn times(&self, other: &Polynomial) -> Polynomial {
        let mut p = Polynomial::zero(
            self.c.len() + other.c.len() - 2,
            self.c[0].len() + other.c[0].len() - 2, // every polynomial here has at least one row
        );
        for (i, row) in self.c.iter().enumerate() {
            for (j, &a) in row.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                for (k, other_row) in other.c.iter().enumerate() {
                    for (m, &b) in other_row.iter().enumerate() {
                        p.c[i + k][j + m] += a * b;
                    }
                }
            }
        }
        p
    }

    /// `self` + `factor` * `other`.
    pub fn plus(&self, factor: f64, other: &Polynomial) -> Polynomial {
        let mut p = Polynomial::zero(
            self.c.len().max(other.c.len()) - 1,
            self.c[0].len().max(other.c[0].len()) - 1,
        );
        for (source, f) in [(self, 1.0), (other, factor)] {
            for (into, row) in p.c.iter_mut().zip(&source.c) {
                for (x, &c) in into.iter_mut().zip(row) {
                    *x += f * c;
                }
            }
        }
        p
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_and_products_agree_with_differences() {
        let coefficients: Vec<f64> = (1..=14).map(f64::from).collect();
        let p = Polynomial::of(Basis::Quartic, &coefficients);
        let (u, l, h) = (0.3, 0.7, 1e-6);
        assert!((p.du().at(u, l) - (p.at(u + h, l) - p.at(u - h, l)) / (2.0 * h)).abs() < 1e-6);
        assert!((p.dl().at(u, l) - (p.at(u, l + h) - p.at(u, l - h)) / (2.0 * h)).abs() < 1e-6);
        assert!((p.times(&p.du()).at(u, l) - p.at(u, l) * p.du().at(u, l)).abs() < 1e-9);
        let sum = p.du().plus(-2.0, &p);
        assert!((sum.at(u, l) - (p.du().at(u, l) - 2.0 * p.at(u, l))).abs() < 1e-12);
    }
}
