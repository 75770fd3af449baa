//! The programmes over the polygons that a mixer has for the attainable sets of units with both
//! rotors.

use mixer_rt::Health;
use nalgebra::Vector2;

use super::change::by_throttles;
use super::{Oracle, Pieces, is_out};
use crate::request::Frame;

impl Oracle {
    /// Over the convex hulls of the polygons.
    pub fn of_polygons(frame: &Frame, volts: f32, health: Health) -> Self {
        over(frame, volts, health, |_, polygon, _| vec![polygon.to_vec()])
    }

    /// Over the polygons themselves, which may bend inwards: cut into triangles about their centre,
    /// from which all of them is seen. An optimum takes seconds.
    pub fn of_exact_polygons(frame: &Frame, volts: f32, health: Health) -> Self {
        over(frame, volts, health, |_, polygon, centre| {
            triangles(polygon, centre)
        })
    }

    /// Over the parts of the polygons in which no throttle is further than `reach` from these, one
    /// per output, by the derivative there.
    pub fn of_polygons_near(frame: &Frame, throttles: &[f64], volts: f32, reach: f64) -> Self {
        over(frame, volts, Health::GOOD, |i, polygon, centre| {
            let at = frame.physics.channels[i].map(|channel| throttles[channel]);
            let from = Vector2::from(frame.physics.pair.efforts(at));
            let by_throttles = by_throttles(frame, at);
            let by_efforts = by_throttles.try_inverse().unwrap_or_default();
            let ways = |triangle: Vec<[f64; 2]>| {
                let ways = triangle.into_iter();
                ways.map(|efforts| (by_efforts * (Vector2::from(efforts) - from)).into())
                    .collect()
            };
            let efforts = |way: [f64; 2]| (from + by_throttles * Vector2::from(way)).into();
            let triangles = triangles(polygon, centre).into_iter();
            let near = triangles.map(|triangle| within_box(ways(triangle), reach));
            near.filter(|piece| !piece.is_empty())
                .map(|piece| piece.into_iter().map(efforts).collect())
                .collect()
        })
    }
}

/// The triangles of a polygon about `centre`.
fn triangles(polygon: &[[f64; 2]], centre: [f64; 2]) -> Pieces<[f64; 2]> {
    let next = polygon.iter().cycle().skip(1);
    let edges = polygon.iter().zip(next);
    edges.map(|(&start, &end)| vec![centre, start, end]).collect()
}

/// What of a convex polygon lies in the square of `reach` to either side of zero (Sutherland,
/// Hodgman 1974).
fn within_box(mut polygon: Vec<[f64; 2]>, reach: f64) -> Vec<[f64; 2]> {
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let depth = |point: [f64; 2]| reach - sign * point[axis];
        let next = polygon.iter().cycle().skip(1);
        let mut clipped = Vec::new();
        for (&start, &end) in polygon.iter().zip(next) {
            let [from, to] = [start, end].map(depth);
            if from >= 0.0 {
                clipped.push(start);
            }
            if (from >= 0.0) != (to >= 0.0) {
                let share = from / (from - to);
                clipped.push([0, 1].map(|k| start[k] + share * (end[k] - start[k])));
            }
        }
        polygon = clipped;
    }
    polygon
}

/// Over the pieces `cut` of the polygon of a unit, given the unit's index, the polygon's corners
/// and its centre, N and N m.
fn over(
    frame: &Frame,
    volts: f32,
    health: Health,
    cut: impl Fn(usize, &[[f64; 2]], [f64; 2]) -> Pieces<[f64; 2]>,
) -> Oracle {
    let factors = frame.physics.factors(volts);
    let mut oracle = Oracle::new(&frame.physics, frame.allocation(), factors, health);
    let attainable = &frame.compiled.tables.attainable;
    let corners: Vec<[f64; 2]> = attainable
        .corners()
        .into_iter()
        .map(|corner| corner.map(f64::from))
        .collect();
    let centre = [0, 1].map(|k| f64::from(attainable.centre[k]) * f64::from(attainable.scale[k]));
    for (i, pieces) in oracle.sets.iter_mut().enumerate() {
        let channels = frame.physics.channels[i].iter();
        if channels.copied().any(|channel| is_out(health, channel)) {
            continue;
        }
        let contribution = |efforts: &[f64; 2]| frame.physics.contribution(i, *efforts, factors);
        *pieces = cut(i, &corners, centre)
            .iter()
            .map(|piece| piece.iter().map(contribution).collect())
            .collect();
    }
    oracle
}
