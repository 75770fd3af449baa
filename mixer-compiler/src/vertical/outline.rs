//! The sides of an attainable set of any shape, as polylines inside it.
//!
//! With each thrust f a unit has the torques between the nearest points of the border above and below the image of the
//! throttle box's diagonal u = l, which runs through the set from the idle corner to the full one. (Beside a corner where f
//! falls along an edge of the throttle box the set reaches further, behind a gap: that is given up.) Both sides are
//! functions of f, limited in slope so that the torque that yaw reaches is a continuous function of the request, and then
//! drawn with the fewest knots that lose little.
//!
//! Torques are counted from the chord between both corners: the area between the sides is the same.

use mixer_rt::Knot;

use super::drawing::{Curve, fewest_knots};
use crate::attainable::border_area;
use crate::model::PairMap;
use crate::tables::SideTable;

/// Border points per edge of the throttle box.
const SAMPLES: usize = 256;

/// Every so many of them may be a knot.
const STRIDE: usize = 8;

/// Largest slope of a side, in its largest torque per largest thrust.
const STEEPEST: f64 = 16.0;

/// What a knot keeps from the border for rounding, as a share of the largest torque.
const MARGIN: f64 = 4e-6;

/// Share of the area that both sides may lose: 0.2 %, less what [`MARGIN`] costs.
const LOSS: f64 = 1.98e-3;

/// Share of [`LOSS`] that is left to the knots where gaps and slopes cost nearly all of it.
const LEAST_LOSS: f64 = 0.3;

/// Most that both sides may lose in the end, as a share of the area; beyond it a convex polygon does as well.
const MOST_LOST: f64 = 0.01;

/// Border points per edge at which the sides are checked, and by how much they may miss, as a share of the largest torque.
const CHECKS: usize = 1000;
const ROUNDING: f64 = 1e-5;

/// Both sides and the offset (N m) and slope (N m per N) of a line in the set, where they lose little.
pub(super) fn sides(pair: &PairMap, thrust_n: [f32; 2]) -> Option<([SideTable; 2], [f64; 2])> {
    let outline = Outline::new(pair).filter(|outline| outline.lost <= MOST_LOST)?;
    let sides = outline
        .sides
        .each_ref()
        .map(|knots| SideTable::Polyline(rounded(knots)));
    let [least, most] = thrust_n.map(f64::from);
    let slack = ROUNDING * pair.scale()[1];
    let [largest, lowest] = &sides;
    let is_inside = pair.border(CHECKS).into_iter().all(|throttles| {
        let [f, q] = pair.efforts(throttles);
        f < least || f > most || q > largest.torque(f) - slack || -q > lowest.torque(f) - slack
    });
    is_inside.then_some((sides, outline.line))
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
    /// Offset (N m) and slope (N m per N) of a line in the set.
    line: [f64; 2],
    /// Share of the attainable set's area that is outside.
    pub(super) lost: f64,
}

impl Outline {
    /// The sides of the attainable set; `None` where thrust does not grow along the diagonal, or what is left between the sides
    /// is not connected.
    pub(super) fn new(pair: &PairMap) -> Option<Outline> {
        let scale = pair.scale();
        let border = pair.scaled_border(SAMPLES);
        let (first, last) = (border[0], border[2 * SAMPLES]);
        let slope = (last[1] - first[1]) / (last[0] - first[0]);
        if last[0] <= first[0] || !slope.is_finite() {
            return None;
        }
        let diagonal: Vec<[f64; 2]> = pair
            .diagonal(SAMPLES)
            .map(|[f, q]| [f / scale[0], q / scale[1]])
            .collect();
        if diagonal.windows(2).any(|ends| ends[1][0] <= ends[0][0]) {
            return None;
        }
        let whole = 0.5 * border_area(&border);
        let curves = [1.0, -1.0].map(|sign| {
            let above = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
                let points = points.iter();
                points
                    .map(|&[f, q]| [f, sign * (q - first[1] - slope * (f - first[0]))])
                    .collect()
            };
            let vertices = if sign > 0.0 {
                2 * SAMPLES..=4 * SAMPLES
            } else {
                0..=2 * SAMPLES
            };
            Curve::new(&above(&border), &above(&diagonal), vertices)
        });
        let kept: f64 = curves.iter().map(|curve| curve.area[curve.area.len() - 1]).sum();
        let allowed = ((LOSS - 1.0) * whole + kept).max(LEAST_LOSS * LOSS * whole);
        let knots = fewest_knots(&curves, allowed)?;
        let start = line_start(&curves)?;
        let tilt = slope - start / (last[0] - first[0]);
        let line = [
            scale[1] * (first[1] + start - tilt * first[0]),
            scale[1] / scale[0] * tilt,
        ];
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
            line,
            lost: 1.0 - area / whole,
        })
    }
}

