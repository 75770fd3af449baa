//! A small convex polygon inside the attainable set of one unit, which the general path allocates
//! over.
//!
//! The set's border is the image of the throttle box's border, since the forward map is injective.
//! The polygon starts as the largest convex part of the set. Then corners are dropped, each time
//! the one that loses least area.

mod convex;

use crate::model::PairMap;
use crate::tables::AttainableTable;
use convex::{convex_part, cross, distance};

/// Border points per edge of the box. Where the border bends inwards, chords between its points are
/// outside by the square of the points' distance: 1e-6 of the set's size at the paper's corners.
const SAMPLES: usize = 512;

/// Every so many of them make the convex part.
const COARSE: usize = 4;

/// Most corners of the polygon.
const MOST_CORNERS: usize = 8;

/// Share of the area that dropping one more corner may lose. Corners cost time where efforts of
/// least norm are compared with the polygon. When this was chosen, 23 of 1,992 requests missed the
/// optimum by more than 1 % with 0.4 %, and 16 with this (test `any_frame_reaches_the_optimum`; the
/// costs of shortages changed at the same time).
const LOSS: f64 = 1.5e-3;

/// Drawn in towards the centre by this share, for rounding.
const MARGIN: f64 = 1e-5;

/// Shares of the attainable set's area that are outside the polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLoss {
    /// In all.
    pub total: f64,
    /// Outside the convex part.
    pub convexity: f64,
}

/// A polygon inside the attainable set.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    /// Corners `[f, Q]` (N, N m), anticlockwise.
    pub(crate) corners: Vec<[f64; 2]>,
    /// A point well inside.
    centre: [f64; 2],
    scale: [f64; 2],
    pub(crate) lost: AreaLoss,
}

impl Polygon {
    /// The polygon at the reference voltage.
    pub(crate) fn new(pair: &PairMap) -> Self {
        let scale = pair.scale();
        let border = pair.scaled_border(SAMPLES);
        let whole = border_area(&border);
        let coarse: Vec<[f64; 2]> = border.iter().copied().step_by(COARSE).collect();
        let convex = convex_part(&coarse);
        let centre = centre(&convex);
        let polygon: Vec<[f64; 2]> = fewer_corners(&convex, LOSS * whole)
            .into_iter()
            .map(|corner| [0, 1].map(|k| corner[k] + MARGIN * (centre[k] - corner[k])))
            .collect();
        let newtons = |[f, q]: [f64; 2]| [f * scale[0], q * scale[1]];
        Polygon {
            lost: AreaLoss {
                total: 1.0 - moments(&polygon).0 / whole,
                convexity: 1.0 - moments(&convex).0 / whole,
            },
            corners: polygon.into_iter().map(newtons).collect(),
            centre: newtons(centre),
            scale,
        }
    }

    /// Rounded, as the mixer reads it.
    pub(crate) fn table(&self) -> AttainableTable {
        AttainableTable::new(&self.corners, self.scale, self.centre)
    }
}

/// The polygon with the corners dropped that lose least, down to [`MOST_CORNERS`] and on while one
/// loses no more than `allowed` of twice the area.
fn fewer_corners(polygon: &[[f64; 2]], allowed: f64) -> Vec<[f64; 2]> {
    let mut corners = polygon.to_vec();
    while corners.len() > 3 {
        let n = corners.len();
        let loss = |k: usize| cross(corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]);
        let Some(least) = (0..n).min_by(|&a, &b| loss(a).total_cmp(&loss(b))) else {
            break;
        };
        if n <= MOST_CORNERS && loss(least) > allowed {
            break;
        }
        corners.remove(least);
    }
    corners
}

/// Twice the area, and the centroid.
pub(crate) fn moments(polygon: &[[f64; 2]]) -> (f64, [f64; 2]) {
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

/// Twice the area that a closed border of an even number of points per edge encloses. Chords of a
/// smooth border lose the square of their length: that of every other point tells how much
/// (Richardson).
pub(crate) fn border_area(border: &[[f64; 2]]) -> f64 {
    let every_other: Vec<[f64; 2]> = border.iter().copied().step_by(2).collect();
    let (fine, coarse) = (moments(border).0, moments(&every_other).0);
    fine + (fine - coarse) / 3.0
}

/// The centroid, moved to Q = 0 unless that is much nearer the border: then bare thrust needs no
/// torque.
fn centre(polygon: &[[f64; 2]]) -> [f64; 2] {
    let (_, [f, q]) = moments(polygon);
    let depth = |point: [f64; 2]| {
        let ends = polygon.iter().cycle().skip(1);
        let distances = polygon
            .iter()
            .zip(ends)
            .map(|(&start, &end)| cross(start, end, point) / distance(start, end));
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
