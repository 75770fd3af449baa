//! The sides of an attainable set of any shape, as polylines inside it.
//!
//! With each thrust f a unit has the torques between the nearest points of the border above and below the chord from
//! the idle corner to the full one. (Beside a corner where f falls along an edge of the throttle box the set
//! reaches further, behind a gap: that is given up.) Both sides are functions of f, limited in slope so that the torque that
//! yaw reaches is a continuous function of the request, and then drawn with the fewest knots that lose little.

use mixer_rt::Knot;

use crate::attainable::border_area;
use crate::model::PairMap;
use crate::tables::SideTable;

/// Border points per edge of the throttle box.
const SAMPLES: usize = 256;

/// Every so many of them may be a knot.
const STRIDE: usize = 8;

/// Largest slope of a side, in its largest torque per largest thrust.
const STEEPEST: f64 = 16.0;

/// What a knot may be below the side, as shares of the largest torque: where the side bends inwards a knot on it would
/// take chords outside.
const LEVELS: [f64; 4] = [0.0, 0.0006, 0.0015, 0.004];

/// What a knot keeps from the border for rounding, as a share of the largest torque.
const MARGIN: f64 = 4e-6;

/// Share of the area that both sides may lose.
const LOSS: f64 = 2e-3;

/// Share of [`LOSS`] that is left to the knots where gaps and slopes cost nearly all of it.
const LEAST_LOSS: f64 = 0.3;

/// Most knots of a side.
const MOST_KNOTS: usize = 20;

/// A chord that loses more than this many times what the whole side may is of no use.
const FUTILE: f64 = 4.0;

/// Most that both sides may lose in the end, as a share of the area; beyond it a convex polygon does as well.
const MOST_LOST: f64 = 0.01;

/// Border points per edge at which the sides are checked, and by how much they may miss, as a share of the largest torque.
const CHECKS: usize = 1000;
const ROUNDING: f64 = 1e-5;

/// Both sides, where they lose little.
pub(super) fn sides(pair: &PairMap, thrust_n: [f32; 2]) -> Option<[SideTable; 2]> {
    let outline = Outline::new(pair).filter(|outline| outline.lost <= MOST_LOST)?;
    let sides = outline.sides.map(|knots| SideTable::Polyline(rounded(&knots)));
    let [least, most] = thrust_n.map(f64::from);
    let slack = ROUNDING * pair.scale()[1];
    let [largest, lowest] = &sides;
    let is_inside = pair.border(CHECKS).into_iter().all(|throttles| {
        let [f, q] = pair.efforts(throttles);
        f < least || f > most || q > largest.torque(f) - slack || -q > lowest.torque(f) - slack
    });
    is_inside.then_some(sides)
}

/// The knots as `mixer-rt` reads them.
fn rounded(knots: &[[f64; 2]]) -> Vec<Knot> {
    let slope = |k: usize| {
        let ends = knots.get(k..k + 2)?;
        let [[from, low], [to, high]] = [0, 1].map(|end| ends[end].map(|x| f64::from(x as f32)));
        Some(((high - low) / (to - from)) as f32)
    };
    let mut before = slope(0).unwrap_or(0.0);
    (0..knots.len())
        .map(|k| {
            let after = slope(k).unwrap_or(before);
            let knot = Knot {
                thrust_n: knots[k][0] as f32,
                torque_nm: knots[k][1] as f32,
                slope: after,
                bend: after - before,
            };
            before = after;
            knot
        })
        .collect()
}

/// Both sides, Q_max(f) and -Q_min(f).
pub(super) struct Outline {
    /// Knots `[f, Q]`, N and N m, in the order of f.
    pub(super) sides: [Vec<[f64; 2]>; 2],
    /// Share of the attainable set's area that is outside.
    pub(super) lost: f64,
}

/// One side as a function that is linear between its nodes.
struct Curve {
    nodes: Vec<[f64; 2]>,
    /// Nodes that may be knots.
    candidates: Vec<usize>,
    /// Area below it up to each node.
    area: Vec<f64>,
}

