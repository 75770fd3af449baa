//! A convex polygon inside the attainable set of one unit.
//!
//! The set's border is the image of the throttle box's border, since the forward map is injective. Where the
//! border bulges outwards any chord is inside; where it bends inwards a convex set inside can at best touch it.
//! So: take the convex hull of the border, cut it along a tangent wherever the border still runs through it, then
//! drop corners one by one, the one that costs the least area first, until as few are left as the allowed loss
//! permits. (Dropping a corner of a convex polygon stays inside it.)

use crate::model::PairMap;
use crate::tables::AttainableTable;

/// Border points per edge of the box. A border that bends inwards by b between its corners leaves the chords of
/// its points by b / SAMPLES^2: 3e-7 of the set's size for the paper's pair.
const SAMPLES: usize = 128;

/// A border point deeper than this inside the polygon, in units of the set's size, makes a cut necessary.
const DEPTH: f64 = 1e-5;

/// Share of the polygon's distance from its centre that is left to rounding and to [`DEPTH`].
const MARGIN: f64 = 3e-5;

/// Share of the area that dropping corners may cost in all.
const CORNER_LOSS: f64 = 1e-3;

/// Cuts that are made at most; border points left inside after that count as corners of the set's convex part.
const CUTS: usize = 64;

/// The convex part of the attainable set.
#[derive(Clone, Debug)]
pub(crate) struct ConvexPart {
    /// Corners `[f, Q]` (N, N m), anticlockwise.
    pub(crate) corners: Vec<[f64; 2]>,
    /// Its centroid, moved to Q = 0 where that is inside.
    centre: [f64; 2],
    scale: [f64; 2],
}

impl ConvexPart {
    /// A convex polygon inside the attainable set at the reference voltage.
    pub(crate) fn new(pair: &PairMap) -> Self {
        let scale = pair.scale();
        let border: Vec<[f64; 2]> = pair
            .border(SAMPLES)
            .into_iter()
            .map(|throttles| {
                let [f, q] = pair.efforts(throttles);
                [f / scale[0], q / scale[1]]
            })
            .collect();
        let mut polygon = hull(&border);
        for _ in 0..CUTS {
            let Some((point, normal)) = deepest(&border, &polygon) else {
                break;
            };
            polygon = cut(&polygon, point, normal);
        }
        drop_corners(&mut polygon);
        let centre = centre(&polygon);
        let corners = polygon
            .into_iter()
            .map(|corner| {
                let inwards = |k: usize| corner[k] + MARGIN * (centre[k] - corner[k]);
                [inwards(0) * scale[0], inwards(1) * scale[1]]
            })
            .collect();
        ConvexPart {
            corners,
            centre: [centre[0] * scale[0], centre[1] * scale[1]],
            scale,
        }
    }

    /// Rounded, as the mixer reads it.
    pub(crate) fn table(&self) -> AttainableTable {
        AttainableTable::new(&self.corners, self.scale, self.centre)
    }
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the area, and the centroid.
fn moments(polygon: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let origin = polygon[0];
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for pair in polygon[1..].windows(2) {
        let twice = cross(origin, pair[0], pair[1]);
        area += twice;
        for (k, moment) in moment.iter_mut().enumerate() {
            *moment += twice * (origin[k] + pair[0][k] + pair[1][k]) / 3.0;
        }
    }
    (area, moment.map(|m| m / area))
}

/// The convex hull, anticlockwise (Andrew's monotone chain).
fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let half = |points: &mut dyn Iterator<Item = &[f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for &point in points {
            while let [.., a, b] = chain[..]
                && cross(a, b, point) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut sorted.iter());
    lower.append(&mut half(&mut sorted.iter().rev()));
    lower
}

/// The border point deepest inside the polygon with the outward normal of the polygon's edge next to it; `None`
/// where none is deeper than [`DEPTH`].
fn deepest(border: &[[f64; 2]], polygon: &[[f64; 2]]) -> Option<([f64; 2], [f64; 2])> {
    let mut found = None;
    let mut depth = DEPTH;
    for &point in border {
        let mut nearest = (f64::INFINITY, [0.0; 2]);
        for (k, &start) in polygon.iter().enumerate() {
            let end = polygon[(k + 1) % polygon.len()];
            let (df, dq) = (end[0] - start[0], end[1] - start[1]);
            let length = (df * df + dq * dq).sqrt();
            let distance = cross(start, end, point) / length;
            if distance < nearest.0 {
                nearest = (distance, [dq / length, -df / length]);
            }
        }
        if nearest.0 > depth {
            depth = nearest.0;
            found = Some((point, nearest.1));
        }
    }
    found
}

/// The part of the polygon that is not beyond the line through `point` with outward `normal`.
fn cut(polygon: &[[f64; 2]], point: [f64; 2], normal: [f64; 2]) -> Vec<[f64; 2]> {
    let beyond = |p: [f64; 2]| normal[0] * (p[0] - point[0]) + normal[1] * (p[1] - point[1]);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &start) in polygon.iter().enumerate() {
        let end = polygon[(k + 1) % polygon.len()];
        let (from, to) = (beyond(start), beyond(end));
        if from <= 0.0 {
            kept.push(start);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            let share = from / (from - to);
            kept.push([
                start[0] + share * (end[0] - start[0]),
                start[1] + share * (end[1] - start[1]),
            ]);
        }
    }
    kept
}

