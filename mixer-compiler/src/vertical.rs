//! The table of `mixer-rt`'s shorter way to desaturate, for up to four units with vertical axes.
//!
//! On an edge of the throttle box both efforts are polynomials of one throttle t. For the biquadratic basis they
//! are quadratic, f = A t^2 + B t + C, so t is a square root of f and Q a combination of 1, f and
//! sqrt(f + B^2 / 4A - C). For the other bases such a combination is fitted and shifted to the inner side. The
//! shift under the root is searched for, the rest is least squares. Where the set is not convex, or no arc is
//! close, the sides are polylines: vertical/outline.rs.

mod coupling;
mod drawing;
mod outline;

use mixer_rt::{Airmode, Arc, Axis, Border, Facets, Side, Steepness, VerticalUnit};
use nalgebra::{Matrix3, Vector3};

use crate::airframe::Airframe;
use crate::attainable;
use crate::effectiveness::Effectiveness;
use crate::model::PairMap;
use crate::tables::{SideTable, VerticalTable};

/// Points per edge at which an arc is fitted and checked.
const SAMPLES: usize = 48;

/// Largest distance of an arc from its edge, as a share of the largest torque: costs 0.2 % of the area at most.
const ARC_TOLERANCE: f64 = 1e-3;

/// Share of the attainable area that convexity may cost where the sides are arcs.
const MOST_LOST_TO_CONVEXITY: f64 = 0.0025;

/// .. and what arcs may cost in all.
const MOST_LOST: f64 = 0.002;

/// What an arc keeps from its edge for rounding, as a share of the largest torque.
const MARGIN: f64 = 2e-6;

/// Of sums of a few f32 products.
const ROUNDING: f32 = 1e-6;

/// Yaw that counts as none, as a share of the units' largest torques.
const YAW_ROUNDING: f64 = 1e-5;

/// A unit whose thrust changes by less than this share of the largest along the null space has no part in it.
const NO_PART: f64 = 1e-5;

/// Shifts tried on a logarithmic scale, and halvings of the best interval.
const SHIFTS: usize = 80;
const HALVINGS: usize = 24;

/// The table, where the layout and the priorities allow the shorter way.
pub(crate) fn table(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    convexity: f64,
    [floor, ceiling]: [f32; 2],
) -> Option<VerticalTable> {
    let n = airframe.units.len();
    let allocation = &airframe.allocation;
    let matrix = &effectiveness.matrix;
    let vertical = (0..n).all(|i| {
        matrix[(2, i)] == 0.0
            && matrix[(3, i)] == 1.0
            && matrix[(0, n + i)] == 0.0
            && matrix[(1, n + i)] == 0.0
            && matrix[(2, n + i)].abs() == 1.0
            && matrix[(3, n + i)] == 0.0
    });
    let levers = [Axis::Roll, Axis::Pitch].map(|axis| allocation.controls(axis));
    let free: Vec<Vector3<f64>> = [Vector3::x(), Vector3::y()]
        .into_iter()
        .zip(levers)
        .filter_map(|(axis, served)| (!served).then_some(axis))
        .collect();
    // The null space of the thrusts has one dimension or none.
    let spanned = (3..=4).contains(&(n + free.len()));
    if !vertical || !spanned || !allocation.controls(Axis::Yaw) {
        return None;
    }
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let [low, high] = pair.range();
    let columns: Vec<Vector3<f64>> = (0..n)
        .map(|i| {
            let [roll, pitch] = [0, 1].map(|axis| if levers[axis] { matrix[(axis, i)] } else { 0.0 });
            Vector3::new(roll, pitch, matrix[(3, i)])
        })
        .collect();
    let ends = [pair.efforts([low, low]), pair.efforts([high, high])];
    // f32 rounding, inwards.
    let thrust_n = [(ends[0][0] as f32).next_up(), (ends[1][0] as f32).next_down()];
    let slope = (ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0]);
    let chord = [ends[0][1] - slope * ends[0][0], slope];
    let border = |(sides, chord): ([SideTable; 2], [f64; 2])| Border {
        sides,
        chord: chord.map(|x| x as f32),
        quadrangle: quadrangle(&pair),
    };
    let arcs = if convexity <= MOST_LOST_TO_CONVEXITY {
        arcs(&pair)
            .map(|sides| border((sides, chord)))
            .filter(|border| inside(&pair, border, thrust_n))
    } else {
        None
    };
    // A reserve of yaw, or yaw before thrust, couples thrust and yaw: that takes concave sides.
    let coupled = allocation.yaw_reserve_nm > 0.0 || allocation.airmode == Airmode::RollPitchYaw;
    let outline = || outline::sides(&pair, thrust_n).map(&border);
    let arcs = arcs.filter(|border| attainable::lost_between(&pair, &border.sides, thrust_n) <= MOST_LOST);
    let border = if coupled { arcs } else { arcs.or_else(outline) }?;
    let (slopes, walls) = facets(&columns, &free, thrust_n.map(f64::from));
    let yaw_rounding_nm = (YAW_ROUNDING * n as f64 * pair.scale()[1]) as f32;
    let spins: Vec<f64> = (0..n).map(|i| matrix[(2, n + i)]).collect();
    // The polygon's floor may be well above that of a set that is not convex.
    let floor = match &border.sides {
        [SideTable::Arcs(_), _] => floor,
        sides => level_floor(sides, thrust_n, &spins, yaw_rounding_nm)?,
    };
    // At least what the facets allow without roll and pitch, with rounding.
    let least_level = slopes.iter().map(|facets| facets.bounds[0]).fold(floor, f32::max);
    let mut table = VerticalTable {
        units: units(airframe, effectiveness, &null_vector(&columns, &free), thrust_n),
        complete: free.is_empty(),
        thrust_n,
        border,
        slopes,
        walls,
        thrust_floor_n: least_level * (1.0 + ROUNDING),
        thrust_middle_n: 0.5 * (floor + ceiling),
        yaw_rounding_nm,
        coupling: None,
    };
    if coupled {
        table.coupling = Some(coupling::coupling(&table, pair.scale()));
    }
    Some(table)
}

