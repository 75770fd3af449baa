//! A quantity of the pair, expanded about the centre of a cell.
//!
//! The quantities are polynomials, so Taylor's formula is exact: with the coefficients p_ij of the
//! offsets from the centre, every derivative is known over the cell and around it. For a point t
//! and a step v the part of the quantity that a linear model misses is
//!
//! ```text
//! G(t; v) = F(t + v) - F(t) - J(t) v = sum over i + j >= 2 of F^(i,j)(t) / (i! j!) vu^i vl^j
//! ```

use super::taylor::Taylor;
use crate::airframe::{Basis, POWERS};

/// Coefficients by exponents of u and l, and their largest exponents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Monomials {
    coefficients: [[f64; POWERS]; POWERS],
    degree: [usize; 2],
    /// Sum of absolute coefficients.
    size: f64,
}

impl Monomials {
    /// A quantity of the airframe file.
    pub(super) fn new(basis: Basis, terms: &[f64]) -> Self {
        let mut coefficients = [[0.0; POWERS]; POWERS];
        let mut degree = [0; 2];
        let mut size = 0.0;
        for (&(i, j), &term) in basis.exponents().iter().zip(terms) {
            let [i, j] = [i, j].map(usize::from);
            coefficients[i][j] = term;
            degree = [degree[0].max(i), degree[1].max(j)];
            size += term.abs();
        }
        Monomials {
            coefficients,
            degree,
            size,
        }
    }
}

/// See the module.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expansion {
    /// Coefficients of (u - centre)^i (l - centre)^j.
    p: [[f64; POWERS]; POWERS],
    degree: [usize; 2],
    half: [f64; 2],
    /// Bound of the rounding in any value or derivative read from here: each coefficient is a sum
    /// of products built in at most 16 operations, throttles are at most 1, cells at most one half,
    /// and the binomial coefficients of degree 4 sum up to less than 2^8.
    slack: f64,
}

/// Second derivatives `[F_uu / 2, F_ul, F_ll / 2]` around a cell, each as centre and radius, and
/// the higher terms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curvature {
    centre: [f64; 3],
    radius: [f64; 3],
    /// Bounds of the higher coefficients, by exponents.
    higher: [[f64; POWERS]; POWERS],
}

