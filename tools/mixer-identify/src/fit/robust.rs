//! Rows that stand out, and the fit without them.
//!
//! Least squares bends towards a wrong row and spreads its error over its neighbours, so outliers
//! are judged by a robust fit: iteratively reweighted least squares, first with Huber's weights
//! min(1, 1.345/|z|), which find the neighbourhood, then with Tukey's (1 - (z/4.685)2)2, which
//! forget the outliers (constants for 95 % efficiency at normal errors). z is the residual over the
//! scale 1.4826 median |e|.
//!
//! A row suspected by the stiff cubic may only show that the map is richer than a cubic. So
//! suspects are judged once more in the basis that is finally used, against its fit to all other
//! rows.
//!
//! `--robust` leaves the named rows out and fits the rest by least squares, so that every statistic
//! keeps its meaning.

use mixer_compiler::airframe::Basis;
use serde::Serialize;

use crate::fit::Design;
use crate::fit::polynomial::Polynomial;
use crate::statistics::greatest;

/// Rows stand out from this many robust standard deviations on. A polynomial's lack of fit alone
/// reaches five on clean bench maps; rows of a faulty run have ten to fifty.
const STANDS_OUT: f64 = 6.0;
/// ... and if they also miss by more than this part of full scale: on data without noise any
/// residual is many standard deviations.
const NEGLIGIBLE: f64 = 0.005;

/// A row that stands out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlier {
    /// File name.
    pub file: String,
    /// Line in it, from 1.
    pub line: u64,
    /// Throttle of the upper rotor.
    pub u: f64,
    /// Throttle of the lower rotor.
    pub l: f64,
    /// Measured less the fit to the other rows, N.
    pub thrust_residual: f64,
    /// The same in standard deviations of a prediction there.
    pub thrust_deviations: f64,
    /// The same, N m.
    pub torque_residual: f64,
    /// The same in standard deviations of a prediction there.
    pub torque_deviations: f64,
}

impl Outlier {
    /// Whether it is this row.
    pub fn is(&self, file: &str, line: u64) -> bool {
        self.file == file && self.line == line
    }
}

/// Whether a row of this residual stands out of a channel.
pub fn stands_out(residual: f64, deviations: f64, full_scale: f64) -> bool {
    deviations.abs() > STANDS_OUT && residual.abs() > NEGLIGIBLE * full_scale
}

/// Residuals of suspects against a fit without them, in standard deviations of a prediction there:
/// (y - fitted) / (sigma sqrt(1 + h)). `clean` is the design of the other rows, `y_clean` their
/// values.
pub fn against_the_others(clean: &Design, y_clean: &[f64], suspects: &[([f64; 2], f64)]) -> Vec<(f64, f64)> {
    let z = clean.coordinates(y_clean);
    let terms = clean.centred.basis.exponents().len();
    let scale = robust_scale(&clean.residuals(y_clean, &z), terms, greatest(y_clean));
    let polynomial = Polynomial::of(clean.centred.basis, &clean.coefficients(&z));
    let miss = |&([u, l], y): &([f64; 2], f64)| {
        let residual = y - polynomial.at(u, l);
        let factor = clean.factor(u, l);
        (residual, residual / (scale * (1.0 + factor * factor).sqrt()))
    };
    suspects.iter().map(miss).collect()
}

/// Which values stand out of a robust fit of `y` on the design's orthonormal columns.
pub fn judge(design: &Design, y: &[f64]) -> Vec<bool> {
    let full_scale = greatest(y);
    let terms = design.centred.basis.exponents().len();
    let mut residuals = design.residuals(y, &design.coordinates(y));
    let huber = |z: f64| if z.abs() <= 1.345 { 1.0 } else { 1.345 / z.abs() };
    let tukey = |z: f64| {
        let w = 1.0 - (z / 4.685) * (z / 4.685);
        if z.abs() < 4.685 { w * w } else { 0.0 }
    };
    for weight_of in [&huber as &dyn Fn(f64) -> f64, &tukey] {
        for _ in 0..50 {
            let scale = robust_scale(&residuals, terms, full_scale);
            let weights: Vec<f64> = residuals.iter().map(|e| weight_of(e / scale)).collect();
            let Some(z) = weighted(design, y, &weights) else {
                break;
            };
            let next = design.residuals(y, &z);
            let moves = next.iter().zip(&residuals).map(|(a, b)| (a - b).abs());
            let moved = moves.fold(0.0, f64::max);
            residuals = next;
            if moved < 1e-3 * scale {
                break;
            }
        }
    }
    let scale = robust_scale(&residuals, terms, full_scale);
    let judged = residuals.iter().map(|e| stands_out(*e, e / scale, full_scale));
    judged.collect()
}

/// 1.4826 times the median of the |e| beyond the p that a fit of p terms can make vanish.
fn robust_scale(residuals: &[f64], terms: usize, full_scale: f64) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|e| e.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let middle = (terms + sizes.len()) / 2;
    (1.4826 * sizes[middle.min(sizes.len() - 1)])
        .max(1e-12 * full_scale)
        .max(f64::MIN_POSITIVE)
}

/// Weighted least squares in orthonormal coordinates; nothing if the weights leave the system
/// singular.
fn weighted(design: &Design, y: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
    use faer::linalg::solvers::SolveLstsq;
    let terms = design.centred.basis.exponents().len();
    let root: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
    let a = faer::Mat::from_fn(y.len(), terms, |i, j| root[i] * design.q[i][j]);
    let b = faer::Mat::from_fn(y.len(), 1, |i, _| root[i] * y[i]);
    let z = a.qr().solve_lstsq(&b);
    let z: Vec<f64> = (0..terms).map(|k| z[(k, 0)]).collect();
    z.iter().all(|x| x.is_finite()).then_some(z)
}

/// The basis by which rows are judged when the user leaves the choice open: stiff enough not to
/// bend to three rows in a hundred, true enough to full-range maps.
pub const JUDGING: Basis = Basis::Cubic;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::basis::ThrottleBox;

    #[test]
    fn a_tenth_of_wrong_rows_is_found_and_no_right_one() {
        let level = |k: usize| 0.1 + 0.09 * k as f64;
        let points: Vec<[f64; 2]> = (0..100).map(|k| [level(k / 10), level(k % 10)]).collect();
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let mut y: Vec<f64> = points
            .iter()
            .enumerate()
            .map(|(k, p)| 20.0 * p[0] * p[0] + 15.0 * p[1] + 0.2 * noise(k))
            .collect();
        let wrong = [7, 19, 23, 38, 41, 56, 62, 75, 84, 93];
        wrong.iter().for_each(|&k| y[k] += 5.0);
        let design =
            Design::new(Basis::Cubic, &points, ThrottleBox { min: 0.1, max: 0.91 }).expect("a design");
        let judged = judge(&design, &y);
        let found: Vec<usize> = (0..100).filter(|&i| judged[i]).collect();
        assert_eq!(found, wrong);
    }
}
