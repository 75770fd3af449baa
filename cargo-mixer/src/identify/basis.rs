//! The three polynomial bases of a pair's map, and polynomials in both throttles.
//!
//! Thrust and torque are sums of monomials u^i l^j that all vanish at rest, eq. (1) of the paper:
//!
//! * biquadratic: i, j <= 2, 8 terms; * cubic: i + j <= 3, 9 terms; * quartic: i + j <= 4, 14 terms.
//!
//! Monomials are a poor basis to solve in: on throttles from 0.4 to 0.95 they are nearly parallel (condition number
//! 1400 and more). The fit uses products of Legendre polynomials in the throttles centred on and scaled to the
//! measured box, phi_ij = P_i(x) P_j(y) less its value at u = l = 0. With (i, j) over the same set as the monomials
//! they span the same space: each set holds with (i, j) every (i', j') below it, so phi_ij expands in it, and the
//! subtraction removes the constant.

use serde::Serialize;

/// Which monomials describe the pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// Eq. (1) of the paper: u2l2, u2l, u2, ul2, ul, u, l2, l.
    Biquadratic,
    /// Total degree 3: u3, u2l, ul2, l3, u2, ul, l2, u, l.
    Cubic,
    /// Total degree 4: u4, u3l, u2l2, ul3, l4, then the cubic's terms.
    Quartic,
}

const BIQUADRATIC: [(usize, usize); 8] = [(2, 2), (2, 1), (2, 0), (1, 2), (1, 1), (1, 0), (0, 2), (0, 1)];
const QUARTIC: [(usize, usize); 14] = [
    (4, 0),
    (3, 1),
    (2, 2),
    (1, 3),
    (0, 4),
    (3, 0),
    (2, 1),
    (1, 2),
    (0, 3),
    (2, 0),
    (1, 1),
    (0, 2),
    (1, 0),
    (0, 1),
];

impl Basis {
    /// All bases, fewest terms first.
    pub const ALL: [Basis; 3] = [Basis::Biquadratic, Basis::Cubic, Basis::Quartic];

    /// The exponents (of u, of l) in the order of the airframe file's coefficients.
    pub fn exponents(self) -> &'static [(usize, usize)] {
        match self {
            Basis::Biquadratic => &BIQUADRATIC,
            Basis::Cubic => &QUARTIC[5..],
            Basis::Quartic => &QUARTIC,
        }
    }

    /// Number of terms: 8, 9 or 14.
    pub fn terms(self) -> usize {
        self.exponents().len()
    }

    /// Greatest power of u, and of l, in det J = f_u Q_l - f_l Q_u.
    pub fn determinant_degree(self) -> usize {
        match self {
            Basis::Biquadratic => 3, // (1, 2) and (2, 1) multiplied
            Basis::Cubic => 4,       // twice the total degree of a derivative
            Basis::Quartic => 6,
        }
    }

    /// The airframe file's word for the basis.
    pub fn name(self) -> &'static str {
        match self {
            Basis::Biquadratic => "biquadratic",
            Basis::Cubic => "cubic",
            Basis::Quartic => "quartic",
        }
    }

    /// The airframe file's name of each term, such as `u2l`.
    pub fn term_names(self) -> Vec<String> {
        let power = |letter: &str, e: usize| match e {
            0 => String::new(),
            1 => letter.to_string(),
            _ => format!("{letter}{e}"),
        };
        self.exponents()
            .iter()
            .map(|&(i, j)| power("u", i) + &power("l", j))
            .collect()
    }

    /// The monomials at (u, l).
    pub fn monomials(self, u: f64, l: f64) -> Vec<f64> {
        let (pu, pl) = (powers(u), powers(l));
        self.exponents().iter().map(|&(i, j)| pu[i] * pl[j]).collect()
    }

    /// The polynomial with these coefficients.
    pub fn polynomial(self, coefficients: &[f64]) -> Polynomial {
        let mut p = Polynomial::zero(4, 4);
        for (&(i, j), &c) in self.exponents().iter().zip(coefficients) {
            p.c[i][j] = c;
        }
        p
    }
}

