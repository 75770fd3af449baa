//! The fewest corners of a polygon inside a border that is seen whole from one point.

use super::{cross, distance};
use crate::chain::Chains;

/// Borders of more points than this have a corner at every so many of them, and where they turn by more than [`SHARP`],
/// the sine.
const CANDIDATES: usize = 128;
const SHARP: f64 = 0.1;

/// What a corner may be below the border, in units of the set's size or as shares of its distance from the centre: where
/// the border bends inwards a corner on it would take chords outside.
const DEPTHS: [f64; 4] = [0.0005, 0.0015, 0.004, 0.012];

/// Most corners; the indices of the mixer's table are bytes.
const MOST_CORNERS: usize = 80;

/// A chord that loses more than this many times what the whole polygon may is of no use.
const FUTILE: f64 = 8.0;

/// Least distance from the centre to the line of an edge, in units of the set's size: of an edge that is seen at a smaller
/// angle rounding hides on which side a point is.
const SLANT: f64 = 0.03;

/// Distance from the border that is left to rounding, in units of the set's size.
const MARGIN: f64 = 5e-6;

/// Steps of a search for the largest of a concave function, and edges of a border that it looks at.
const THIRDS: usize = 24;
const LOOKED_AT: usize = 128;

/// Corners that may be, per candidate.
const LEVELS: usize = 1 + 2 * DEPTHS.len();

/// A border as a chain from its sharpest point around to it again, with what may be a corner.
struct Chain {
    nodes: Vec<[f64; 2]>,
    /// Indices of nodes, the first and the last among them.
    candidates: Vec<usize>,
    /// Per candidate: on the border, below it towards the centre, below it along the normal.
    corners: Vec<[[f64; 2]; LEVELS]>,
    /// Twice the area between the centre and the border up to each node.
    swept: Vec<f64>,
    centre: [f64; 2],
}

/// The fewest corners, anticlockwise, with which a polygon inside a closed border loses no more than `allowed` of twice its
/// area, or if [`MOST_CORNERS`] lose more, these; of those the ones that lose least. The border's sharpest point is
/// among them. `None` where no corners do, or `centre` does not see all of the border.
pub(super) fn fewest_corners(border: &[[f64; 2]], centre: [f64; 2], allowed: f64) -> Option<Vec<[f64; 2]>> {
    if !is_seen_from(border, centre) {
        return None;
    }
    let chain = Chain::new(border, centre)?;
    let end = (chain.candidates.len() - 1) * LEVELS;
    let chords: Vec<Vec<(usize, f64)>> = (0..end)
        .map(|start| chain.chords(start, FUTILE * allowed))
        .collect();
    let chains = Chains::new(&chords, end, allowed, MOST_CORNERS);
    let mut corners = chains.corners(chains.lost.len().checked_sub(1)?)?;
    corners.pop();
    Some(corners.into_iter().map(|corner| chain.corner(corner)).collect())
}

impl Chain {
    fn new(border: &[[f64; 2]], centre: [f64; 2]) -> Option<Chain> {
        let n = border.len();
        let around = |k: usize| [border[(k + n - 1) % n], border[k % n], border[(k + 1) % n]];
        let turn = |k: usize| {
            let [before, here, after] = around(k);
            cross(before, here, after) / (distance(before, here) * distance(here, after))
        };
        let sharpest = (0..n).max_by(|&a, &b| turn(a).total_cmp(&turn(b)))?;
        let stride = (n / CANDIDATES).max(1);
        let candidates: Vec<usize> = (0..=n)
            .filter(|&k| k % n == 0 || (sharpest + k) % stride == 0 || turn(sharpest + k).abs() > SHARP)
            .collect();
        let corners = candidates.iter().map(|&k| {
            let [before, here, after] = around(sharpest + k);
            let inwards = inward_normal(before, after);
            let below = |depth: f64, way: [f64; 2]| [0, 1].map(|axis| here[axis] + depth * way[axis]);
            let to_centre = [centre[0] - here[0], centre[1] - here[1]];
            std::array::from_fn(|level| match level {
                0 => here,
                level if level <= DEPTHS.len() => below(DEPTHS[level - 1], to_centre),
                level => below(DEPTHS[level - 1 - DEPTHS.len()], inwards),
            })
        });
        let nodes: Vec<[f64; 2]> = (0..=n).map(|k| border[(sharpest + k) % n]).collect();
        let mut swept = vec![0.0];
        for ends in nodes.windows(2) {
            swept.push(swept[swept.len() - 1] + cross(centre, ends[0], ends[1]));
        }
        Some(Chain {
            corners: corners.collect(),
            nodes,
            candidates,
            swept,
            centre,
        })
    }

    fn corner(&self, index: usize) -> [f64; 2] {
        self.corners[index / LEVELS][index % LEVELS]
    }

