//! A side's concave hull in a few straight lines, by which the closed form chooses thrusts: see
//! `mixer_rt::tables::Outline`.

use mixer_rt::tables::{Knot, Outline};

/// Lines of an outline.
const LINES: usize = Outline::KNOTS + 1;

/// Most corners of the hull that may be knots.
const CORNERS: usize = 48;

/// The outline of a side with these torques at these thrusts, in shares of `scale`.
pub(super) fn outline(thrusts: &[f64], torques: &[f64], scale: [f64; 2]) -> Outline {
    let knots = fewest_gaps(&thinned(hull(thrusts, torques)));
    let slopes: Vec<f64> = knots
        .windows(2)
        .map(|ends| scale[1] / scale[0] * (ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0]))
        .collect();
    // Knots that are not needed lie at the end.
    let unneeded = Knot {
        thrust_n: (scale[0] * knots[knots.len() - 1][0]) as f32,
        drop: 0.0,
    };
    let mut outline = Outline {
        slope: slopes[0] as f32,
        knots: [unneeded; Outline::KNOTS],
    };
    let bends = knots.iter().skip(1).zip(slopes.windows(2));
    for (knot, (at, slopes)) in outline.knots.iter_mut().zip(bends) {
        *knot = Knot {
            thrust_n: (scale[0] * at[0]) as f32,
            drop: (slopes[0] - slopes[1]) as f32,
        };
    }
    outline
}

/// Corners `[f, Q]` of the concave hull.
fn hull(thrusts: &[f64], torques: &[f64]) -> Vec<[f64; 2]> {
    let mut hull: Vec<[f64; 2]> = Vec::new();
    for (&f, &q) in thrusts.iter().zip(torques) {
        if hull.last().is_some_and(|last| f <= last[0]) {
            continue;
        }
        while let [.., a, b] = hull[..] {
            if (b[1] - a[1]) * (f - a[0]) > (q - a[1]) * (b[0] - a[0]) {
                break;
            }
            hull.pop();
        }
        hull.push([f, q]);
    }
    hull
}

/// At most [`CORNERS`] of them: those where the hull bends most, and both ends.
fn thinned(mut hull: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    while hull.len() > CORNERS {
        // Twice the area that the hull loses without a corner.
        let lost = |k: usize| {
            let [a, b, c] = [hull[k - 1], hull[k], hull[k + 1]];
            (b[1] - a[1]) * (c[0] - a[0]) - (c[1] - a[1]) * (b[0] - a[0])
        };
        let least = (1..hull.len() - 1).min_by(|&a, &b| lost(a).total_cmp(&lost(b)));
        let Some(least) = least else { break };
        hull.remove(least);
    }
    hull
}

/// Both ends and at most [`Outline::KNOTS`] corners between, so that the largest gap between the
/// hull and the lines is least.
fn fewest_gaps(hull: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = hull.len();
    let gap = |i: usize, j: usize| {
        let slope = (hull[j][1] - hull[i][1]) / (hull[j][0] - hull[i][0]);
        let above = |p: &[f64; 2]| p[1] - hull[i][1] - slope * (p[0] - hull[i][0]);
        hull[i..j].iter().map(above).fold(0.0, f64::max)
    };
    let gaps: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| if j > i { gap(i, j) } else { f64::INFINITY })
                .collect()
        })
        .collect();
    // The least largest gap up to each corner, and the corners on the way.
    let mut best: Vec<(f64, Vec<usize>)> = (0..n).map(|j| (gaps[0][j], vec![0, j])).collect();
    for _ in 1..LINES {
        best = (0..n)
            .map(|j| {
                let mut least = best[j].clone();
                for i in 1..j {
                    let largest = best[i].0.max(gaps[i][j]);
                    if largest < least.0 {
                        least = (largest, [best[i].1.as_slice(), &[j]].concat());
                    }
                }
                least
            })
            .collect();
    }
    best[n - 1].1.iter().map(|&k| hull[k]).collect()
}