fn powers(x: f64) -> [f64; 5] {
    let x2 = x * x;
    [1.0, x, x2, x2 * x, x2 * x2]
}

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
}

/// A dense polynomial: `c[i][j]` multiplies u^i l^j.
#[derive(Debug, Clone)]
pub struct Polynomial {
    /// Coefficients, rows by the power of u.
    pub c: Vec<Vec<f64>>,
}

impl Polynomial {
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

    /// The polynomial of the coefficients' absolute values.
    pub fn sizes(&self) -> Polynomial {
        Polynomial {
            c: self
                .c
                .iter()
                .map(|row| row.iter().map(|x| x.abs()).collect())
                .collect(),
        }
    }

    /// The same polynomial with room up to u^`degree` l^`degree`, beyond which it must have no terms.
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
    /// `range` holds the least and the greatest measured throttle of the upper and of the lower rotor.
    pub fn new(basis: Basis, range: [[f64; 2]; 2]) -> Self {
        let centre = range.map(|[a, b]| 0.5 * (a + b));
        let half = range.map(|[a, b]| (0.5 * (b - a)).max(1e-9));
        let mut this = Self {
            basis,
            centre,
            half,
            offset: vec![0.0; basis.terms()],
        };
        this.offset = this.values(0.0, 0.0);
        this
    }

    /// phi_ij at (u, l), in the order of the basis' terms.
    pub fn values(&self, u: f64, l: f64) -> Vec<f64> {
        let px = legendre_values((u - self.centre[0]) / self.half[0]);
        let py = legendre_values((l - self.centre[1]) / self.half[1]);
        let terms = self.basis.exponents().iter().zip(&self.offset);
        terms.map(|(&(i, j), &o)| px[i] * py[j] - o).collect()
    }

    /// `matrix[m][k]`: coefficient of monomial m in phi_k.
    pub fn to_monomials(&self) -> Vec<Vec<f64>> {
        let one_variable = |d: usize| legendre_in_throttle(self.centre[d], self.half[d]);
        let (pu, pl) = (one_variable(0), one_variable(1));
        let exponents = self.basis.exponents();
        let row = |&(a, b): &(usize, usize)| exponents.iter().map(|&(i, j)| pu[i][a] * pl[j][b]).collect();
        exponents.iter().map(row).collect()
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
                let m = basis.monomials(u, l);
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

    #[test]
    fn terms_are_in_the_file_order() {
        assert_eq!(
            Basis::Biquadratic.term_names().join(" "),
            "u2l2 u2l u2 ul2 ul u l2 l"
        );
        assert_eq!(Basis::Cubic.term_names().join(" "), "u3 u2l ul2 l3 u2 ul l2 u l");
        assert_eq!(
            Basis::Quartic.term_names().join(" "),
            "u4 u3l u2l2 ul3 l4 u3 u2l ul2 l3 u2 ul l2 u l"
        );
    }

    #[test]
    fn derivatives_and_products_agree_with_differences() {
        let coefficients: Vec<f64> = (1..=14).map(f64::from).collect();
        let p = Basis::Quartic.polynomial(&coefficients);
        let (u, l, h) = (0.3, 0.7, 1e-6);
        assert!((p.du().at(u, l) - (p.at(u + h, l) - p.at(u - h, l)) / (2.0 * h)).abs() < 1e-6);
        assert!((p.dl().at(u, l) - (p.at(u, l + h) - p.at(u, l - h)) / (2.0 * h)).abs() < 1e-6);
        assert!((p.times(&p.du()).at(u, l) - p.at(u, l) * p.du().at(u, l)).abs() < 1e-9);
        let sum = p.du().plus(-2.0, &p);
        assert!((sum.at(u, l) - (p.du().at(u, l) - 2.0 * p.at(u, l))).abs() < 1e-12);
    }
}
