//! The programs over the polygons that a mixer has for the attainable sets of units with both rotors.

use mixer_rt::Health;

use super::{Oracle, Pieces, is_out};
use crate::request::Frame;

impl Oracle {
    /// Over the convex hulls of the polygons.
    pub fn of_polygons(frame: &Frame, volts: f32, health: Health) -> Self {
        over(frame, volts, health, |polygon, _| vec![polygon.to_vec()])
    }

    /// Over the polygons themselves, which may bend inwards: cut into triangles about their centre, from which all of them is
    /// seen. An optimum takes seconds.
    pub fn of_exact_polygons(frame: &Frame, volts: f32, health: Health) -> Self {
        over(frame, volts, health, |polygon, centre| {
            let next = polygon.iter().cycle().skip(1);
            let edges = polygon.iter().zip(next);
            edges.map(|(&start, &end)| vec![centre, start, end]).collect()
        })
    }
}

/// Over the pieces `cut` of a polygon, given its corners and its centre, N and N m.
fn over(
    frame: &Frame,
    volts: f32,
    health: Health,
    cut: impl Fn(&[[f64; 2]], [f64; 2]) -> Pieces<[f64; 2]>,
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
    let cut = cut(&corners, centre);
    for (i, pieces) in oracle.sets.iter_mut().enumerate() {
        let channels = frame.physics.channels[i].iter();
        if channels.copied().any(|channel| is_out(health, channel)) {
            continue;
        }
        let contribution = |efforts: &[f64; 2]| frame.physics.contribution(i, *efforts, factors);
        *pieces = cut
            .iter()
            .map(|piece| piece.iter().map(contribution).collect())
            .collect();
    }
    oracle
}