/// The least thrust in all (N) at which units with these `spins` and equal thrusts within `thrust_n` can leave yaw at zero.
fn level_floor(sides: &[SideTable; 2], thrust_n: [f32; 2], spins: &[f64], rounding: f32) -> Option<f32> {
    const STEPS: usize = 2000;
    let [least, most] = thrust_n.map(f64::from);
    let reaches = |f: f64, direction: f64| {
        let reach = spins
            .iter()
            .map(|spin| sides[usize::from(direction * spin < 0.0)].torque(f));
        reach.sum::<f64>() >= -f64::from(rounding)
    };
    (0..STEPS)
        .map(|k| least + (most - least) * k as f64 / STEPS as f64)
        .find(|&f| reaches(f, 1.0) && reaches(f, -1.0))
        .map(|f| (f * spins.len() as f64) as f32)
}

/// Both sides as arcs, where all edges have one.
fn arcs(pair: &PairMap) -> Option<[SideTable; 2]> {
    let [low, high] = pair.range();
    let side = |corner: [f64; 2], sign: f64| {
        let edges = [([low, low], corner), (corner, [high, high])];
        let [below, above] = edges.map(|(from, to)| arc(pair, from, to, sign));
        Some(Side {
            corner_n: pair.efforts(corner)[0] as f32,
            arcs: [below?, above?],
        })
    };
    let (largest, least) = (side([low, high], 1.0)?, side([high, low], -1.0)?);
    Some([largest, least].map(SideTable::Arcs))
}

/// Shares of C and C+, rounded.
fn units(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    null: &[f64],
    [least, most]: [f32; 2],
) -> Vec<VerticalUnit> {
    let n = airframe.units.len();
    let Effectiveness {
        matrix,
        pseudo_inverse,
        ..
    } = effectiveness;
    let units = airframe.units.iter().zip(null).enumerate();
    units
        .map(|(i, (unit, &null))| VerticalUnit {
            allocation: [0, 1, 3].map(|axis| pseudo_inverse[(i, axis)] as f32),
            arms: [0, 1].map(|axis| matrix[(axis, i)] as f32),
            spin: matrix[(2, n + i)] as f32,
            null: null as f32,
            per_null: if null == 0.0 { 0.0 } else { (1.0 / null) as f32 },
            ends: if null < 0.0 { [most, least] } else { [least, most] },
            channels: [unit.upper_channel as u8, unit.lower_channel as u8],
        })
        .collect()
}