impl Outline {
    /// The sides of the attainable set; `None` where thrust does not grow from the idle corner to the full one, or what
    /// is left between the sides is not connected.
    pub(super) fn new(pair: &PairMap) -> Option<Outline> {
        let scale = pair.scale();
        let border = pair.scaled_border(SAMPLES);
        let (first, last) = (border[0], border[2 * SAMPLES]);
        let slope = (last[1] - first[1]) / (last[0] - first[0]);
        if last[0] <= first[0] || !slope.is_finite() {
            return None;
        }
        let whole = 0.5 * border_area(&border);
        let curves = [1.0, -1.0].map(|sign| {
            // From the chord, which is the same line for both.
            let above: Vec<[f64; 2]> = border
                .iter()
                .map(|&[f, q]| [f, sign * (q - first[1] - slope * (f - first[0]))])
                .collect();
            let vertices = if sign > 0.0 {
                2 * SAMPLES..=4 * SAMPLES
            } else {
                0..=2 * SAMPLES
            };
            Curve::new(&above, vertices, [first[0], last[0]])
        });
        let kept: f64 = curves.iter().map(|curve| curve.area[curve.area.len() - 1]).sum();
        let allowed = ((LOSS - 1.0) * whole + kept).max(LEAST_LOSS * LOSS * whole);
        let [upper, lower] = [0, 1].map(|k| curves[k].knots(0.5 * allowed));
        let knots = [upper?, lower?];
        let area: f64 = knots
            .iter()
            .flat_map(|knots| knots.windows(2))
            .map(|ends| 0.5 * (ends[0][1] + ends[1][1]) * (ends[1][0] - ends[0][0]))
            .sum();
        let mut sides = knots.map(|knots| {
            knots
                .into_iter()
                .map(|[f, above]| [f, above - MARGIN])
                .collect::<Vec<_>>()
        });
        for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
            for [f, q] in side.iter_mut() {
                *q += sign * (first[1] + slope * (*f - first[0]));
                (*f, *q) = (*f * scale[0], *q * scale[1]);
            }
        }
        Some(Outline {
            sides,
            lost: 1.0 - area / whole,
        })
    }
}

impl Curve {
    /// The nearest points above zero of a closed border, at the thrusts of those of its `vertices` that lie within the range.
    fn new(border: &[[f64; 2]], vertices: std::ops::RangeInclusive<usize>, [low, high]: [f64; 2]) -> Curve {
        let n = border.len();
        let mut order: Vec<(f64, bool)> = vertices
            .map(|k| (border[k % n][0], k % STRIDE == 0 || k % SAMPLES == 0))
            .filter(|&(f, _)| f > low && f < high)
            .collect();
        order.extend([(low, true), (high, true)]);
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        order.dedup_by(|a, b| {
            let same = a.0 - b.0 < 1e-9;
            b.1 |= same && a.1;
            same
        });
        let mut nodes: Vec<[f64; 2]> = order.iter().map(|&(f, _)| [f, f64::INFINITY]).collect();
        for k in 0..n {
            let (mut a, mut b) = (border[k], border[(k + 1) % n]);
            if a[0] > b[0] {
                (a, b) = (b, a);
            }
            // Nothing above, or left of the range: thrust may fall at first along an edge.
            if a[1].max(b[1]) <= 1e-12 || b[0] <= low || a[0] >= high {
                continue;
            }
            let from = nodes.partition_point(|node| node[0] < a[0]);
            for node in nodes[from..].iter_mut().take_while(|node| node[0] <= b[0]) {
                let share = if b[0] > a[0] {
                    (node[0] - a[0]) / (b[0] - a[0])
                } else {
                    0.0
                };
                let at = a[1] + share * (b[1] - a[1]);
                if at >= -1e-9 && at < node[1] {
                    node[1] = at.max(0.0);
                }
            }
        }
        let count = nodes.len();
        for node in &mut nodes {
            if node[1] == f64::INFINITY {
                node[1] = 0.0;
            }
        }
        for k in 1..count {
            nodes[k][1] = nodes[k][1].min(nodes[k - 1][1] + STEEPEST * (nodes[k][0] - nodes[k - 1][0]));
        }
        for k in (1..count).rev() {
            nodes[k - 1][1] = nodes[k - 1][1].min(nodes[k][1] + STEEPEST * (nodes[k][0] - nodes[k - 1][0]));
        }
        let mut area = vec![0.0; count];
        for k in 1..count {
            area[k] = area[k - 1] + 0.5 * (nodes[k][1] + nodes[k - 1][1]) * (nodes[k][0] - nodes[k - 1][0]);
        }
        Curve {
            candidates: (0..count).filter(|&k| order[k].1).collect(),
            nodes,
            area,
        }
    }

