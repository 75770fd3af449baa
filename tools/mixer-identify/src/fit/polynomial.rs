//! A polynomial in both throttles, of one channel, in floating point. Both channels and their slopes
//! are the compiler's [`PairMap`](mixer_compiler::model::PairMap); what is proven of them its
//! [`EnclosedPairMap`](mixer_compiler::model::injectivity::EnclosedPairMap).

use mixer_compiler::airframe::Basis;

/// `c[i][j]` multiplies u^i l^j.
#[derive(Debug, Clone)]
pub struct Polynomial {
    c: [[f64; 5]; 5],
}

impl Polynomial {
    /// The polynomial of these coefficients, one per term of the basis.
    pub fn of(basis: Basis, coefficients: &[f64]) -> Self {
        let mut c = [[0.0; 5]; 5];
        for (&(i, j), &value) in basis.exponents().iter().zip(coefficients) {
            c[usize::from(i)][usize::from(j)] = value;
        }
        Polynomial { c }
    }

    /// Value at (u, l), by Horner's rule.
    pub fn at(&self, u: f64, l: f64) -> f64 {
        self.c.iter().rev().fold(0.0, |s, row| {
            s * u + row.iter().rev().fold(0.0, |t, &c| t * l + c)
        })
    }
}