/// Points `[f, Q]` of the edge of the throttle box from `from` to `to`.
fn points(pair: &PairMap, from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
    (0..=SAMPLES)
        .map(|k| {
            let share = k as f64 / SAMPLES as f64;
            pair.efforts(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
        })
        .collect()
}

/// The lines of [`Border::quadrangle`]: through the corners of the attainable set, moved inwards where its border bends
/// inwards. Where Q does not grow as it does along the edges of usual pairs, a line that no thrust satisfies.
fn quadrangle(pair: &PairMap) -> [[f32; 2]; 4] {
    let [low, high] = pair.range();
    let margin = MARGIN * pair.scale()[0];
    // Towards more thrust at the first two edges, less at the others; all with Q growing.
    let edges = [
        ([low, low], [low, high], 1.0),
        ([high, low], [low, low], 1.0),
        ([high, high], [low, high], -1.0),
        ([high, low], [high, high], -1.0),
    ];
    edges.map(|(from, to, inwards)| {
        let points = points(pair, from, to);
        let (first, last) = (points[0], points[SAMPLES]);
        let slope = (last[0] - first[0]) / (last[1] - first[1]);
        if last[1] <= first[1] || !slope.is_finite() {
            return [inwards as f32 * f32::MAX, 0.0];
        }
        let offsets = points.iter().map(|[f, q]| inwards * (f - slope * q));
        let offset = inwards * (offsets.fold(f64::NEG_INFINITY, f64::max) + margin);
        [offset as f32, slope as f32]
    })
}

/// The arc of the edge from `from` to `to` for `sign` Q, lowered by its error; `None` where f does not grow along the
/// edge or no arc is close.
fn arc(pair: &PairMap, from: [f64; 2], to: [f64; 2], sign: f64) -> Option<Arc> {
    let points: Vec<[f64; 2]> = points(pair, from, to)
        .iter()
        .map(|[f, q]| [*f, sign * q])
        .collect();
    if points.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
        return None;
    }
    let (first, last) = (points[0][0], points[SAMPLES][0]);
    let span = last - first;
    // The radicand at the edge's start runs from next to nothing, where f hardly grows at first, to ten times the span.
    let start = |k: f64| span * libm::pow(10.0, -7.0 + 8.0 * k);
    let error = |k: f64| fit(&points, start(k) - first).map_or(f64::INFINITY, |fit| fit.error);
    let best = (0..=SHIFTS)
        .map(|k| k as f64 / SHIFTS as f64)
        .min_by(|&a, &b| error(a).total_cmp(&error(b)))?;
    let step = 1.0 / SHIFTS as f64;
    let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(1.0));
    for _ in 0..HALVINGS {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if error(a) < error(b) {
            high = b;
        } else {
            low = a;
        }
    }
    let shift = start(0.5 * (low + high)) - first;
    let Fit { coefficients, error } = fit(&points, shift)?;
    let torque = pair.scale()[1];
    if error > ARC_TOLERANCE * torque {
        return None;
    }
    let offset = coefficients[0] - (error + MARGIN * torque);
    let [slope, bend] = [coefficients[1], coefficients[2]];
    let steepness = if bend as f32 >= 0.0 {
        [slope, 0.5 * bend, shift]
    } else {
        // Its chord's. The radicand is about 1 or more.
        let rise = points[SAMPLES][1] - points[0][1];
        [rise / span, 0.0, 1.0 - first]
    };
    let [steepness_slope, steepness_bend, steepness_shift] = steepness.map(|value| value as f32);
    Some(Arc {
        offset: offset as f32,
        slope: slope as f32,
        bend: bend as f32,
        shift: shift as f32,
        steepness: Steepness {
            slope: steepness_slope,
            bend: steepness_bend,
            shift: steepness_shift,
        },
    })
}

struct Fit {
    coefficients: Vector3<f64>,
    /// Largest error, N m.
    error: f64,
}