    /// The fewest knots that lose no more than `allowed` of the area below the curve, the last knots being its ends; of
    /// those the ones that lose least. `None` where [`MOST_KNOTS`] cannot do.
    fn knots(&self, allowed: f64) -> Option<Vec<[f64; 2]>> {
        let levels = LEVELS.len();
        let count = self.candidates.len() * levels;
        let point = |state: usize| {
            let [f, q] = self.nodes[self.candidates[state / levels]];
            [f, q - LEVELS[state % levels]]
        };
        // Chords below the curve: from, to, what is lost.
        let mut chords: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
        for (start, chords) in chords.iter_mut().enumerate() {
            let from = point(start);
            let mut steepest = f64::INFINITY;
            let mut next = start / levels + 1;
            for node in self.candidates[start / levels] + 1..self.nodes.len() {
                let [f, q] = self.nodes[node];
                steepest = steepest.min((q - from[1]) / (f - from[0]));
                if next < self.candidates.len() && self.candidates[next] == node {
                    for end in next * levels..(next + 1) * levels {
                        let to = point(end);
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
        let mut origins: Vec<Vec<usize>> = Vec::new();
        let end = count - levels;
        while least[end] > allowed && origins.len() + 1 < MOST_KNOTS {
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
            origins.push(from);
        }
        if least[end] == f64::INFINITY {
            return None;
        }
        let mut knots = vec![point(end)];
        let mut at = end;
        for from in origins.iter().rev() {
            at = from[at];
            knots.push(point(at));
        }
        knots.reverse();
        Some(knots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframe::Airframe;
    use crate::{Source, attainable};

    /// A pair whose set bends inwards: biquadratic, f = 14 u^2 - `wake` u l + 10 l^2, Q = 0.14 l^2 - 0.15 u^2.
    fn bent(wake: f64) -> PairMap {
        let text = format!(
            "name = \"bent\"\n[throttle]\nmin = 0.25\nmax = 1.0\n[pair]\nbasis = \"biquadratic\"\n\
             thrust_n = [0.0, 0.0, 14.0, 0.0, {:?}, 0.0, 10.0, 0.0]\n\
             torque_nm = [0.0, 0.0, -0.15, 0.0, 0.0, 0.0, 0.14, 0.0]\nupper_spin = \"cw\"\n\
             [[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
             [allocation]\naxes = [\"yaw\", \"thrust\"]\n",
            -wake
        );
        let airframe = Airframe::read(&Source::new("bent.toml", text)).unwrap();
        PairMap::new(&airframe.pair, &airframe.throttle)
    }

    /// With 4.8 thrust grows along all edges, with 5.4 it falls at first where the upper rotor is at full throttle.
    #[test]
    fn sides_are_inside_the_set_and_lose_little() {
        for wake in [4.8, 5.4] {
            let pair = bent(wake);
            let [idle, full] = [0, 1].map(|end| pair.efforts([pair.range()[end]; 2])[0] as f32);
            let thrust_n = [idle.next_up(), full.next_down()];
            let sides = sides(&pair, thrust_n).unwrap();
            let torque = pair.scale()[1];
            for throttles in pair.border(777) {
                let [f, q] = pair.efforts(throttles);
                let outside =
                    q > sides[0].torque(f) - ROUNDING * torque || -q > sides[1].torque(f) - ROUNDING * torque;
                assert!(
                    outside || f < f64::from(idle),
                    "{wake}: {throttles:?} is between the sides"
                );
            }
            let lost = attainable::lost_between(&pair, &sides, thrust_n);
            println!("{wake}: {:.3} % lost", 100.0 * lost);
            assert!(lost > 0.0 && lost <= LOSS, "{wake}: {lost}");
            for side in &sides {
                let SideTable::Polyline(knots) = side else {
                    panic!("{side:?}")
                };
                assert!(knots.len() <= MOST_KNOTS, "{} knots", knots.len());
                assert!(
                    knots.windows(2).all(|ends| ends[0].thrust_n < ends[1].thrust_n),
                    "{knots:?}"
                );
            }
        }
    }
}
