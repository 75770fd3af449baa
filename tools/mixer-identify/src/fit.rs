//! Least squares of one channel, eq. (2) and (3) of the paper, and the statistics of Table I.
//!
//! With the centred basis' matrix A = Q R (Householder, faer) and p terms in n points: z = Q'y, R a
//! = z, coefficients theta = C a with the conversion C to monomials, residual e = y - A a, sigma2 =
//! e'e / (n - p), cov theta = sigma2 (C R^-1)(C R^-1)', 95 % interval = theta +- t(0.975, n - p)
//! sqrt(diag cov). The leverage of point i is h_i = |row i of Q|^2; left out, it would miss by e_i
//! / (1 - h_i). A prediction at (u, l) has the half-width t sigma sqrt(1 + |R^-T phi(u, l)|^2).

use std::collections::BTreeSet;

use faer::Mat;
use faer::linalg::solvers::Qr;
use mixer_compiler::airframe::Basis;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use self::basis::{Centred, ThrottleBox, monomials};
use crate::statistics::{dot, extent, greatest, rms, times};

pub mod balance;
pub mod basis;
pub mod cross;
pub mod fold;
pub(crate) mod normal;
pub mod pair;
pub mod polynomial;
pub mod power;
pub mod robust;
pub mod voltage;
pub mod wishes;

/// A design: where the points lie, in one basis. Both channels share it.
pub struct Design {
    /// The centred basis.
    pub centred: Centred,
    /// Orthonormal columns, points by terms.
    pub q: Vec<Vec<f64>>,
    /// R^-1, terms by terms, upper triangular.
    r_inverse: Vec<Vec<f64>>,
    /// C R^-1: from orthonormal coordinates to monomial coefficients.
    pub to_monomials: Vec<Vec<f64>>,
    points: Vec<[f64; 2]>,
}

/// Why a design cannot carry a basis.
#[derive(Debug, Clone, PartialEq)]
pub struct Deficient(pub String);

/// Distinct throttle pairs beyond the number of terms that a fit needs to judge itself.
const SPARE_PAIRS: usize = 4;
/// The standard error of the model, anywhere in the box, in units of the residual's standard
/// deviation, above which the points do not determine the map. A 10 x 10 grid has 0.7 at its
/// corners, a sweep along a line 50 and more.
const UNDETERMINED: f64 = 5.0;

impl Design {
    /// The design of `basis` at these throttles, to be used on `throttle_box`: refused where it
    /// would be a guess.
    pub fn new(basis: Basis, points: &[[f64; 2]], throttle_box: ThrottleBox) -> Result<Self, Deficient> {
        let design = Self::within_its_points(basis, points)?;
        let (factor, [u, l]) = design.worst_factor(throttle_box);
        if factor > UNDETERMINED {
            Err(Deficient(format!(
                "the points do not determine the map at (u, l) = ({u:.2}, {l:.2}): its standard error there is {factor:.0} \
                 times the residual's"
            )))
        } else {
            Ok(design)
        }
    }

    /// The design of `basis` at these throttles, to be used near them: only its rank is asked for.
    pub fn within_its_points(basis: Basis, points: &[[f64; 2]]) -> Result<Self, Deficient> {
        let terms = basis.exponents().len();
        let needed = terms + SPARE_PAIRS;
        let distinct = distinct_pairs(points);
        if distinct < needed {
            return Err(Deficient(format!(
                "{distinct} distinct throttle pairs, at least {needed} are needed"
            )));
        }
        let centred = Centred::new(basis, range(points));
        let rows: Vec<Vec<f64>> = points.iter().map(|&[u, l]| centred.values(u, l)).collect();
        let a = Mat::from_fn(rows.len(), terms, |i, j| rows[i][j]);
        let qr: Qr<f64> = a.qr();
        let (q, r) = (qr.compute_thin_Q(), qr.thin_R());
        let largest = (0..terms).map(|k| r[(k, k)].abs()).fold(0.0, f64::max);
        let degenerate = (0..terms).any(|k| r[(k, k)].abs() <= 1e-9 * largest);
        if degenerate {
            let reason = "the points lie on too few levels or on one line of the throttle square";
            return Err(Deficient(reason.into()));
        }
        let mut inverse = Mat::<f64>::identity(terms, terms);
        r.solve_upper_triangular_in_place(&mut inverse);
        let r_inverse: Vec<Vec<f64>> = (0..terms)
            .map(|i| (0..terms).map(|j| inverse[(i, j)]).collect())
            .collect();
        Ok(Self {
            to_monomials: product(&centred.to_monomials(), &r_inverse),
            q: (0..rows.len())
                .map(|i| (0..terms).map(|j| q[(i, j)]).collect())
                .collect(),
            points: points.to_vec(),
            r_inverse,
            centred,
        })
    }