/// Least squares of Q on 1, f, sqrt(f + shift).
fn fit(points: &[[f64; 2]], shift: f64) -> Option<Fit> {
    let terms = |f: f64| Vector3::new(1.0, f, (f + shift).max(0.0).sqrt());
    // Centred, since the three terms are nearly dependent for large shifts.
    let mean = points.iter().map(|&[f, _]| terms(f)).sum::<Vector3<f64>>() / points.len() as f64;
    let mean_q = points.iter().map(|&[_, q]| q).sum::<f64>() / points.len() as f64;
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    normal[(0, 0)] = 1.0;
    for &[f, q] in points {
        let centred = terms(f) - mean;
        normal += centred * centred.transpose();
        right += centred * (q - mean_q);
    }
    let mut coefficients = normal.lu().solve(&right)?;
    coefficients[0] = mean_q - coefficients[1] * mean[1] - coefficients[2] * mean[2];
    let error = points
        .iter()
        .map(|&[f, q]| (terms(f).dot(&coefficients) - q).abs())
        .fold(0.0, f64::max);
    error.is_finite().then_some(Fit { coefficients, error })
}

/// The facets of the zonotope of all thrusts, slopes and walls: every two units span a pair of them, or one unit and the
/// `free` axis, or both of these where the airframe serves neither roll nor pitch.
fn facets(
    columns: &[Vector3<f64>],
    free: &[Vector3<f64>],
    [least, most]: [f64; 2],
) -> (Vec<Facets>, Vec<Facets>) {
    let (mut slopes, mut walls): (Vec<Facets>, Vec<Facets>) = (Vec::new(), Vec::new());
    let (first, second) = match free {
        [] => (columns, columns),
        [_] => (columns, free),
        [first, ..] => (std::slice::from_ref(first), &free[1..]),
    };
    for (i, first) in first.iter().enumerate() {
        let later = if free.is_empty() { i + 1 } else { 0 };
        for second in &second[later..] {
            let mut normal = first.cross(second);
            let level = normal[2].abs() < 1e-9 * normal.amax();
            normal /= if level { normal.norm() } else { normal[2] };
            if level {
                normal[2] = 0.0;
            }
            if !normal.amax().is_finite() {
                continue; // the same direction twice
            }
            let mut bounds = [0.0; 2];
            for column in columns {
                let along = normal.dot(column);
                bounds[0] += (along * least).min(along * most);
                bounds[1] += (along * least).max(along * most);
            }
            let facet = Facets {
                normal: [normal[0] as f32, normal[1] as f32],
                bounds: bounds.map(|x| x as f32),
            };
            let facets = if level { &mut walls } else { &mut slopes };
            if !facets.contains(&facet) {
                facets.push(facet);
            }
        }
    }
    (slopes, walls)
}

/// Thrusts that give no roll, pitch and thrust but along the `free` axes, the largest being 1; zeros where there are
/// none.
fn null_vector(columns: &[Vector3<f64>], free: &[Vector3<f64>]) -> Vec<f64> {
    let [a, b, c, d] = &[columns, free].concat()[..] else {
        return vec![0.0; columns.len()];
    };
    let minor = |x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>| x.cross(y).dot(z);
    let null = [minor(b, c, d), -minor(a, c, d), minor(a, b, d), -minor(a, b, c)];
    let null = &null[..columns.len()];
    let largest = null.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    null.iter()
        .map(|x| x / largest)
        .map(|x| if x.abs() < NO_PART { 0.0 } else { x })
        .collect()
}

/// True where the arcs enclose no more than the attainable set, and hardly less.
fn inside(pair: &PairMap, border: &Border<SideTable>, thrust_n: [f32; 2]) -> bool {
    let torque = pair.scale()[1];
    let [least, most] = thrust_n.map(f64::from);
    let [largest_torque, least_torque] = &border.sides;
    pair.border(SAMPLES)
        .into_iter()
        .enumerate()
        .all(|(k, throttles)| {
            let [f, q] = pair.efforts(throttles);
            let f = f.clamp(least, most);
            let chord = f64::from(border.chord[0]) + f64::from(border.chord[1]) * f;
            // The first half of the border is the lower side.
            let (lost, beyond) = if k < 2 * SAMPLES {
                (-least_torque.torque(f) - q, q - chord)
            } else {
                (q - largest_torque.torque(f), chord - q)
            };
            let slack = MARGIN * torque;
            lost > -slack && lost < 2.0 * (ARC_TOLERANCE * torque + slack) && beyond < slack
        })
}
