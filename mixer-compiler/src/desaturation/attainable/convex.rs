//! The largest convex part of a set: the hull of its border, cut along a tangent wherever the
//! border still runs through it.

/// A border point deeper than this inside the polygon, in units of the set's size, makes a cut
/// necessary.
const DEPTH: f64 = 3e-6;

/// Cuts that are made at most; border points left inside after that count as corners of the set's
/// convex part.
const CUTS: usize = 64;

/// A convex polygon inside a closed border, both anticlockwise.
pub(super) fn convex_part(border: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut polygon = hull(border);
    for _ in 0..CUTS {
        let Some((point, normal)) = deepest(border, &polygon) else {
            break;
        };
        polygon = cut(&polygon, point, normal);
    }
    polygon
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

/// The border point deepest inside the polygon with the outward normal of the polygon's edge next
/// to it; `None` where none is deeper than [`DEPTH`].
fn deepest(border: &[[f64; 2]], polygon: &[[f64; 2]]) -> Option<([f64; 2], [f64; 2])> {
    let mut found = None;
    let mut depth = DEPTH;
    for &point in border {
        let mut nearest = (f64::INFINITY, [0.0; 2]);
        for (k, &start) in polygon.iter().enumerate() {
            let end = polygon[(k + 1) % polygon.len()];
            let (df, dq) = (end[0] - start[0], end[1] - start[1]);
            let length = distance(start, end);
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

/// Twice the area of a triangle, positive where it runs anticlockwise.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [f, q] = [b[0] - a[0], b[1] - a[1]];
    (f * f + q * q).sqrt()
}
