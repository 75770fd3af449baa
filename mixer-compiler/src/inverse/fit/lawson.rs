//! Weighted least squares of the throttles towards the least maximal error after Newton steps.

use nalgebra::{DMatrix, DVector};

/// Rounds of reweighting.
pub(super) const ROUNDS: usize = 12;

/// Relative size below which a column adds nothing that f64 could tell from rounding.
const SINGULAR: f64 = 1e-13;

/// Rounds after which a fit that is far off is given up.
pub(super) const PATIENCE: usize = 4;

/// Linear fits of two targets in common terms.
pub(super) struct Lawson<'a> {
    /// The terms' values, per sample.
    pub(super) rows: &'a [Vec<f64>],
    /// What is to be met, per sample.
    pub(super) targets: &'a [[f64; 2]],
    /// The weights of the first round.
    pub(super) weights: Vec<f64>,
    /// True where Newton steps follow, which square the error.
    pub(super) is_refined: bool,
}

impl Lawson<'_> {
    /// The best coefficients found, per target, and their largest `error(sample, fitted targets)`.
    /// Errors of more than `hopeless` after a few rounds end the fit.
    pub(super) fn fit(
        &self,
        rounds: usize,
        hopeless: f64,
        error: &dyn Fn(usize, [f64; 2]) -> f64,
    ) -> ([Vec<f64>; 2], f64) {
        let mut weights = self.weights.clone();
        let mut best = ([Vec::new(), Vec::new()], f64::INFINITY);
        for round in 0..rounds {
            let coefficients = self.solve(&weights);
            let mut errors = Vec::with_capacity(self.rows.len());
            let mut largest = 0.0f64;
            for (index, row) in self.rows.iter().enumerate() {
                let error = error(index, [dot(row, &coefficients[0]), dot(row, &coefficients[1])]);
                largest = largest.max(error);
                errors.push(error);
            }
            if largest < best.1 {
                best = (coefficients, largest);
            }
            if round + 1 >= PATIENCE && best.1 > hopeless {
                break;
            }
            // Lawson's factor is the error itself. Newton steps square the seed's error: its root
            // then.
            let mut sum = 0.0;
            for (weight, error) in weights.iter_mut().zip(&errors) {
                let share = error / largest;
                let factor = if self.is_refined { share.sqrt() } else { share };
                *weight *= factor + 1e-3;
                sum += *weight;
            }
            let scale = weights.len() as f64 / sum;
            for weight in &mut weights {
                *weight *= scale;
            }
        }
        best
    }

    /// Weighted least squares by the normal equations, scaled to a unit diagonal. Their condition
    /// is the square of the terms'; coefficients that suffer from it are those that hardly matter,
    /// and what is emitted is checked point by point afterwards.
    fn solve(&self, weights: &[f64]) -> [Vec<f64>; 2] {
        let terms = self.rows[0].len();
        let mut normal = vec![0.0; terms * terms];
        let mut right = [vec![0.0; terms], vec![0.0; terms]];
        for (index, row) in self.rows.iter().enumerate() {
            let (target, weight) = (self.targets[index], weights[index]);
            for (i, &term) in row.iter().enumerate() {
                right[0][i] += weight * term * target[0];
                right[1][i] += weight * term * target[1];
            }
            accumulate(&mut normal, terms, row, weight);
        }
        let scale: Vec<f64> = (0..terms)
            .map(|i| 1.0 / normal[i * terms + i].max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let scaled = DMatrix::from_fn(terms, terms, |i, j| {
            let (low, high) = if i < j { (i, j) } else { (j, i) };
            let ridge = if i == j { SINGULAR } else { 0.0 };
            normal[high * terms + low] * scale[i] * scale[j] + ridge
        });
        let factors = scaled.cholesky();
        right.map(|right| match &factors {
            Some(factors) => {
                let solution = factors.solve(&DVector::from_fn(terms, |i, _| right[i] * scale[i]));
                solution.iter().zip(&scale).map(|(x, scale)| x * scale).collect()
            }
            None => vec![0.0; terms],
        })
    }
}

/// Adds a row's products, weighted, to the lower triangle. (Plain loops: this is what a build
/// without optimisation spends its time on.)
fn accumulate(normal: &mut [f64], terms: usize, row: &[f64], weight: f64) {
    let mut i = 0;
    while i < terms {
        let weighted = weight * row[i];
        if weighted != 0.0 {
            let (mut j, mut at) = (0, i * terms);
            while j <= i {
                normal[at] += weighted * row[j];
                j += 1;
                at += 1;
            }
        }
        i += 1;
    }
}

/// The sum of products.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sum, mut i) = (0.0, 0);
    while i < a.len() {
        sum += a[i] * b[i];
        i += 1;
    }
    sum
}
