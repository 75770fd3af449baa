//! The basis in which a pair's map is solved for.
//!
//! Thrust and torque are sums of the monomials u^i l^j of a [`Basis`], which all vanish at rest. To
//! solve in, they are poor: on throttles from 0.4 to 0.95 they are nearly parallel (condition
//! number 1400 and more). The fit uses products of Legendre polynomials in the throttles centred on
//! and scaled to the measured box, phi_ij = P_i(x) P_j(y) less its value at u = l = 0. With (i, j)
//! over the same set as the monomials they span the same space: each set holds with (i, j) every
//! (i', j') below it, so phi_ij expands in it, and the subtraction removes the constant.

use mixer_compiler::airframe::Basis;
use mixer_compiler::model::polynomial;
use serde::Serialize;

/// The square of throttles in which the mixer commands both rotors, inside [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ThrottleBox {
    /// Idle of both rotors.
    pub min: f64,
    /// Full throttle of both rotors.
    pub max: f64,
}

impl ThrottleBox {
    /// `steps` + 1 equidistant throttles from idle to full.
    pub fn grid(self, steps: usize) -> impl Iterator<Item = f64> + Clone {
        (0..=steps).map(move |k| self.min + (self.max - self.min) * k as f64 / steps as f64)
    }

    /// [`ThrottleBox::grid`] of both throttles, by u.
    pub fn square(self, steps: usize) -> impl Iterator<Item = [f64; 2]> {
        let grid = self.grid(steps);
        grid.clone().flat_map(move |u| grid.clone().map(move |l| [u, l]))
    }
}

impl From<ThrottleBox> for polynomial::ThrottleBox {
    fn from(ThrottleBox { min, max }: ThrottleBox) -> Self {
        polynomial::ThrottleBox { low: min, high: max }
    }
}

/// The monomials of a basis at (u, l), in the order of its terms.
pub fn monomials(basis: Basis, u: f64, l: f64) -> Vec<f64> {
    let (pu, pl) = (powers(u), powers(l));
    let exponents = basis.exponents().iter();
    exponents
        .map(|&(i, j)| pu[usize::from(i)] * pl[usize::from(j)])
        .collect()
}

fn powers(x: f64) -> [f64; 5] {
    let x2 = x * x;
    [1.0, x, x2, x2 * x, x2 * x2]
}

/// The centred basis on a box of measured throttles, and its conversion to monomials.
#[derive(Debug, Clone)]
pub struct Centred {
    /// The monomials that it spans.
    pub basis: Basis,
    centre: [f64; 2],
    half: [f64; 2],
    offset: Vec<f64>,
}

impl Centred {
    /// `range` holds the least and the greatest measured throttle of the upper and of the lower
    /// rotor.
    pub fn new(basis: Basis, range: [[f64; 2]; 2]) -> Self {
        let centre = range.map(|[a, b]| 0.5 * (a + b));
        let half = range.map(|[a, b]| (0.5 * (b - a)).max(1e-9));
        let mut this = Self {
            basis,
            centre,
            half,
            offset: vec![0.0; basis.exponents().len()],
        };
        this.offset = this.values(0.0, 0.0);
        this
    }

    /// phi_ij at (u, l), in the order of the basis' terms.
    pub fn values(&self, u: f64, l: f64) -> Vec<f64> {
        let px = legendre_values((u - self.centre[0]) / self.half[0]);
        let py = legendre_values((l - self.centre[1]) / self.half[1]);
        let terms = self.basis.exponents().iter().zip(&self.offset);
        let phi = |(&(i, j), o): (&(u8, u8), &f64)| px[usize::from(i)] * py[usize::from(j)] - o;
        terms.map(phi).collect()
    }

    /// `matrix[m][k]`: coefficient of monomial m in phi_k.
    pub fn to_monomials(&self) -> Vec<Vec<f64>> {
        let one_variable = |d: usize| legendre_in_throttle(self.centre[d], self.half[d]);
        let (pu, pl) = (one_variable(0), one_variable(1));
        let exponents = || {
            let exponents = self.basis.exponents().iter();
            exponents.map(|&(i, j)| (usize::from(i), usize::from(j)))
        };
        let row = |(a, b): (usize, usize)| exponents().map(|(i, j)| pu[i][a] * pl[j][b]).collect();
        exponents().map(row).collect()
    }
}

/// P_0 .. P_4 at x, by the recurrence (n+1) P_(n+1) = (2n+1) x P_n - n P_(n-1).
fn legendre_values(x: f64) -> [f64; 5] {
    let mut p = [1.0, x, 0.0, 0.0, 0.0];
    for n in 1..4 {
        p[n + 1] = ((2 * n + 1) as f64 * x * p[n] - n as f64 * p[n - 1]) / (n + 1) as f64;
    }
    p
}

/// P_n((t - centre) / half) as coefficients of powers of t, by the same recurrence.
fn legendre_in_throttle(centre: f64, half: f64) -> [[f64; 5]; 5] {
    let mut p = [[0.0; 5]; 5];
    p[0][0] = 1.0;
    for n in 0..4 {
        for k in 0..5 {
            let shifted = if k > 0 { p[n][k - 1] } else { 0.0 };
            let x_times = (shifted - centre * p[n][k]) / half;
            let before = if n > 0 { p[n - 1][k] } else { 0.0 };
            p[n + 1][k] = ((2 * n + 1) as f64 * x_times - n as f64 * before) / (n + 1) as f64;
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centred_basis_spans_the_monomials() {
        for basis in Basis::ALL {
            let centred = Centred::new(basis, [[0.07, 0.95], [0.4, 0.9]]);
            let to = centred.to_monomials();
            for (u, l) in [(0.1, 0.2), (0.5, 0.8), (1.0, 0.0), (0.0, 0.0)] {
                let m = monomials(basis, u, l);
                for (k, phi) in centred.values(u, l).into_iter().enumerate() {
                    let sum: f64 = (0..m.len()).map(|r| to[r][k] * m[r]).sum();
                    assert!(
                        (phi - sum).abs() < 1e-9 * (1.0 + phi.abs()),
                        "{basis:?} term {k} at {u}, {l}"
                    );
                }
            }
        }
    }
}
