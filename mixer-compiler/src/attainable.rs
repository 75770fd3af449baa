//! A polygon inside the attainable set of one unit.
//!
//! The set's border is the image of the throttle box's border, since the forward map is injective. Vertices are
//! put on the border where a chord would leave it by more than a share of the set's size; where the border bends
//! inwards, so that the chord runs outside, the vertices are moved inwards by as much.

use crate::model::PairMap;

/// Border points per edge of the box from which vertices are chosen.
const SAMPLES: usize = 64;

/// Largest distance of a chord from the border, in units of the set's size.
const CHORD_TOLERANCE: f64 = 5e-4;

/// A polygon `[f, Q]` (N, N m), anticlockwise, inside the attainable set at the reference voltage.
pub(crate) fn polygon(pair: &PairMap) -> Vec<[f64; 2]> {
    let [size_f, size_q] = pair.scale();
    let border: Vec<[f64; 2]> = pair
        .border(SAMPLES)
        .into_iter()
        .map(|throttles| {
            let [f, q] = pair.efforts(throttles);
            [f / size_f, q / size_q]
        })
        .collect();
    let mut chosen = Vec::new();
    for edge in 0..4 {
        divide(&border, edge * SAMPLES, (edge + 1) * SAMPLES, &mut chosen);
    }
    let mut inset = vec![0.0f64; chosen.len()];
    for (k, &(start, end)) in chosen.iter().enumerate() {
        let outside = -deviations(&border, start, end).0;
        let next = (k + 1) % chosen.len();
        inset[k] = inset[k].max(outside);
        inset[next] = inset[next].max(outside);
    }
    let corners: Vec<[f64; 2]> = chosen.iter().map(|&(start, _)| border[start]).collect();
    let vertices = moved_inwards(&corners, &inset);
    vertices
        .into_iter()
        .map(|[f, q]| [f * size_f, q * size_q])
        .collect()
}

/// Divides the arc from `start` to `end` until every chord is close to it; appends the chords in order.
fn divide(border: &[[f64; 2]], start: usize, end: usize, chords: &mut Vec<(usize, usize)>) {
    let (inwards, outwards) = deviations(border, start, end);
    if end - start == 1 || (inwards > -CHORD_TOLERANCE && outwards < CHORD_TOLERANCE) {
        chords.push((start, end));
    } else {
        let middle = start + (end - start) / 2;
        divide(border, start, middle, chords);
        divide(border, middle, end, chords);
    }
}

/// The least and the largest distance of the arc from its chord, positive where the arc bulges outwards (to the
/// right of the chord).
fn deviations(border: &[[f64; 2]], start: usize, end: usize) -> (f64, f64) {
    let at = |k: usize| border[k % border.len()];
    let ([f0, q0], [f1, q1]) = (at(start), at(end));
    let (df, dq) = (f1 - f0, q1 - q0);
    let length = (df * df + dq * dq).sqrt();
    let mut range = (0.0f64, 0.0f64);
    for k in start + 1..end {
        let [f, q] = at(k);
        let right = ((f - f0) * dq - (q - q0) * df) / length;
        range = (range.0.min(right), range.1.max(right));
    }
    range
}

/// Moves each vertex inwards along its bisector so that both of its edges move by `inset` of that vertex.
fn moved_inwards(corners: &[[f64; 2]], inset: &[f64]) -> Vec<[f64; 2]> {
    let count = corners.len();
    let normal = |from: [f64; 2], to: [f64; 2]| {
        let (df, dq) = (to[0] - from[0], to[1] - from[1]);
        let length = (df * df + dq * dq).sqrt();
        [-dq / length, df / length]
    };
    (0..count)
        .map(|k| {
            let here = corners[k];
            let before = normal(corners[(k + count - 1) % count], here);
            let after = normal(here, corners[(k + 1) % count]);
            let sum = [before[0] + after[0], before[1] + after[1]];
            // |sum|^2 / 2 = 1 + cos of the angle between the normals
            let square = 0.5 * (sum[0] * sum[0] + sum[1] * sum[1]);
            let factor = inset[k] / square.max(0.05);
            [here[0] + factor * sum[0], here[1] + factor * sum[1]]
        })
        .collect()
}
