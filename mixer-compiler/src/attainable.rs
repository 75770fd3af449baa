//! A convex polygon inside the attainable set of one unit.
//!
//! The set's border is the image of the throttle box's border, since the forward map is injective. Where the
//! border bulges outwards any chord is inside; where it bends inwards a convex set inside can at best touch it.
//! So: take the convex hull of the border, cut it along a tangent wherever the border still runs through it, then
//! keep the fewest corners with which no more than the allowed share of the area is lost. (Whatever corners of a
//! convex polygon are left out, the rest stays inside it.)

use crate::model::PairMap;
use crate::tables::{AttainableTable, SideTable};

/// Border points per edge of the box. A border that bends inwards by b between its corners leaves the chords of
/// its points by b / SAMPLES^2: 3e-7 of the set's size for the paper's pair.
const SAMPLES: usize = 128;

/// A border point deeper than this inside the polygon, in units of the set's size, makes a cut necessary.
const DEPTH: f64 = 3e-6;

/// Share of the polygon's distance from its centre that is left to rounding and to [`DEPTH`].
const MARGIN: f64 = 1e-5;

/// Share of the set's area that may be lost.
const LOSS: f64 = 2e-3;

/// What leaving out corners may cost where the set's inward bends cost almost all of [`LOSS`] or more: this share of
/// what they cost.
const CORNER_SHARE: f64 = 0.1;

/// Cuts that are made at most; border points left inside after that count as corners of the set's convex part.
const CUTS: usize = 64;

/// Shares of the attainable set's area that are outside the polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLoss {
    /// In all.
    pub total: f64,
    /// What the cuts cost that make a convex set of it.
    pub convexity: f64,
}

/// The convex part of the attainable set.
#[derive(Clone, Debug)]
pub(crate) struct ConvexPart {
    /// Corners `[f, Q]` (N, N m), anticlockwise.
    pub(crate) corners: Vec<[f64; 2]>,
    /// Its centroid, moved to Q = 0 where that is inside.
    centre: [f64; 2],
    scale: [f64; 2],
    pub(crate) lost: AreaLoss,
}

impl ConvexPart {
    /// A convex polygon inside the attainable set at the reference voltage.
    pub(crate) fn new(pair: &PairMap) -> Self {
        let scale = pair.scale();
        let border = pair.scaled_border(SAMPLES);
        let mut polygon = hull(&border);
        for _ in 0..CUTS {
            let Some((point, normal)) = deepest(&border, &polygon) else {
                break;
            };
            polygon = cut(&polygon, point, normal);
        }
        let whole = border_area(&border);
        let convexity = 1.0 - moments(&polygon).0 / whole;
        let allowed = (LOSS - 3.0 * MARGIN - convexity).max(CORNER_SHARE * convexity);
        let polygon = fewest_corners(&polygon, allowed * whole);
        let centre = centre(&polygon);
        let corners: Vec<[f64; 2]> = polygon
            .into_iter()
            .map(|corner| [0, 1].map(|k| corner[k] + MARGIN * (centre[k] - corner[k])))
            .collect();
        let lost = AreaLoss {
            total: 1.0 - moments(&corners).0 / whole,
            convexity,
        };
        ConvexPart {
            corners: corners
                .into_iter()
                .map(|[f, q]| [f * scale[0], q * scale[1]])
                .collect(),
            lost,
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

/// Twice the area that a closed border of [`SAMPLES`] points per edge encloses. Chords of a smooth border lose the
/// square of their length: that of every other point tells how much (Richardson).
fn border_area(border: &[[f64; 2]]) -> f64 {
    let every_other: Vec<[f64; 2]> = border.iter().copied().step_by(2).collect();
    let (fine, coarse) = (moments(border).0, moments(&every_other).0);
    fine + (fine - coarse) / 3.0
}

/// Share of the attainable set's area that is not between its sides, `thrust_n` being where these begin and end.
pub(crate) fn lost_between(pair: &PairMap, sides: &[SideTable; 2], thrust_n: [f32; 2]) -> f64 {
    const STEPS: usize = 2000;
    let border: Vec<[f64; 2]> = pair
        .border(SAMPLES)
        .into_iter()
        .map(|throttles| pair.efforts(throttles))
        .collect();
    let [least, most] = thrust_n.map(f64::from);
    let width = (most - least) / STEPS as f64;
    let between = |k: usize| {
        let f = least + width * k as f64;
        sides.iter().map(|side| side.torque(f)).sum::<f64>()
    };
    let twice: f64 = (0..STEPS).map(|k| width * (between(k) + between(k + 1))).sum();
    1.0 - twice / border_area(&border)
}

/// The fewest corners, the sharpest among them, with which a convex polygon loses no more than `allowed` of twice its
/// area; of those the ones that lose least. Chain by chain: what reaching a corner over so many edges loses at least.
fn fewest_corners(polygon: &[[f64; 2]], allowed: f64) -> Vec<[f64; 2]> {
    let n = polygon.len();
    let turn = |k: usize| {
        let [before, here, after] = [polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n]];
        let length = |a: [f64; 2], b: [f64; 2]| {
            let (df, dq) = (b[0] - a[0], b[1] - a[1]);
            (df * df + dq * dq).sqrt()
        };
        cross(before, here, after) / (length(before, here) * length(here, after))
    };
    let sharpest = (0..n).max_by(|&a, &b| turn(a).total_cmp(&turn(b))).unwrap_or(0);
    let mut chain: Vec<[f64; 2]> = (0..=n).map(|k| polygon[(sharpest + k) % n]).collect();
    let origin = chain[0];
    for point in &mut chain {
        *point = [point[0] - origin[0], point[1] - origin[1]];
    }
    // Twice the area between the origin and the chain up to each of its corners.
    let product = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let mut swept = vec![0.0; n + 1];
    for k in 0..n {
        swept[k + 1] = swept[k] + product(chain[k], chain[k + 1]);
    }
    let mut least = vec![f64::INFINITY; n + 1];
    least[0] = 0.0;
    let mut origins: Vec<Vec<usize>> = Vec::new();
    while least[n] > allowed && origins.len() < n {
        let mut next = vec![f64::INFINITY; n + 1];
        let mut from = vec![0; n + 1];
        for start in 0..n {
            if least[start] > allowed {
                continue;
            }
            // A chord to a farther corner loses more.
            let mut end = start + 1;
            while end <= n {
                let lost = swept[end] - swept[start] - product(chain[start], chain[end]);
                let sum = least[start] + lost;
                if sum > allowed {
                    break;
                }
                if sum < next[end] {
                    next[end] = sum;
                    from[end] = start;
                }
                end += 1;
            }
        }
        least = next;
        origins.push(from);
    }
    let mut corners = Vec::with_capacity(origins.len());
    let mut at = n;
    for from in origins.iter().rev() {
        at = from[at];
        corners.push(polygon[(sharpest + at) % n]);
    }
    corners.reverse();
    corners
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
mod tests;
