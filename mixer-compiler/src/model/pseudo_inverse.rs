//! The pseudo-inverse of least norm in shares of what each column can give, by eq. (7) of the paper.
//!
//! Rows of a layout mix N m with N, and columns N with N m. With D the sizes of the columns' efforts
//! and R such that the rows of A = R M D have length 1, all entries are shares:
//!
//! ```text
//! G = A A^T                  Gram matrix, unit diagonal
//! A+ = A^T G^-1              eq. (7)
//! A+ <- A+ + A+ (I - A A+)   once: the error is squared (Newton and Schulz)
//! M+ = D A+ R
//! ```
//!
//! eta = M+ u is the solution of M eta = u with the least |D^-1 eta|. G is factorised by Cholesky's
//! method, row by row: its k-th pivot is the sine of the angle between row k and the rows before it.
//! So one factorisation inverts, tells the rank and names the rows that depend on others. No
//! iteration has to converge. The result is checked all the same: [`PseudoInverse::residual`].

use nalgebra::{Cholesky, DMatrix, Dyn};

/// Sine of the angle below which a row counts as a combination of others: a frame is known to a
/// millimetre in a metre.
const INDEPENDENT: f64 = 1e-3;

/// Shares below this are the rounding of zeros: symmetric frames have sparse tables.
const ZERO: f64 = 1e-14;

/// The weighted pseudo-inverse D (M D)+ of the effectiveness M (m x k): of all efforts that give a
/// wrench it takes those of least norm |D^-1 eta|.
#[derive(Clone, Debug, PartialEq)]
pub struct PseudoInverse {
    /// k x m. A row per column of M, which is an effort (N or N m), a column per row of M, which is an
    /// axis of the wrench (N m or N): efforts per unit of wrench.
    pub matrix: DMatrix<f64>,
    /// |A| |A+| over the number of rows, in Frobenius norms: 1 where the rows of A are orthogonal.
    pub condition: f64,
    /// Largest entry of |A A+ - I| with A = M D, rows scaled to length 1; no unit.
    pub residual: f64,
}

impl PseudoInverse {
    /// The pseudo-inverse of `rows` (m x k, m of 1 or more), whose columns have efforts of the size
    /// `sizes` (k, each above 0).
    ///
    /// # Errors
    /// The indices of rows that depend on those before them, ascending.
    pub fn new(rows: &DMatrix<f64>, sizes: &[f64]) -> Result<Self, Vec<usize>> {
        let m = rows.nrows();
        let mut shares = rows.clone();
        for (mut column, size) in shares.column_iter_mut().zip(sizes) {
            column *= *size;
        }
        let lengths: Vec<f64> = shares.row_iter().map(|row| row.norm()).collect();
        for (mut row, length) in shares.row_iter_mut().zip(&lengths) {
            if *length > 0.0 {
                row /= *length;
            }
        }
        let gram = independent(&(&shares * shares.transpose()))?;
        let first = shares.transpose() * gram.inverse();
        let missing = |inverse: &DMatrix<f64>| DMatrix::identity(m, m) - &shares * inverse;
        let mut inverse = &first + &first * missing(&first);
        let zero = ZERO * inverse.amax();
        inverse.apply(|share| {
            if share.abs() < zero {
                *share = 0.0;
            }
        });
        let (condition, residual) = (
            shares.norm() * inverse.norm() / m as f64,
            missing(&inverse).amax(),
        );
        for (mut row, size) in inverse.row_iter_mut().zip(sizes) {
            row *= *size;
        }
        for (mut column, length) in inverse.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        Ok(PseudoInverse {
            matrix: inverse,
            condition,
            residual,
        })
    }
}

/// The factor of a Gram matrix with a unit diagonal.
///
/// # Errors
/// The indices of rows that depend on the independent ones before them.
fn independent(gram: &DMatrix<f64>) -> Result<Cholesky<f64, Dyn>, Vec<usize>> {
    let (mut kept, mut dependent, mut factor) = (Vec::new(), Vec::new(), None);
    for row in 0..gram.nrows() {
        kept.push(row);
        let part = gram.select_rows(&kept).select_columns(&kept);
        match Cholesky::new(part) {
            Some(found) if found.l_dirty()[(kept.len() - 1, kept.len() - 1)] > INDEPENDENT => {
                factor = Some(found)
            }
            _ => dependent.extend(kept.pop()),
        }
    }
    factor.filter(|_| dependent.is_empty()).ok_or(dependent)
}