    /// The ways from a corner, by its index (that of its candidate times [`LEVELS`], and its level), to later ones that have
    /// the border on their right and lose no more than `bearable`, with twice the area that each loses.
    fn chords(&self, start: usize, bearable: f64) -> Vec<(usize, f64)> {
        let from = self.corner(start);
        let first = self.candidates[start / LEVELS];
        let last = self.nodes.len() - 1;
        let mut chords = Vec::new();
        // The border point furthest to the left, as seen from here.
        let mut leftmost: Option<[f64; 2]> = None;
        let mut next = start / LEVELS + 1;
        for node in first + 1..=last {
            let here = self.nodes[node];
            if cross(self.centre, from, here) <= 0.0 {
                break;
            }
            if self.candidates[next] == node {
                // The chain ends where it has begun, on the border.
                let levels = if node == last { 1 } else { LEVELS };
                for level in 0..levels {
                    let end = self.corners[next][level];
                    let lost = self.swept[node] - self.swept[first] - cross(self.centre, from, end);
                    let passes = leftmost.is_none_or(|leftmost| cross(from, leftmost, end) >= 0.0);
                    let slants = cross(self.centre, from, end) >= SLANT * distance(from, end);
                    if passes && slants && lost <= bearable {
                        chords.push((next * LEVELS + level, lost));
                    }
                }
                next += 1;
            }
            if leftmost.is_none_or(|leftmost| cross(from, leftmost, here) > 0.0) {
                leftmost = Some(here);
            }
        }
        chords
    }
}

/// Some of a convex polygon's corners, not too many.
pub(super) fn thinned(polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stride = polygon.len().div_ceil(MOST_CORNERS).max(1);
    polygon.iter().copied().step_by(stride).collect()
}

/// The polygon with every edge moved inwards by [`MARGIN`].
pub(super) fn inset(polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = polygon.len();
    let inwards = |k: usize| inward_normal(polygon[k % n], polygon[(k + 1) % n]);
    (0..n)
        .map(|k| {
            let (before, after) = (inwards(k + n - 1), inwards(k));
            let both = 1.0 + before[0] * after[0] + before[1] * after[1];
            [0, 1].map(|axis| polygon[k][axis] + MARGIN * (before[axis] + after[axis]) / both)
        })
        .collect()
}

/// The unit normal, to the left, of the way from one point to another.
fn inward_normal(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let length = distance(from, to);
    [(from[1] - to[1]) / length, (to[0] - from[0]) / length]
}

/// True where the straight ways from `centre` to a closed border, anticlockwise, are inside.
pub(super) fn is_seen_from(border: &[[f64; 2]], centre: [f64; 2]) -> bool {
    let ends = border.iter().cycle().skip(1);
    border
        .iter()
        .zip(ends)
        .all(|(&start, &end)| cross(centre, start, end) > 0.0)
}

/// The points of a closed border that are seen from `centre`, in the order of their angles.
pub(super) fn seen_from(border: &[[f64; 2]], centre: [f64; 2]) -> Vec<[f64; 2]> {
    let is_seen = |point: [f64; 2]| {
        let ends = border.iter().cycle().skip(1);
        border.iter().zip(ends).all(|(&start, &end)| {
            let parts = cross(start, end, centre) * cross(start, end, point) < 0.0;
            let between = cross(centre, point, start) * cross(centre, point, end) < 0.0;
            !(parts && between)
        })
    };
    let mut seen: Vec<[f64; 2]> = Vec::new();
    for &point in border {
        if is_seen(point) && seen.last().is_none_or(|&last| cross(centre, last, point) > 0.0) {
            seen.push(point);
        }
    }
    seen
}

/// The point deepest behind the lines of all edges of a border: it sees all of them if any point does.
pub(super) fn deepest_view(border: &[[f64; 2]]) -> [f64; 2] {
    let depth = |point: [f64; 2]| {
        let ends = border.iter().cycle().skip(1);
        border
            .iter()
            .zip(ends)
            .step_by((border.len() / LOOKED_AT).max(1))
            .map(|(&start, &end)| cross(point, start, end) / distance(start, end))
            .fold(f64::INFINITY, f64::min)
    };
    let highest = |[mut low, mut high]: [f64; 2], value: &dyn Fn(f64) -> f64| {
        for _ in 0..THIRDS {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if value(thirds[0]) < value(thirds[1]) {
                low = thirds[0];
            } else {
                high = thirds[1];
            }
        }
        0.5 * (low + high)
    };
    let best_q = |f: f64| highest([-1.0, 1.0], &|q| depth([f, q]));
    let f = highest([0.0, 1.0], &|f| depth([f, best_q(f)]));
    [f, best_q(f)]
}
