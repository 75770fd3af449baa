//! Fits of both throttles at once that keep the error of the *efforts* small.
//!
//! Where a fit is all there is, errors d = (du, dl) of the throttles miss the efforts by J d as far as they are
//! small. Thrust and torque bear each other's slack: fitted throttle by throttle, each with its own least maximum,
//! the efforts are missed by 10 to 30 % more. So the rows of J, in units of the tolerances, are the equations: two
//! per sample, linear in the coefficients of both throttles together, with a Lawson weight each.

use nalgebra::{DMatrix, DVector};

use super::Sample;

/// Relative size of what keeps coefficients of no influence at zero.
const RIDGE: f64 = 1e-13;

/// Share of the mean weight with which the knots of a table are held to straight lines: it decides where there are
/// no samples.
pub(super) const SMOOTH: f64 = 1e-9;

/// A fit without Newton steps.
pub(super) struct Joint<'a> {
    /// The terms' values, per sample.
    pub(super) rows: &'a [Vec<f64>],
    /// Throttles and efforts.
    pub(super) samples: &'a [Sample],
    /// Jacobians in units of the tolerances, per sample.
    pub(super) jacobians: &'a [[[f64; 2]; 2]],
    /// Combinations of coefficients, the same for both throttles, that should be zero.
    pub(super) smooth: &'a [Vec<f64>],
}

/// What became of a fit.
pub(super) struct Found {
    /// Coefficients of u and of l.
    pub(super) coefficients: [Vec<f64>; 2],
    /// Largest error over the samples.
    pub(super) error: f64,
    /// No coefficients have a smaller largest error, as far as errors are linear: the weighted root mean square.
    pub(super) floor: f64,
}

impl Joint<'_> {
    /// The best coefficients of `rounds` rounds of reweighting; fewer where no error below `hopeless` can come of
    /// them. `error` gives both errors of a sample for its fitted throttles.
    pub(super) fn fit(
        &self,
        rounds: usize,
        hopeless: f64,
        error: &dyn Fn(usize, [f64; 2]) -> [f64; 2],
    ) -> Found {
        let mut weights = vec![[1.0; 2]; self.rows.len()];
        let mut found = Found {
            coefficients: [Vec::new(), Vec::new()],
            error: f64::INFINITY,
            floor: 0.0,
        };
        for _ in 0..rounds {
            let coefficients = self.solve(&weights);
            let mut errors = Vec::with_capacity(self.rows.len());
            let (mut largest, mut squares, mut sum) = (0.0f64, 0.0, 0.0);
            for (index, row) in self.rows.iter().enumerate() {
                let fitted = [dot(row, &coefficients[0]), dot(row, &coefficients[1])];
                let missed = error(index, fitted);
                largest = largest.max(missed[0]).max(missed[1]);
                let [du, dl] = [0, 1].map(|k: usize| fitted[k] - self.samples[index].throttles[k]);
                for (weight, by) in weights[index].iter().zip(self.jacobians[index]) {
                    let linear = by[0] * du + by[1] * dl;
                    squares += weight * linear * linear;
                    sum += weight;
                }
                errors.push(missed);
            }
            found.floor = found.floor.max((squares / sum).sqrt());
            if largest < found.error {
                (found.coefficients, found.error) = (coefficients, largest);
            }
            if found.floor > hopeless {
                break;
            }
            let scale = 2.0 * self.rows.len() as f64 / sum;
            for (weights, errors) in weights.iter_mut().zip(&errors) {
                for (weight, error) in weights.iter_mut().zip(errors) {
                    *weight *= (error / largest + 1e-6) * scale;
                }
            }
        }
        found
    }

    /// Weighted least squares by the normal equations, scaled to a unit diagonal:
    /// `[A' m00 A, A' m01 A; A' m01 A, A' m11 A]` with the rows A and `m = J' w J` per sample.
    fn solve(&self, weights: &[[f64; 2]]) -> [Vec<f64>; 2] {
        let terms = self.rows[0].len();
        let mut blocks = [
            vec![0.0; terms * terms],
            vec![0.0; terms * terms],
            vec![0.0; terms * terms],
        ];
        let mut right = DVector::zeros(2 * terms);
        for (index, row) in self.rows.iter().enumerate() {
            let ([[fu, fl], [qu, ql]], [wf, wq]) = (self.jacobians[index], weights[index]);
            let metric = [
                wf * fu * fu + wq * qu * qu,
                wf * fu * fl + wq * qu * ql,
                wf * fl * fl + wq * ql * ql,
            ];
            let [u, l] = self.samples[index].throttles;
            let targets = [metric[0] * u + metric[1] * l, metric[1] * u + metric[2] * l];
            for (i, &term) in row.iter().enumerate() {
                if term != 0.0 {
                    right[i] += targets[0] * term;
                    right[terms + i] += targets[1] * term;
                }
            }
            accumulate(&mut blocks, row, metric);
        }
        let size = (0..terms).map(|i| blocks[0][i * terms + i]).sum::<f64>() / terms as f64;
        for row in self.smooth {
            accumulate(&mut blocks, row, [SMOOTH * size, 0.0, SMOOTH * size]);
        }
        let entry = |i: usize, j: usize| {
            let (block, i, j) = match (i < terms, j < terms) {
                (true, true) => (0, i, j),
                (false, false) => (2, i - terms, j - terms),
                (true, false) => (1, i, j - terms),
                (false, true) => (1, i - terms, j),
            };
            blocks[block][i.max(j) * terms + i.min(j)]
        };
        let scale: Vec<f64> = (0..2 * terms)
            .map(|i| 1.0 / entry(i, i).max(f64::MIN_POSITIVE).sqrt())
            .collect();
        let scaled = DMatrix::from_fn(2 * terms, 2 * terms, |i, j| {
            let ridge = if i == j { RIDGE } else { 0.0 };
            entry(i, j) * scale[i] * scale[j] + ridge
        });
        for (value, scale) in right.iter_mut().zip(&scale) {
            *value *= scale;
        }
        let Some(factors) = scaled.cholesky() else {
            return [vec![0.0; terms], vec![0.0; terms]];
        };
        factors.solve_mut(&mut right);
        let half = |from: usize| (from..from + terms).map(|i| right[i] * scale[i]).collect();
        [half(0), half(terms)]
    }
}

/// Adds a row's products, times each of the metric's numbers, to the lower triangles. (Plain loops: this is what a
/// build without optimisation spends its time on.)
fn accumulate(blocks: &mut [Vec<f64>; 3], row: &[f64], metric: [f64; 3]) {
    let terms = row.len();
    let [first, second, third] = blocks;
    let mut i = 0;
    while i < terms {
        let left = row[i];
        if left != 0.0 {
            let [a, b, c] = [metric[0] * left, metric[1] * left, metric[2] * left];
            let (mut j, mut at) = (0, i * terms);
            while j <= i {
                let right = row[j];
                first[at] += a * right;
                second[at] += b * right;
                third[at] += c * right;
                j += 1;
                at += 1;
            }
        }
        i += 1;
    }
}

/// The sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sum, mut i) = (0.0, 0);
    while i < a.len() {
        sum += a[i] * b[i];
        i += 1;
    }
    sum
}
