//! The fewest knots that draw the sides of an attainable set.

use crate::chain::Chains;

/// What a knot may be below the side, as shares of the largest torque: where the side bends inwards a knot on it would
/// take chords outside.
pub(super) const LEVELS: [f64; 4] = [0.0, 0.0006, 0.0015, 0.004];

/// A drawing that loses no more than this share of what both sides may is not refined further.
const FINE: f64 = 0.125;

/// Most knots of a side.
pub(super) const MOST_KNOTS: usize = 28;

/// A chord that loses more than this many times what both sides may is of no use.
const FUTILE: f64 = 2.0;

/// One side as a function that is linear between its nodes.
pub(super) struct Curve {
    /// `[f, Q]`, in the order of f.
    pub(super) nodes: Vec<[f64; 2]>,
    /// Nodes that may be knots.
    pub(super) candidates: Vec<usize>,
    /// Area below it up to each node.
    pub(super) area: Vec<f64>,
}

impl Curve {
    /// Drawings with 2, 3, .. knots, the first and last of them at the curve's ends. Both curves may lose `allowed`.
    fn drawings(&self, allowed: f64) -> Chains {
        let levels = LEVELS.len();
        let count = self.candidates.len() * levels;
        // Chords below the curve: from, to, what is lost.
        let mut chords: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
        for (start, chords) in chords.iter_mut().enumerate() {
            let from = self.point(start);
            let mut steepest = f64::INFINITY;
            let mut next = start / levels + 1;
            for node in self.candidates[start / levels] + 1..self.nodes.len() {
                let [f, q] = self.nodes[node];
                steepest = steepest.min((q - from[1]) / (f - from[0]));
                if next < self.candidates.len() && self.candidates[next] == node {
                    for end in next * levels..(next + 1) * levels {
                        let to = self.point(end);
                        let slope = (to[1] - from[1]) / (to[0] - from[0]);
                        let below = self.area[node] - self.area[self.candidates[start / levels]];
                        let lost = below - 0.5 * (to[1] + from[1]) * (to[0] - from[0]);
                        if slope <= steepest + 1e-12 && lost <= FUTILE * allowed {
                            chords.push((end, lost));
                        }
                    }
                    next += 1;
                }
            }
        }
        Chains::new(&chords, count - levels, FINE * allowed, MOST_KNOTS - 1)
    }

    /// A knot that may be: one of [`LEVELS`] at one of the candidates.
    fn point(&self, state: usize) -> [f64; 2] {
        let [f, q] = self.nodes[self.candidates[state / LEVELS.len()]];
        [f, q - LEVELS[state % LEVELS.len()]]
    }
}

/// The fewest knots of both curves that lose no more than `allowed` of the area in all, or of the drawings that can be the one
/// that loses least; of as many knots those that lose least. `None` where [`MOST_KNOTS`] cannot do.
pub(super) fn fewest_knots(curves: &[Curve; 2], allowed: f64) -> Option<[Vec<[f64; 2]>; 2]> {
    let drawings = curves.each_ref().map(|curve| curve.drawings(allowed));
    let [upper, lower] = [0, 1].map(|k| &drawings[k].lost);
    let pairs = (0..upper.len()).flat_map(|a| (0..lower.len()).map(move |b| [a, b]));
    let cost = |&[a, b]: &[usize; 2]| {
        let lost = upper[a] + lower[b];
        (if lost <= allowed { a + b } else { usize::MAX }, lost)
    };
    let best = pairs.min_by(|a, b| {
        let (a, b) = (cost(a), cost(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    })?;
    let [upper, lower] = [0, 1].map(|k| {
        let knots = drawings[k].corners(best[k])?.into_iter();
        Some(knots.map(|knot| curves[k].point(knot)).collect())
    });
    Some([upper?, lower?])
}
