//! The exponent with the map profiled out.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use std::collections::{BTreeMap, BTreeSet};

use faer::Mat;

use super::exponent::{Estimate, Row};
use crate::fit::student_t_975;

/// The form of g.
pub(super) enum Regressors {
    /// One free value per level.
    Levels,
    /// A linear combination of these columns (given by rows).
    Columns(Vec<Vec<f64>>),
}

impl Regressors {
    /// Number of unknowns in g.
    fn unknowns(&self, rows: &[&Row]) -> usize {
        match self {
            Regressors::Columns(columns) => columns.first().map_or(0, Vec::len),
            Regressors::Levels => rows.iter().map(|r| r.level).collect::<BTreeSet<usize>>().len(),
        }
    }

    /// The part of `y` that no g times `factor` explains; nothing if g is not determined.
    fn off_span(&self, rows: &[&Row], factor: &[f64], y: &[f64]) -> Option<Vec<f64>> {
        match self {
            Regressors::Columns(columns) => {
                let times = |(c, f): (&Vec<f64>, &f64)| c.iter().map(|x| f * x).collect();
                let scaled: Vec<Vec<f64>> = columns.iter().zip(factor).map(times).collect();
                off_span(&scaled, y)
            }
            Regressors::Levels => {
                let mut sums: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
                for ((r, f), y) in rows.iter().zip(factor).zip(y) {
                    let [fy, ff] = sums.entry(r.level).or_default();
                    *fy += f * y;
                    *ff += f * f;
                }
                let rest = rows.iter().zip(factor).zip(y).map(|((r, f), y)| {
                    let [fy, ff] = sums.get(&r.level)?;
                    Some(y - f * fy / ff)
                });
                rest.collect()
            }
        }
    }
}

/// Gauss-Newton on k with g profiled out.
pub(super) fn profile(rows: &[&Row], g: &Regressors, reference: f64) -> Option<Estimate> {
    let unknowns = g.unknowns(rows) + 1;
    let degrees = rows.len().checked_sub(unknowns).filter(|&d| d > 0)?;
    let full = rows.iter().fold(0.0_f64, |m, r| m.max(r.y.abs()));
    let count = rows.iter().map(|r| r.level + 1).max()?;
    // The weight is the level's, not the row's: else of two rows the smaller would weigh more and
    // bias g.
    let mut of_level = vec![(0.0, 0.0); count];
    for r in rows {
        of_level[r.level].0 += r.y;
        of_level[r.level].1 += 1.0;
    }
    let weight = |r: &Row| {
        let (sum, n) = of_level[r.level];
        1.0 / (sum / n).abs().max(0.1 * full).max(f64::MIN_POSITIVE)
    };
    let weights: Vec<f64> = rows.iter().map(|r| weight(r)).collect();
    let ratio: Vec<f64> = rows.iter().map(|r| r.voltage / reference).collect();
    let y: Vec<f64> = rows.iter().zip(&weights).map(|(r, w)| w * r.y).collect();
    let mut k = TYPICAL_EXPONENT; // the problem is nearly linear in k
    for _ in 0..50 {
        let factor = ratio.iter().zip(&weights).map(|(r, w)| w * libm::pow(*r, k));
        let factor: Vec<f64> = factor.collect();
        let residual = g.off_span(rows, &factor, &y)?;
        let points = y.iter().zip(&residual).zip(&ratio);
        let derivative: Vec<f64> = points.map(|((y, e), r)| (y - e) * libm::log(*r)).collect();
        let own = g.off_span(rows, &factor, &derivative)?;
        let norm: f64 = own.iter().map(|d| d * d).sum();
        if norm <= 1e-12 {
            return None;
        }
        let step = own.iter().zip(&residual).map(|(d, e)| d * e).sum::<f64>() / norm;
        k += step.clamp(-1.0, 1.0);
        if step.abs() < 1e-12 {
            let sse: f64 = residual.iter().map(|e| e * e).sum();
            return Some(Estimate {
                exponent: k,
                ci95: student_t_975(degrees) * (sse / degrees as f64 / norm).sqrt(),
                method: "",
                levels: 0,
                residual_percent: 100.0 * (sse / rows.len() as f64).sqrt(),
            });
        }
    }
    None
}

/// The part of `y` outside the span of the columns; nothing if these are dependent or too many.
pub(crate) fn off_span(rows: &[Vec<f64>], y: &[f64]) -> Option<Vec<f64>> {
    let columns = rows.first()?.len();
    if rows.len() <= columns {
        return None;
    }
    let qr = Mat::from_fn(rows.len(), columns, |i, j| rows[i][j]).qr();
    let r = qr.thin_R();
    let largest = (0..columns).map(|k| r[(k, k)].abs()).fold(0.0, f64::max);
    if (0..columns).any(|k| r[(k, k)].abs() <= 1e-10 * largest) {
        return None;
    }
    let q = qr.compute_thin_Q();
    let mut rest = y.to_vec();
    for k in 0..columns {
        let along: f64 = y.iter().enumerate().map(|(i, y)| q[(i, k)] * y).sum();
        rest.iter_mut()
            .enumerate()
            .for_each(|(i, x)| *x -= q[(i, k)] * along);
    }
    Some(rest)
}
