//! Proof that a polynomial law leaves thrust and torque over the whole voltage range.
//!
//! A polynomial lies between the least and the greatest of its Bernstein coefficients, so what is
//! left of it above a least factor is positive where all of these are. Where they are not, the
//! interval is halved (de Casteljau) until they are, or until an end of an interval is itself not
//! positive.

use super::law::horner;
use crate::bounds::bernstein;

/// Least k over the range. The mixer divides by k; below this a rotor hardly turns.
pub(super) const LEAST_FACTOR: f64 = 1e-3;

/// Where on [a, b] the polynomial is not above the least factor, and its value there; `None` where
/// it is proven to be. The place is that of the least value among the found one and a fine grid.
pub(super) fn below_least(coefficients: &[f64], [a, b]: [f64; 2]) -> Option<(f64, f64)> {
    let mut above = coefficients.to_vec();
    *above.first_mut()? -= LEAST_FACTOR;
    let found = descend(bernstein::coefficients(&above, [a, b]), 0.0, 1.0, 0)?;
    const GRID: usize = 256;
    let grid = (0..=GRID).map(|i| i as f64 / GRID as f64);
    let worst = grid
        .chain([found])
        .map(|t| a + (b - a) * t)
        .map(|x| (x, horner(coefficients, x)));
    worst.min_by(|(_, k), (_, other)| k.total_cmp(other))
}

/// A place t in [t0, t1] where the polynomial with these Bernstein coefficients is not positive.
fn descend(bernstein: Vec<f64>, t0: f64, t1: f64, depth: usize) -> Option<f64> {
    // A polynomial that touches zero within 2^-30 of the range is taken for one that reaches it.
    const DEEPEST: usize = 30;
    if bernstein.iter().all(|&b| b > 0.0) {
        return None;
    }
    let is_positive = |b: Option<&f64>| b.is_some_and(|&b| b > 0.0);
    if !is_positive(bernstein.first()) || depth == DEEPEST {
        return Some(t0);
    }
    if !is_positive(bernstein.last()) {
        return Some(t1);
    }
    let (mut left, mut right) = (Vec::new(), bernstein);
    let mut tail = Vec::new();
    while let (Some(&first), Some(&last)) = (right.first(), right.last()) {
        left.push(first);
        tail.push(last);
        right = right.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    }
    tail.reverse();
    let middle = 0.5 * (t0 + t1);
    descend(left, t0, middle, depth + 1).or_else(|| descend(tail, middle, t1, depth + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positivity_is_decided_between_the_ends() {
        // (x - 1)^2 + d: positive at both ends of [0.8, 1.2], least at 1.
        for (d, positive) in [(1.001e-3, true), (0.999e-3, false), (0.0, false), (-1e-6, false)] {
            assert_eq!(
                below_least(&[1.0 + d, -2.0, 1.0], [0.8, 1.2]).is_none(),
                positive,
                "{d}"
            );
        }
        let (x, k) = below_least(&[-1.0, 1.0], [0.8, 1.2]).unwrap();
        assert!((x - 0.8).abs() < 1e-12 && (k + 0.2).abs() < 1e-12, "{x} {k}");
        assert!(below_least(&[1.0], [0.8, 1.2]).is_none());
        // Degree 8, positive with negative coefficients: 1 - 0.9 x^8 / 1.2^8.
        let mut eight = [0.0; 9];
        eight[0] = 1.0;
        eight[8] = -0.9 / 4.299_816_96;
        assert!(below_least(&eight, [0.1, 1.2]).is_none());
    }

    #[test]
    fn dips_are_found_wherever_they_are() {
        // (x - r)^2 (x + 1) + d: lopsided, least just beside r, where it is d.
        for step in 0..=200 {
            let r = 0.6 + 0.004 * f64::from(step);
            for (d, positive) in [(LEAST_FACTOR + 1e-6, true), (LEAST_FACTOR - 1e-6, false)] {
                let polynomial = [r * r + d, r * r - 2.0 * r, 1.0 - 2.0 * r, 1.0];
                let found = below_least(&polynomial, [0.5, 1.5]);
                assert_eq!(found.is_none(), positive, "{r} {d}");
                assert!(found.is_none_or(|(_, k)| k < LEAST_FACTOR), "{r} {found:?}");
                assert!(found.is_none_or(|(x, _)| (x - r).abs() < 3e-3), "{r} {found:?}");
            }
        }
    }
}