const BINOMIAL: [[f64; POWERS]; POWERS] = {
    let mut rows = [[0.0; POWERS]; POWERS];
    let mut n = 0;
    while n < POWERS {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// Makes up for the rounding of sums of non-negative terms.
const UP: f64 = 1.0 + 256.0 * f64::EPSILON;

impl Expansion {
    /// About the cell `centre` +- `half`, inside [0, 1].
    pub(super) fn new(monomials: &Monomials, centre: [f64; 2], half: [f64; 2]) -> Self {
        let (mut p, degree) = (monomials.coefficients, monomials.degree);
        for row in p.iter_mut().take(degree[0] + 1) {
            for start in 0..degree[1] {
                for j in (start..degree[1]).rev() {
                    row[j] += centre[1] * row[j + 1];
                }
            }
        }
        for start in 0..degree[0] {
            for i in (start..degree[0]).rev() {
                let above = p[i + 1];
                for (value, above) in p[i].iter_mut().zip(above) {
                    *value += centre[0] * above;
                }
            }
        }
        Expansion {
            p,
            degree,
            half,
            slack: monomials.size * 4096.0 * f64::EPSILON,
        }
    }

    /// The quantity over the cell.
    pub(super) fn value(&self) -> Taylor {
        self.derivative([0, 0])
    }

    /// The derivatives by u and by l over the cell.
    pub(super) fn gradient(&self) -> [Taylor; 2] {
        [self.derivative([1, 0]), self.derivative([0, 1])]
    }

    /// The derivative of the given orders, each 0 or 1, over the cell.
    fn derivative(&self, order: [usize; 2]) -> Taylor {
        let [hu, hl] = self.half;
        let [du, dl] = order;
        let mut low = [[0.0; 3]; 3];
        let mut rest = self.slack;
        let (mut size_u, mut factor_u) = (1.0, 1.0);
        for i in du..=self.degree[0] {
            let (mut size, mut factor) = (size_u, factor_u);
            for j in dl..=self.degree[1] {
                let term = self.p[i][j] * size * factor;
                if i - du + j - dl <= 2 {
                    low[i - du][j - dl] = term;
                } else {
                    rest += term.abs();
                }
                size *= hl;
                factor = if dl == 1 { (j + 1) as f64 } else { 1.0 } * factor_u;
            }
            size_u *= hu;
            factor_u = if du == 1 { (i + 1) as f64 } else { 1.0 };
        }
        let coefficients = [low[0][0], low[1][0], low[0][1], low[2][0], low[1][1], low[0][2]];
        Taylor::new(coefficients, rest * UP)
    }

    /// The second derivatives and the higher terms within `reach` of the centre.
    pub(super) fn curvature(&self, reach: [f64; 2]) -> Curvature {
        let mut curvature = Curvature {
            centre: [0.0; 3],
            radius: [0.0; 3],
            higher: [[0.0; POWERS]; POWERS],
        };
        for i in 0..=self.degree[0] {
            for j in 0..=self.degree[1] {
                if i + j < 2 {
                    continue;
                }
                let [centre, radius] = self.coefficient([i, j], reach);
                if i + j == 2 {
                    (curvature.centre[j], curvature.radius[j]) = (centre, radius);
                } else {
                    curvature.higher[i][j] = centre.abs() + radius;
                }
            }
        }
        curvature
    }

    /// Bounds of the absolute derivatives by u and by l within `reach` of the centre.
    pub(super) fn slopes(&self, reach: [f64; 2]) -> [f64; 2] {
        [[1, 0], [0, 1]].map(|order| {
            let [centre, radius] = self.coefficient(order, reach);
            centre.abs() + radius
        })
    }

    /// F^(i,j) / (i! j!) within `reach` of the centre: its value there and how far it may go from
    /// it.
    fn coefficient(&self, [i, j]: [usize; 2], reach: [f64; 2]) -> [f64; 2] {
        let mut radius = self.slack;
        let mut size_u = 1.0;
        for (m, (row, binomials)) in self.p.iter().zip(&BINOMIAL).enumerate().skip(i) {
            if m > self.degree[0] {
                break;
            }
            let mut size = size_u * binomials[i];
            for n in j..=self.degree[1] {
                if m > i || n > j {
                    radius += row[n].abs() * size * BINOMIAL[n][j];
                }
                size *= reach[1];
            }
            size_u *= reach[0];
        }
        [self.p[i][j], radius * UP]
    }
}

/// Powers of two functions up to the fourth total degree, `[exponent of the first][of the second]`.
pub(super) type Powers = [[Taylor; POWERS]; POWERS];

/// Products of `v` up to the total degree `degree`.
pub(super) fn powers(v: &[Taylor; 2], degree: usize) -> Powers {
    let mut powers = [[Taylor::exact(0.0); POWERS]; POWERS];
    powers[0][0] = Taylor::exact(1.0);
    for total in 1..=degree {
        for i in 0..=total {
            let j = total - i;
            powers[i][j] = match (i, j) {
                (1, 0) => v[0],
                (0, 1) => v[1],
                (_, 0) => powers[i - 1][0].product(&v[0]),
                _ => powers[i][j - 1].product(&v[1]),
            };
        }
    }
    powers
}

/// F^(i,j)(t) / (i! j!) for i + j >= 2 as functions over the cell, by exponents; `None` where they
/// vanish.
pub(super) type Derivatives = [[Option<Taylor>; POWERS]; POWERS];

impl Expansion {
    /// The higher derivatives at a point t; `offset` are the [`powers`] of its distance from the
    /// centre, of the second degree at least.
    pub(super) fn derivatives(&self, offset: &Powers) -> Derivatives {
        let mut derivatives = [[None; POWERS]; POWERS];
        for (i, row) in derivatives.iter_mut().enumerate().take(self.degree[0] + 1) {
            for (j, slot) in row.iter_mut().enumerate().take(self.degree[1] + 1) {
                if i + j < 2 {
                    continue;
                }
                let mut sum = Taylor::ball(self.slack);
                let mut present = false;
                for m in i..=self.degree[0] {
                    for n in j..=self.degree[1] {
                        let factor = self.p[m][n] * (BINOMIAL[m][i] * BINOMIAL[n][j]);
                        if factor != 0.0 {
                            present = true;
                            let radius = factor.abs() * f64::EPSILON;
                            sum = sum.plus(&offset[m - i][n - j].times(factor, radius));
                        }
                    }
                }
                *slot = present.then_some(sum);
            }
        }
        derivatives
    }
}

/// G(t; v) from the derivatives at t and the [`powers`] of v of the fourth degree.
pub(super) fn beyond_linear(derivatives: &Derivatives, v: &Powers) -> Taylor {
    let mut sum = Taylor::exact(0.0);
    for (derivatives, v) in derivatives.iter().zip(v) {
        for (derivative, v) in derivatives.iter().zip(v) {
            if let Some(derivative) = derivative {
                sum = sum.plus(&derivative.product(v));
            }
        }
    }
    sum
}

impl Curvature {
    /// True where the bounds of [`Curvature::remainder`] say little of an offset of this `size`:
    /// what they leave open does not shrink with the cell.
    pub(super) fn is_vague(&self, size: [f64; 2]) -> bool {
        const SHARE: f64 = 0.03;
        let squares = [size[0] * size[0], size[0] * size[1], size[1] * size[1]];
        let (mut known, mut open) = (0.0, self.higher_terms(size));
        for ((square, centre), radius) in squares.iter().zip(&self.centre).zip(&self.radius) {
            known += centre.abs() * square;
            open += radius * square;
        }
        open > SHARE * known
    }

    /// G(t; v) for t within reach of the centre. `squares` are vu2, vu vl, vl2 and `size` bounds
    /// |vu|, |vl|.
    pub(super) fn remainder(&self, squares: &[Taylor; 3], size: [f64; 2]) -> Taylor {
        let mut sum = Taylor::ball(self.higher_terms(size));
        for ((square, &centre), &radius) in squares.iter().zip(&self.centre).zip(&self.radius) {
            sum = sum.plus(&square.times(centre, radius));
        }
        sum
    }

    fn higher_terms(&self, [size_u, size_l]: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        let mut power_u = 1.0;
        for row in &self.higher {
            let mut power = power_u;
            for bound in row {
                sum += bound * power;
                power *= size_l;
            }
            power_u *= size_u;
        }
        sum * UP
    }

    /// How far the quantity may lie from a straight line over an offset v along one axis: F'' v2 /
    /// 8.
    pub(super) fn bend(&self, axis: usize, v: f64) -> f64 {
        let half = self.centre[2 * axis].abs() + self.radius[2 * axis];
        0.25 * half * v * v * UP
    }
}
