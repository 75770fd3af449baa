//! A polygon inside the attainable set of one unit, which desaturation works with.
//!
//! The set's border is the image of the throttle box's border, since the forward map is injective. The polygon has the
//! fewest corners, on the border or close below it, with which hardly any of the area is lost. It need not be convex,
//! but all of it is seen from one point: of a set that no point sees as a whole, the part that its centre sees.

mod convex;
mod corners;

use crate::model::PairMap;
use crate::tables::AttainableTable;
use convex::convex_part;
use corners::{fewest_corners, inset};

/// Border points per edge of the box. Where the border bends inwards it leaves the chords of its points by the square of
/// their distance, at corners of the paper's set by 1e-6 of its size.
const SAMPLES: usize = 512;

/// Every so many of them make the convex part.
const COARSE: usize = 4;

/// Share of the set's area that may be lost. With less, optima are missed by less, but there are more corners at which the
/// border bends inwards, hence more places where efforts jump: the README counts both.
const LOSS: f64 = 5e-4;

/// Share of the convex part's area that a convex polygon may lose, where no other is found.
const CONVEX_LOSS: f64 = 1e-3;

/// Shares of the attainable set's area that are outside the polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaLoss {
    /// In all.
    pub total: f64,
    /// What any convex polygon would lose, of many corners.
    pub convexity: f64,
}

/// A polygon inside the attainable set.
#[derive(Clone, Debug)]
pub(crate) struct Polygon {
    /// Corners `[f, Q]` (N, N m), anticlockwise.
    pub(crate) corners: Vec<[f64; 2]>,
    /// A point that sees all of it.
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
        let middle = centre(&convex);
        let from = |border: &[[f64; 2]], centre, loss: f64| {
            let corners = fewest_corners(border, centre, loss * whole)?;
            Some((centre, corners))
        };
        let (centre, polygon) = from(&border, middle, LOSS)
            .or_else(|| from(&corners::seen_from(&border, middle), middle, LOSS))
            .or_else(|| from(&border, corners::deepest_view(&border), LOSS))
            .or_else(|| from(&convex, middle, CONVEX_LOSS))
            .unwrap_or_else(|| (middle, corners::thinned(&convex)));
        let polygon = inset(&polygon);
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

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [f, q] = [b[0] - a[0], b[1] - a[1]];
    (f * f + q * q).sqrt()
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

/// Twice the area that a closed border of an even number of points per edge encloses. Chords of a smooth border lose the
/// square of their length: that of every other point tells how much (Richardson).
pub(crate) fn border_area(border: &[[f64; 2]]) -> f64 {
    let every_other: Vec<[f64; 2]> = border.iter().copied().step_by(2).collect();
    let (fine, coarse) = (moments(border).0, moments(&every_other).0);
    fine + (fine - coarse) / 3.0
}

/// The centroid, with Q = 0 where that is as well inside: then bare thrust needs no torque.
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
