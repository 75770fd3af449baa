//! Least squares of few unknowns by the normal equations (Cholesky), in plain arithmetic: the same
//! bits on every machine.

/// The x that minimises |A x - y|, A by rows; `None` where its columns are dependent.
pub(crate) fn solve(rows: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
    let n = rows.first()?.len();
    let product = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let mut l = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let rest = product(i, j) - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i != j {
                l[i][j] = rest / l[j][j];
            } else if rest > 1e-13 * product(i, i) {
                l[i][i] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    let mut x: Vec<f64> = (0..n)
        .map(|i| rows.iter().zip(y).map(|(row, y)| row[i] * y).sum())
        .collect();
    for i in 0..n {
        let known: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - known) / l[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - known) / l[i][i];
    }
    Some(x)
}
