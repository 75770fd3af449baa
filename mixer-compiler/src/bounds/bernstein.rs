//! Bernstein coefficients of a polynomial of one variable, in f64.
//!
//! On [0, 1] the power s^i is the sum over k >= i of C(k, i) / C(n, i) B_k(s). A polynomial lies
//! between its least and its greatest Bernstein coefficient, and the first and the last are its
//! values at the ends.

/// Power coefficients in t, at least one, to as many Bernstein coefficients on [a, b].
pub fn coefficients(power: &[f64], [a, b]: [f64; 2]) -> Vec<f64> {
    let n = power.len().saturating_sub(1);
    // t = a + (b - a) s: Taylor shift by synthetic division, then scaling.
    let mut c = power.to_vec();
    for i in 0..n {
        for k in (i..n).rev() {
            c[k] += a * c[k + 1];
        }
    }
    let mut scale = 1.0;
    for c in &mut c {
        *c *= scale;
        scale *= b - a;
    }
    (0..c.len())
        .map(|k| (0..=k).map(|i| binomial(k, i) / binomial(n, i) * c[i]).sum())
        .collect()
}

/// Binomial coefficient, exact for the small degrees that occur here.
pub(crate) fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}
