//! The fewest knots that draw the sides of an attainable set.

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
    fn drawings(&self, allowed: f64) -> Drawings<'_> {
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
        let mut least = vec![f64::INFINITY; count];
        least[0] = 0.0;
        let mut drawings = Drawings {
            curve: self,
            lost: Vec::new(),
            origins: Vec::new(),
        };
        while drawings.lost.len() + 1 < MOST_KNOTS && least[count - levels] > FINE * allowed {
            let mut next = vec![f64::INFINITY; count];
            let mut from = vec![0; count];
            for start in 0..count {
                if least[start] == f64::INFINITY {
                    continue;
                }
                for &(end, lost) in &chords[start] {
                    if least[start] + lost < next[end] {
                        next[end] = least[start] + lost;
                        from[end] = start;
                    }
                }
            }
            least = next;
            drawings.lost.push(least[count - levels]);
            drawings.origins.push(from);
        }
        drawings
    }

    /// A knot that may be: one of [`LEVELS`] at one of the candidates.
    fn point(&self, state: usize) -> [f64; 2] {
        let [f, q] = self.nodes[self.candidates[state / LEVELS.len()]];
        [f, q - LEVELS[state % LEVELS.len()]]
    }
}

/// The drawings of a curve that lose least of the area below it, by their number of knots less two.
struct Drawings<'a> {
    curve: &'a Curve,
    /// What each loses.
    lost: Vec<f64>,
    /// The knot before each knot that may be, where that is a drawing's last.
    origins: Vec<Vec<usize>>,
}

impl Drawings<'_> {
    fn knots(&self, index: usize) -> Vec<[f64; 2]> {
        let mut at = (self.curve.candidates.len() - 1) * LEVELS.len();
        let mut knots = vec![self.curve.point(at)];
        for from in self.origins[..=index].iter().rev() {
            at = from[at];
            knots.push(self.curve.point(at));
        }
        knots.reverse();
        knots
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
        drawings[k].lost[best[k]]
            .is_finite()
            .then(|| drawings[k].knots(best[k]))
    });
    Some([upper?, lower?])
}