    /// Standard error of the model at (u, l) in units of the residual's: |R^-T phi|.
    pub fn factor(&self, u: f64, l: f64) -> f64 {
        let phi = self.centred.values(u, l);
        let column = |k: usize| (0..=k).map(|i| self.r_inverse[i][k] * phi[i]).sum::<f64>();
        (0..phi.len()).map(|k| column(k) * column(k)).sum::<f64>().sqrt()
    }

    /// The largest factor, and the first place that has it: a symmetric sweep has two, between which
    /// rounding, different on every processor, would choose.
    fn worst_factor(&self, throttle_box: ThrottleBox) -> (f64, [f64; 2]) {
        const ALIKE: f64 = 1.0 + 1e-9;
        let places = throttle_box.square(20);
        places.fold((0.0, [0.0; 2]), |worst, [u, l]| {
            let factor = self.factor(u, l);
            if factor > ALIKE * worst.0 {
                (factor, [u, l])
            } else {
                worst
            }
        })
    }

    /// Q'y: the coordinates of the fit in the orthonormal columns.
    pub fn coordinates(&self, y: &[f64]) -> Vec<f64> {
        let terms = self.centred.basis.exponents().len();
        let along = |k| self.q.iter().zip(y).map(|(row, y)| row[k] * y).sum();
        (0..terms).map(along).collect()
    }

    /// Monomial coefficients of orthonormal coordinates.
    pub fn coefficients(&self, z: &[f64]) -> Vec<f64> {
        times(&self.to_monomials, z)
    }

    /// Measured less fitted, for orthonormal coordinates `z`.
    pub fn residuals(&self, y: &[f64], z: &[f64]) -> Vec<f64> {
        y.iter()
            .zip(times(&self.q, z))
            .map(|(y, fitted)| y - fitted)
            .collect()
    }

    /// 2-norm condition number of the matrix of raw monomials.
    pub fn condition_number(&self) -> f64 {
        let basis = self.centred.basis;
        let rows: Vec<Vec<f64>> = self.points.iter().map(|&[u, l]| monomials(basis, u, l)).collect();
        let matrix = Mat::from_fn(rows.len(), basis.exponents().len(), |i, j| rows[i][j]);
        match matrix.singular_values() {
            Ok(s) => {
                let [low, high] = extent(s.iter().copied());
                high / low
            }
            Err(_) => f64::INFINITY,
        }
    }

    /// Standard errors of the coefficients in units of the residual's standard deviation.
    pub fn standard_errors(&self) -> Vec<f64> {
        self.to_monomials.iter().map(|row| dot(row, row).sqrt()).collect()
    }

    /// Leverages h_i.
    pub fn leverages(&self) -> Vec<f64> {
        self.q.iter().map(|row| dot(row, row)).collect()
    }
}

/// Coefficients and statistics of one channel (thrust in N or torque in N m).
#[derive(Debug, Clone, Serialize)]
pub struct Fit {
    /// Coefficients in the order of the airframe file, rounded to ten digits.
    pub coefficients: Vec<f64>,
    /// Half-widths of their 95 % intervals.
    pub ci95: Vec<f64>,
    /// Coefficient of determination about the mean.
    pub r2: f64,
    /// Root of the mean squared residual over all points, N or N m.
    pub residual_rms: f64,
    /// Greatest absolute residual, N or N m.
    pub residual_max: f64,
    /// Root of the mean squared leave-one-out error, N or N m.
    pub leave_one_out_rms: f64,
    /// Greatest absolute measured value, N or N m: the scale of percentages.
    pub full_scale: f64,
    /// 2-norm condition number of the matrix of monomials.
    pub condition_number: f64,
    /// Points of the bench files that were fitted.
    pub points: usize,
    /// Points less terms.
    pub degrees_of_freedom: usize,
    /// 95 % prediction interval over the box.
    pub prediction: Prediction,
    /// Residuals, measured less fitted, in the order of the points.
    #[serde(skip)]
    pub residuals: Vec<f64>,
}

