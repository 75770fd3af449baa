//! The table of `mixer-rt`'s shorter way to desaturate, for three or four units with vertical axes.
//!
//! On an edge of the throttle box both efforts are polynomials of one throttle t. For the biquadratic basis they
//! are quadratic, f = A t^2 + B t + C, so t is a square root of f and Q a combination of 1, f and
//! sqrt(f + B^2 / 4A - C). For the other bases such a combination is fitted and shifted to the inner side. The
//! shift under the root is searched for, the rest is least squares.

use mixer_rt::{Airmode, Arc, Axis, Facets, Side};
use nalgebra::{Matrix3, Vector3};

use crate::airframe::Airframe;
use crate::effectiveness::Effectiveness;
use crate::model::PairMap;
use crate::tables::VerticalTable;

/// Points per edge at which an arc is fitted and checked.
const SAMPLES: usize = 48;

/// Largest distance of an arc from its edge, as a share of the largest torque: costs 0.2 % of the area at most.
const ARC_TOLERANCE: f64 = 1e-3;

/// What an arc keeps from its edge for rounding, as a share of the largest torque.
const MARGIN: f64 = 2e-6;

/// Of sums of a few f32 products.
const ROUNDING: f32 = 1e-6;

/// Shifts tried on a logarithmic scale, and halvings of the best interval.
const SHIFTS: usize = 40;
const HALVINGS: usize = 24;

/// The table, where the layout and the priorities allow the shorter way.
pub(crate) fn table(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    [floor, ceiling]: [f32; 2],
) -> Option<VerticalTable> {
    let n = airframe.units.len();
    let allocation = &airframe.allocation;
    let matrix = &effectiveness.matrix;
    let vertical = (0..n).all(|i| {
        matrix[(2, i)] == 0.0
            && matrix[(0, n + i)] == 0.0
            && matrix[(1, n + i)] == 0.0
            && matrix[(2, n + i)].abs() == 1.0
    });
    // A reserve or yaw before thrust would couple the two small problems.
    let decoupled = allocation.yaw_reserve_nm == 0.0 && allocation.airmode != Airmode::RollPitchYaw;
    if !vertical || !decoupled || !(3..=4).contains(&n) || allocation.axes.len() < Axis::ALL.len() {
        return None;
    }
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let [low, high] = pair.range();
    let edge = |from: [f64; 2], to: [f64; 2], side: f64| arc(&pair, from, to, side);
    let least_torque = Side {
        corner_n: pair.efforts([high, low])[0] as f32,
        arcs: [
            edge([low, low], [high, low], 1.0)?,
            edge([high, low], [high, high], 1.0)?,
        ],
    };
    let largest_torque = Side {
        corner_n: pair.efforts([low, high])[0] as f32,
        arcs: [
            edge([low, low], [low, high], -1.0)?,
            edge([low, high], [high, high], -1.0)?,
        ],
    };
    let columns: Vec<Vector3<f64>> = (0..n)
        .map(|i| Vector3::new(matrix[(0, i)], matrix[(1, i)], matrix[(3, i)]))
        .collect();
    let [least, most] = [pair.efforts([low, low])[0], pair.efforts([high, high])[0]];
    // f32 rounding, inwards.
    let thrust_n = [(least as f32).next_up(), (most as f32).next_down()];
    let facets = facets(&columns, thrust_n.map(f64::from));
    // The floor was mixed on the polygon: at least what the facets allow without roll and pitch, with rounding.
    let level = facets.iter().filter(|facets| facets.normal[2] != 0.0);
    let least_level = level.map(|facets| facets.bounds[0]).fold(floor, f32::max);
    let table = VerticalTable {
        thrust_n,
        least_torque,
        largest_torque,
        facets,
        null: null_vector(&columns),
        thrust_floor_n: least_level * (1.0 + ROUNDING),
        thrust_middle_n: 0.5 * (floor + ceiling),
    };
    inside(&pair, &table).then_some(table)
}

/// The arc of the edge from `from` to `to`, moved by its error to the side of +Q (1) or -Q (-1); `None` where f
/// does not grow along the edge or no arc is close.
fn arc(pair: &PairMap, from: [f64; 2], to: [f64; 2], side: f64) -> Option<Arc> {
    let points: Vec<[f64; 2]> = (0..=SAMPLES)
        .map(|k| {
            let share = k as f64 / SAMPLES as f64;
            pair.efforts(std::array::from_fn(|i| from[i] + share * (to[i] - from[i])))
        })
        .collect();
    if points.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
        return None;
    }
    let (first, last) = (points[0][0], points[SAMPLES][0]);
    let span = last - first;
    // The radicand at the edge's start runs from a thousandth of the span to some ten times the span.
    let start = |k: f64| span * libm::pow(10.0, -3.0 + 4.0 * k);
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
    let offset = coefficients[0] + side * (error + MARGIN * torque);
    Some(Arc {
        offset: offset as f32,
        slope: coefficients[1] as f32,
        bend: coefficients[2] as f32,
        shift: shift as f32,
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

/// The facets of the zonotope of all thrusts: every two units span a pair of them.
fn facets(columns: &[Vector3<f64>], [least, most]: [f64; 2]) -> Vec<Facets> {
    let mut facets: Vec<Facets> = Vec::new();
    for (i, first) in columns.iter().enumerate() {
        for second in &columns[i + 1..] {
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
                normal: std::array::from_fn(|k| normal[k] as f32),
                bounds: bounds.map(|x| x as f32),
            };
            if !facets.contains(&facet) {
                facets.push(facet);
            }
        }
    }
    facets
}

/// Thrusts that give no roll, pitch and thrust, the largest being 1; zeros for three units.
fn null_vector(columns: &[Vector3<f64>]) -> Vec<f32> {
    let [a, b, c, d] = columns else {
        return vec![0.0; columns.len()];
    };
    let minor = |x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>| x.cross(y).dot(z);
    let null = [minor(b, c, d), -minor(a, c, d), minor(a, b, d), -minor(a, b, c)];
    let largest = null.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    null.iter().map(|x| (x / largest) as f32).collect()
}

/// True where the arcs enclose no more than the attainable set, and hardly less.
fn inside(pair: &PairMap, table: &VerticalTable) -> bool {
    let at = |arc: &Arc, f: f64| {
        f64::from(arc.offset)
            + f64::from(arc.slope) * f
            + f64::from(arc.bend) * (f + f64::from(arc.shift)).max(0.0).sqrt()
    };
    let torque = pair.scale()[1];
    let [least, most] = table.thrust_n.map(f64::from);
    let border = pair.border(SAMPLES);
    let side = |side: &Side, f: f64| {
        let [below, above] = &side.arcs;
        at(
            if f < f64::from(side.corner_n) {
                below
            } else {
                above
            },
            f,
        )
    };
    border.into_iter().enumerate().all(|(k, throttles)| {
        let [f, q] = pair.efforts(throttles);
        let f = f.clamp(least, most);
        // The first half of the border is the lower side.
        let lost = if k < 2 * SAMPLES {
            side(&table.least_torque, f) - q
        } else {
            q - side(&table.largest_torque, f)
        };
        lost > -MARGIN * torque && lost < 2.0 * (ARC_TOLERANCE + MARGIN) * torque
    })
}