/// Drops corners, the least area first, while the sum stays within [`CORNER_LOSS`].
fn drop_corners(polygon: &mut Vec<[f64; 2]>) {
    let mut budget = CORNER_LOSS * moments(polygon).0;
    while polygon.len() > 4 {
        let n = polygon.len();
        let cost = |k: usize| cross(polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]);
        let Some(cheapest) = (0..n).min_by(|&a, &b| cost(a).total_cmp(&cost(b))) else {
            return;
        };
        budget -= cost(cheapest);
        if budget < 0.0 {
            return;
        }
        polygon.remove(cheapest);
    }
}

/// The centroid, with Q = 0 where that is as well inside: then bare thrust needs no torque.
fn centre(polygon: &[[f64; 2]]) -> [f64; 2] {
    let (_, [f, q]) = moments(polygon);
    let depth = |point: [f64; 2]| {
        let ends = polygon.iter().cycle().skip(1);
        let distances = polygon.iter().zip(ends).map(|(&start, &end)| {
            let (df, dq) = (end[0] - start[0], end[1] - start[1]);
            cross(start, end, point) / (df * df + dq * dq).sqrt()
        });
        distances.fold(f64::INFINITY, f64::min)
    };
    let level = [f, 0.0];
    if depth(level) > 0.5 * depth([f, q]) {
        level
    } else {
        [f, q]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::{Basis, Pair, Spin, Throttle};

    /// The pair of the paper, Table I.
    fn paper() -> PairMap {
        let pair = Pair {
            basis: Basis::Biquadratic,
            thrust_n: vec![
                5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363,
            ],
            torque_nm: vec![-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720],
            upper_spin: Spin::Cw,
        };
        PairMap::new(&pair, &Throttle { min: 0.1, max: 1.0 })
    }

    #[test]
    fn the_polygon_is_convex_inside_the_set_and_loses_little() {
        let pair = paper();
        let part = ConvexPart::new(&pair);
        let n = part.corners.len();
        assert!(n <= 24, "{n} corners");
        for k in 0..n {
            let turn = cross(
                part.corners[k],
                part.corners[(k + 1) % n],
                part.corners[(k + 2) % n],
            );
            assert!(turn > 0.0, "corner {k}");
        }
        let border: Vec<[f64; 2]> = pair.border(2048).iter().map(|&t| pair.efforts(t)).collect();
        for &point in &border {
            let inside = (0..n).all(|k| cross(part.corners[k], part.corners[(k + 1) % n], point) > 0.0);
            assert!(!inside, "{point:?} of the border is inside the polygon");
        }
        let lost = 1.0 - moments(&part.corners).0 / moments(&border).0;
        println!("{n} corners, {:.3} % of the area lost", 100.0 * lost);
        // 0.18 % is lost to convexity alone.
        assert!(lost < 0.0031, "{lost}");
    }
}