impl Curve {
    /// The nearest points of a closed `border` above the diagonal, at the thrusts of those of its `vertices` that lie within
    /// the diagonal's.
    fn new(border: &[[f64; 2]], diagonal: &[[f64; 2]], vertices: std::ops::RangeInclusive<usize>) -> Curve {
        let n = border.len();
        let [low, high] = [diagonal[0][0], diagonal[diagonal.len() - 1][0]];
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
            // Left of the range: thrust may fall at first along an edge.
            if b[0] <= low || a[0] >= high {
                continue;
            }
            // The border meets the diagonal in the corners alone.
            let middle = (0.5 * (a[0] + b[0])).clamp(low, high);
            if between(a, b, middle) < linear(diagonal, middle) {
                continue;
            }
            let from = nodes.partition_point(|node| node[0] < a[0]);
            for node in nodes[from..].iter_mut().take_while(|node| node[0] <= b[0]) {
                node[1] = node[1].min(between(a, b, node[0]));
            }
        }
        let count = nodes.len();
        for node in &mut nodes {
            if node[1] == f64::INFINITY {
                node[1] = linear(diagonal, node[0]);
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
}

/// Where above the chord a line between both curves starts that ends where the chord does, as near to it as can be.
fn line_start(curves: &[Curve; 2]) -> Option<f64> {
    const STEPS: usize = 64;
    let is_between = |&start: &f64| {
        curves.iter().zip([start, -start]).all(|(curve, start)| {
            let [low, high] = [0, curve.nodes.len() - 1].map(|end| curve.nodes[end][0]);
            curve
                .nodes
                .iter()
                .all(|&[f, q]| start * (high - f) / (high - low) <= q + 1e-9)
        })
    };
    let [highest, lowest] = [0, 1].map(|k| curves[k].nodes[0][1]);
    (0..=STEPS)
        .flat_map(|k| [highest, -lowest].map(|end| end * k as f64 / STEPS as f64))
        .find(is_between)
}

/// The line through `a` and `b` at `f`; `a` where they are at the same.
fn between(a: [f64; 2], b: [f64; 2], f: f64) -> f64 {
    let share = if b[0] > a[0] {
        (f - a[0]) / (b[0] - a[0])
    } else {
        0.0
    };
    a[1] + share * (b[1] - a[1])
}

/// The polyline through `points`, in the order of f, at `f`.
fn linear(points: &[[f64; 2]], f: f64) -> f64 {
    let next = points
        .partition_point(|point| point[0] < f)
        .clamp(1, points.len() - 1);
    between(points[next - 1], points[next], f)
}

#[cfg(test)]
mod tests {
    use super::super::drawing::{LEVELS, MOST_KNOTS};
    use super::*;
    use crate::airframe::Airframe;
    use crate::{Source, attainable};

    /// f = 14 u^2 - w u l + 10 l^2 with w = 4.8, whose set bends inwards, and with w = 5.4, where f falls at first with the
    /// upper rotor at full throttle; and a pair whose Q falls at first with the lower rotor's throttle, so that the border is
    /// below the chord from the idle corner to the full one.
    const PAIRS: [[[f64; 8]; 2]; 3] = [
        [
            [0.0, 0.0, 14.0, 0.0, -4.8, 0.0, 10.0, 0.0],
            [0.0, 0.0, -0.15, 0.0, 0.0, 0.0, 0.14, 0.0],
        ],
        [
            [0.0, 0.0, 14.0, 0.0, -5.4, 0.0, 10.0, 0.0],
            [0.0, 0.0, -0.15, 0.0, 0.0, 0.0, 0.14, 0.0],
        ],
        [
            [0.0, 0.0, 14.0, 0.0, -1.7, -7.4, 10.0, 3.7],
            [0.0, 0.0, -0.15, 0.0, 0.06, 0.0, 0.13, -0.15],
        ],
    ];

    fn pair([thrust, torque]: [[f64; 8]; 2]) -> PairMap {
        let text = format!(
            "name = \"bent\"\n[throttle]\nmin = 0.25\nmax = 1.0\n[pair]\nbasis = \"biquadratic\"\n\
             thrust_n = {thrust:?}\ntorque_nm = {torque:?}\nupper_spin = \"cw\"\n\
             [[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n\
             [allocation]\naxes = [\"yaw\", \"thrust\"]\n"
        );
        let airframe = Airframe::read(&Source::new("bent.toml", text)).unwrap();
        PairMap::new(&airframe.pair, &airframe.throttle)
    }

    #[test]
    fn sides_are_inside_the_set_and_lose_little() {
        for terms in PAIRS {
            let pair = pair(terms);
            let [idle, full] = [0, 1].map(|end| pair.efforts([pair.range()[end]; 2])[0] as f32);
            let thrust_n = [idle.next_up(), full.next_down()];
            let (sides, [offset, slope]) = sides(&pair, thrust_n).unwrap();
            let torque = pair.scale()[1];
            for throttles in pair.border(777) {
                let [f, q] = pair.efforts(throttles);
                let outside =
                    q > sides[0].torque(f) - ROUNDING * torque || -q > sides[1].torque(f) - ROUNDING * torque;
                assert!(
                    outside || f < f64::from(idle),
                    "{terms:?}: {throttles:?} is between the sides"
                );
            }
            for f in (0..=100).map(|k| f64::from(idle) + 0.01 * f64::from(k) * f64::from(full - idle)) {
                let q = offset + slope * f;
                let above = [sides[0].torque(f) - q, q + sides[1].torque(f)];
                let allowed = -(LEVELS[LEVELS.len() - 1] + ROUNDING) * torque;
                assert!(above.iter().all(|&above| above > allowed), "{terms:?}: {f}");
            }
            let lost = attainable::lost_between(&pair, &sides, thrust_n);
            println!("{terms:?}: {:.3} % lost", 100.0 * lost);
            assert!(lost > 0.0 && lost <= 2e-3, "{terms:?}: {lost}");
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
