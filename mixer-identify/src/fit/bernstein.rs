//! Bernstein coefficients of a polynomial on a rectangle.
//!
//! Row by row and column by column those of one variable. A polynomial lies between its least and
//! its greatest Bernstein coefficient, and the corner coefficients are its corner values. The
//! compiler's [`Bivariate`](mixer_compiler::model::polynomial::Bivariate) proves a sign by them;
//! here they are what a programme constrains, so that they are linear in the polynomial and in
//! floating point.

use mixer_compiler::bounds::bernstein::coefficients as one_variable;

use crate::fit::polynomial::Polynomial;

/// A rectangle of throttles: [least, greatest] of u and of l.
pub type Cell = [[f64; 2]; 2];

/// Coefficients `b[i][j]` on the cell, of as many rows and columns as the polynomial has.
pub fn coefficients(p: &Polynomial, cell: Cell) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = p.c.iter().map(|row| one_variable(row, cell[1])).collect();
    let columns = rows[0].len();
    let mut out = vec![vec![0.0; columns]; rows.len()];
    for j in 0..columns {
        let column: Vec<f64> = rows.iter().map(|row| row[j]).collect();
        for (i, b) in one_variable(&column, cell[0]).into_iter().enumerate() {
            out[i][j] = b;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use mixer_compiler::airframe::Basis;

    #[test]
    fn corners_are_values_and_coefficients_enclose() {
        let p = Polynomial::of(
            Basis::Quartic,
            &(0..14).map(|k| ((k * 37) % 11) as f64 - 5.0).collect::<Vec<_>>(),
        );
        let cell = [[0.1, 0.7], [0.3, 0.95]];
        let b = coefficients(&p, cell);
        let n = b.len() - 1;
        for (i, j, u, l) in [
            (0, 0, 0.1, 0.3),
            (n, 0, 0.7, 0.3),
            (0, n, 0.1, 0.95),
            (n, n, 0.7, 0.95),
        ] {
            assert!((b[i][j] - p.at(u, l)).abs() < 1e-12);
        }
        let all = b.iter().flatten();
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(x, y), &c| (x.min(c), y.max(c)));
        for k in 0..=20 {
            for m in 0..=20 {
                let value = p.at(0.1 + 0.03 * k as f64, 0.3 + 0.0325 * m as f64);
                assert!((low - 1e-12..=high + 1e-12).contains(&value));
            }
        }
    }
}
