//! A table of throttles over a cell, its seams included.
//!
//! Bilinear interpolation is piecewise linear in x and in y. Along one coordinate, over the segments i..=k that a
//! cell of the proof may reach,
//!
//! ```text
//! v(x) = v_i + d_i (x - i) + sum over the knots m in i+1..=k of (d_m - d_m-1) max(0, x - m)      d_m = v_m+1 - v_m
//! ```
//!
//! and the table is the tensor product of that. max(0, t) lies between its chord over the range of t and the chord
//! less its height at t = 0.
//!
//! The runtime computes with one cell's polynomial P, exactly the right one for the place that it has, which is off
//! by at most e: its error is that of computing P, and where the true place is in another cell, P and the table
//! differ by less than the bend at the seam times e.

use mixer_rt::TableSeed;

use super::taylor::Taylor;

/// See the module; sums of few terms of the tables' size are rounded in f64 here.
const SLACK: f64 = 64.0 * f64::EPSILON;

/// What [`TableSeed::at`] gives at the places `place`.
pub(super) fn interpolate(table: &TableSeed, place: [Taylor; 2]) -> [Taylor; 2] {
    let cells = place.each_ref().map(reached);
    let [[i0, i1], [j0, j1]] = cells;
    let mut error = [0.0f64; 2];
    for i in i0..=i1 {
        for j in j0..=j1 {
            let rest = [0, 1].map(|k: usize| place[k] + -([i, j][k] as f32));
            let throttles = table.within([i, j], rest);
            if i0 == i1 && j0 == j1 {
                return throttles;
            }
            error = [0, 1].map(|k| error[k].max(throttles[k].error()));
        }
    }
    let along = [0, 1].map(|k| pieces(&place[k], cells[k]));
    [0, 1].map(|k| {
        let bends = bends(table, k, cells);
        let mut sum = Taylor::exact(0.0);
        let mut size = 0.0;
        let mut kink = 0.0;
        for (row, (bends, x)) in bends.iter().zip(&along[0]).enumerate() {
            for (column, (&bend, y)) in bends.iter().zip(&along[1]).enumerate() {
                sum = sum.plus(&x.product(y).times(bend, 0.0));
                let (x, y) = (x.magnitude(), y.magnitude());
                size += bend.abs() * x * y;
                if row > 1 {
                    kink += bend.abs() * y * place[0].error();
                }
                if column > 1 {
                    kink += bend.abs() * x * place[1].error();
                }
            }
        }
        sum.widened(SLACK * size)
            .with_error((error[k] + kink) * (1.0 + SLACK))
    })
}

/// First and last segment that a place, or what the runtime has in its stead, may lie in.
fn reached(place: &Taylor) -> [usize; 2] {
    let range = place.range();
    let segment = |x: f64| (x as usize).min(TableSeed::LAST_CELL);
    [range.low - place.error(), range.high + place.error()].map(segment)
}

/// The functions 1, x - i and max(0, x - m) of the formula.
fn pieces(place: &Taylor, [first, last]: [usize; 2]) -> Vec<Taylor> {
    let from = |knot: usize| place.real().plus(&Taylor::exact(-(knot as f64)));
    let mut pieces = vec![Taylor::exact(1.0), from(first)];
    pieces.extend((first + 1..=last).map(|knot| positive_part(&from(knot))));
    pieces
}

/// max(0, t).
fn positive_part(t: &Taylor) -> Taylor {
    let range = t.range();
    if range.high <= 0.0 {
        Taylor::exact(0.0)
    } else if range.low >= 0.0 {
        *t
    } else {
        let slope = range.high / (range.high - range.low);
        let half = -0.5 * slope * range.low;
        t.times(slope, f64::EPSILON)
            .plus(&Taylor::exact(half))
            .widened(half * (1.0 + SLACK))
    }
}

/// Coefficients of the products of [`pieces`] along x (rows) and y (columns) for throttle `k`: the formula's, first
/// along y, then along x. The knots' differences are exact in f64 but for a rounding.
fn bends(table: &TableSeed, k: usize, [x, y]: [[usize; 2]; 2]) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = (x[0]..=x[1] + 1)
        .map(|i| along(&table.knots[i].map(|knot| f64::from(knot[k])), y))
        .collect();
    let columns: Vec<Vec<f64>> = (0..rows[0].len())
        .map(|column| {
            let values: Vec<f64> = rows.iter().map(|row| row[column]).collect();
            along(&values, [0, x[1] - x[0]])
        })
        .collect();
    (0..columns[0].len())
        .map(|row| columns.iter().map(|column| column[row]).collect())
        .collect()
}

/// v_i, d_i and the changes of d up to the last segment.
fn along(values: &[f64], [first, last]: [usize; 2]) -> Vec<f64> {
    let slope = |m: usize| values[m + 1] - values[m];
    let mut coefficients = vec![values[first], slope(first)];
    coefficients.extend((first + 1..=last).map(|m| slope(m) - slope(m - 1)));
    coefficients
}
