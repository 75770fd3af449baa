//! Weighted least squares towards the least maximal error.

use nalgebra::{DMatrix, DVector};

/// Rounds of reweighting.
pub(super) const ROUNDS: usize = 12;

/// Relative size below which a column adds nothing that f64 could tell from rounding.
const SINGULAR: f64 = 1e-13;

/// Linear fits of two targets in common terms.
pub(super) struct Lawson<'a> {
    /// The terms' values, per sample.
    pub(super) rows: &'a [Vec<f64>],
    /// What is to be met, per sample.
    pub(super) targets: &'a [[f64; 2]],
    /// True where errors are linear in the coefficients, false where they are quadratic.
    pub(super) direct: bool,
}

impl Lawson<'_> {
    /// The best coefficients found, per target, and their largest `error(sample, fitted targets)`.
    pub(super) fn fit(&self, rounds: usize, error: &dyn Fn(usize, [f64; 2]) -> f64) -> ([Vec<f64>; 2], f64) {
        let direct = self.direct;
        let mut weights = vec![1.0; self.rows.len()];
        let mut best = ([Vec::new(), Vec::new()], f64::INFINITY);
        for _ in 0..rounds {
            let coefficients = self.solve(&weights);
            let evaluate = |row: &[f64]| {
                let value = |c: &Vec<f64>| row.iter().zip(c).map(|(term, c)| term * c).sum::<f64>();
                [value(&coefficients[0]), value(&coefficients[1])]
            };
            let errors: Vec<f64> = self
                .rows
                .iter()
                .enumerate()
                .map(|(index, row)| error(index, evaluate(row)))
                .collect();
            let largest = errors.iter().fold(0.0f64, |largest, &e| largest.max(e));
            if largest < best.1 {
                best = (coefficients, largest);
            }
            // Lawson's factor is the error itself. Newton steps square the seed's error: its root then.
            let mut sum = 0.0;
            for (weight, error) in weights.iter_mut().zip(&errors) {
                let share = error / largest;
                *weight *= if direct { share } else { share.sqrt() } + 1e-3;
                sum += *weight;
            }
            let scale = weights.len() as f64 / sum;
            weights.iter_mut().for_each(|weight| *weight *= scale);
        }
        best
    }

    /// Weighted least squares by the normal equations, scaled to a unit diagonal. Their condition is the square of
    /// the terms'; coefficients that suffer from it are those that hardly matter, and what is emitted is checked
    /// point by point afterwards.
    fn solve(&self, weights: &[f64]) -> [Vec<f64>; 2] {
        let terms = self.rows[0].len();
        let mut normal = vec![0.0; terms * terms];
        let mut right = [vec![0.0; terms], vec![0.0; terms]];
        for ((row, target), &weight) in self.rows.iter().zip(self.targets).zip(weights) {
            for (i, &left) in row.iter().enumerate() {
                let weighted = weight * left;
                right[0][i] += weighted * target[0];
                right[1][i] += weighted * target[1];
                for (slot, &term) in normal[i * terms..].iter_mut().zip(&row[..=i]) {
                    *slot += weighted * term;
                }
            }
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