/// Half-width of the 95 % prediction interval of one new measurement.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Prediction {
    /// Least over the box.
    pub least: f64,
    /// Greatest over the box.
    pub greatest: f64,
    /// Throttles (u, l) where it is greatest.
    pub greatest_at: [f64; 2],
}

/// Root of the mean squared leave-one-out error of `y`.
pub fn leave_one_out(design: &Design, y: &[f64]) -> f64 {
    let z = design.coordinates(y);
    rms(left_out(design, &design.residuals(y, &z)))
}

fn left_out(design: &Design, residuals: &[f64]) -> Vec<f64> {
    let points = residuals.iter().zip(design.leverages());
    points.map(|(e, h)| e / (1.0 - h).max(1e-12)).collect()
}

/// Fits `y` on a design.
pub fn fit(design: &Design, y: &[f64], throttle_box: ThrottleBox) -> Fit {
    let z = design.coordinates(y);
    let n = y.len();
    let terms = design.centred.basis.exponents().len();
    let degrees_of_freedom = n - terms;
    let residuals = design.residuals(y, &z);
    let sse = dot(&residuals, &residuals);
    let mean = y.iter().sum::<f64>() / n as f64;
    let sst: f64 = y.iter().map(|y| (y - mean) * (y - mean)).sum();
    let sigma = (sse / degrees_of_freedom as f64).sqrt();
    let t = student_t_975(degrees_of_freedom);
    let half_width = |factor: f64| t * sigma * (1.0 + factor * factor).sqrt();
    let [least, _] = extent(throttle_box.square(20).map(|[u, l]| design.factor(u, l)));
    let (worst, greatest_at) = design.worst_factor(throttle_box);
    Fit {
        coefficients: design.coefficients(&z).into_iter().map(ten_digits).collect(),
        ci95: design.standard_errors().iter().map(|e| t * sigma * e).collect(),
        r2: if sst > 0.0 { 1.0 - sse / sst } else { 0.0 },
        residual_rms: (sse / n as f64).sqrt(),
        residual_max: greatest(&residuals),
        leave_one_out_rms: rms(left_out(design, &residuals)),
        full_scale: greatest(y),
        condition_number: design.condition_number(),
        points: n,
        degrees_of_freedom,
        prediction: Prediction {
            least: half_width(least),
            greatest: half_width(worst),
            greatest_at,
        },
        residuals,
    }
}

/// Rounds to ten significant digits: far below any bench's accuracy, and the bits of faer's
/// kernels, which vary with the processor, do not show in the file.
pub fn ten_digits(x: f64) -> f64 {
    format!("{x:.9e}").parse().unwrap_or(x)
}

/// Rounds to a hundredth.
pub fn hundredths(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

/// The 0.975 quantile of Student's t. The crate's bisection stops at a few digits; Newton steps on
/// its distribution function, which is accurate, finish it.
pub fn student_t_975(degrees_of_freedom: usize) -> f64 {
    use statrs::distribution::Continuous;
    let Ok(t) = StudentsT::new(0.0, 1.0, degrees_of_freedom.max(1) as f64) else {
        return f64::INFINITY;
    };
    (0..4).fold(t.inverse_cdf(0.975), |x, _| x - (t.cdf(x) - 0.975) / t.pdf(x))
}

/// Least and greatest throttle of each rotor.
pub fn range(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|rotor| extent(points.iter().map(|p| p[rotor])))
}

/// Number of throttle pairs that differ by more than a thousandth.
pub fn distinct_pairs(points: &[[f64; 2]]) -> usize {
    let keys = points.iter().map(|p| p.map(|t| (t * 1000.0).round() as i64));
    keys.collect::<BTreeSet<[i64; 2]>>().len()
}

fn product(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let columns = b.first().map_or(0, Vec::len);
    let entry = |row: &Vec<f64>, j: usize| row.iter().zip(b).map(|(x, r)| x * r[j]).sum();
    a.iter()
        .map(|row| (0..columns).map(|j| entry(row, j)).collect())
        .collect()
}

#[cfg(test)]
mod tests;
