//! A correction as the runtime evaluates it: polynomials of degree 4 between nodes, since there is no power
//! function in a mixer.
//!
//! Nodes are the range's ends and the points of the file. A power is interpolated at Chebyshev's points; the
//! pieces between nodes are divided until that is true enough, but nearly all ranges need one. Points are
//! lines.

use mixer_rt::tables;

use crate::airframe::{Airframe, Correction, Law};

/// The correction for one measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct LawTable {
    /// The quantity on the bench.
    pub reference: f32,
    /// Its range in flight.
    pub range: [f32; 2],
    /// The pieces by ascending start.
    pub pieces: Vec<tables::LawPiece>,
}

impl LawTable {
    /// The correction as `mixer-rt` reads it.
    pub fn view(&self) -> tables::Law<'_> {
        tables::Law {
            reference: self.reference,
            range: self.range,
            pieces: &self.pieces,
        }
    }
}

/// The corrections of an airframe, each where the file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrectionTables {
    /// Of the battery's voltage, V.
    pub voltage: Option<LawTable>,
    /// Of the air's density, kg/m3.
    pub air: Option<LawTable>,
}

impl CorrectionTables {
    /// Those of `[voltage]` and `[air]`.
    pub fn new(airframe: &Airframe) -> Self {
        CorrectionTables {
            voltage: airframe.voltage.as_ref().map(tabulate),
            air: airframe.air.as_ref().map(tabulate),
        }
    }
}

/// Largest relative error of an interpolated power: 0.25 mN of 25 N.
const FIT_TOLERANCE: f64 = 1e-5;

/// Steps of a piece at whose ends it is compared with its law.
const SAMPLES: u32 = 32;

/// Largest correction factors `[k_f, k_Q]` under all conditions; `[1, 1]` without a correction. Powers
/// grow, laws of points bend at points alone.
pub(crate) fn largest_factors(airframe: &Airframe) -> [f64; 2] {
    let corrections = [&airframe.voltage, &airframe.air].into_iter().flatten();
    corrections.fold([1.0; 2], |product, correction| {
        let [low, high] = correction.range;
        let largest = [&correction.thrust, &correction.torque].map(|law| {
            let inner = points(law).iter().map(|point| point[0]);
            let inside = inner.filter(|x| (low..=high).contains(x)).chain([low, high]);
            let factors = inside.map(|x| law.factor(x, correction.reference));
            factors.fold(0.0, f64::max)
        });
        [0, 1].map(|k| product[k] * largest[k])
    })
}

/// The correction, tabulated and rounded.
fn tabulate(correction: &Correction) -> LawTable {
    let [low, high] = correction.range.map(|x| x as f32);
    let laws = [&correction.thrust, &correction.torque];
    let inner = laws.into_iter().flat_map(points).map(|point| point[0] as f32);
    let mut nodes: Vec<f32> = inner.collect();
    nodes.retain(|x| low < *x && *x < high);
    nodes.extend([low, high]);
    nodes.sort_by(f32::total_cmp);
    nodes.dedup();
    let mut table = LawTable {
        reference: correction.reference as f32,
        range: [low, high],
        pieces: Vec::new(),
    };
    for ends in nodes.windows(2) {
        push_pieces(correction, [ends[0], ends[1]], &mut table.pieces);
    }
    table
}

/// Tabulates between two neighbouring nodes: in one piece, or in two halves where that is not true enough.
fn push_pieces(correction: &Correction, [start, end]: [f32; 2], pieces: &mut Vec<tables::LawPiece>) {
    let ends = [start, end].map(f64::from);
    let laws = [&correction.thrust, &correction.torque];
    let polynomials = laws.map(|law| polynomial(law, correction.reference, ends));
    // Powers differ from their polynomials smoothly, so that a few points show it. Lines do not differ.
    let is_true = |k: usize| match laws[k] {
        Law::Points(_) => true,
        Law::Exponent(_) => (0..=SAMPLES).all(|i| {
            let along = (ends[1] - ends[0]) * f64::from(i) / f64::from(SAMPLES);
            let value = polynomials[k].iter().fold(0.0, |sum, c| sum * along + c);
            (value / laws[k].factor(ends[0] + along, correction.reference) - 1.0).abs() <= FIT_TOLERANCE
        }),
    };
    if is_true(0) && is_true(1) {
        let [thrust, torque] = polynomials.map(|coefficients| coefficients.map(|c| c as f32));
        pieces.push(tables::LawPiece {
            start,
            thrust,
            torque,
        });
    } else {
        let middle = (0.5 * (ends[0] + ends[1])) as f32;
        push_pieces(correction, [start, middle], pieces);
        push_pieces(correction, [middle, end], pieces);
    }
}

fn points(law: &Law) -> &[[f64; 2]] {
    match law {
        Law::Points(points) => points,
        Law::Exponent(_) => &[],
    }
}

/// Points at which a power is interpolated.
const POINTS: usize = 5;

/// A law between two neighbouring nodes: coefficients of x - start in descending powers.
fn polynomial(law: &Law, reference: f64, [start, end]: [f64; 2]) -> [f64; POINTS] {
    match law {
        Law::Exponent(e) => {
            let half = 0.5 * (end - start);
            let point =
                |k: usize| half - half * libm::cos(std::f64::consts::PI * (k as f64 + 0.5) / POINTS as f64);
            let points: [f64; POINTS] = std::array::from_fn(point);
            interpolated(
                &points,
                points.map(|along| libm::pow((start + along) / reference, *e)),
            )
        }
        Law::Points(_) => {
            let Line { x0, k0, slope } = line(points(law), 0.5 * (start + end));
            [0.0, 0.0, 0.0, slope, k0 + slope * (start - x0)]
        }
    }
}

/// The polynomial through values at points, in descending powers: Newton's divided differences, expanded.
fn interpolated(points: &[f64; POINTS], values: [f64; POINTS]) -> [f64; POINTS] {
    let mut differences = values;
    for order in 1..POINTS {
        for k in (order..POINTS).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (points[k] - points[k - order]);
        }
    }
    let mut descending = [0.0; POINTS];
    for k in (0..POINTS).rev() {
        // Times x - point, plus the difference.
        for i in 0..POINTS {
            let carried = descending.get(i + 1).copied().unwrap_or(differences[k]);
            descending[i] = carried - points[k] * descending[i];
        }
    }
    descending
}

/// A straight line k0 + slope (x - x0).
pub(crate) struct Line {
    pub(crate) x0: f64,
    pub(crate) k0: f64,
    pub(crate) slope: f64,
}

impl Line {
    fn through([x0, k0]: [f64; 2], [x1, k1]: [f64; 2]) -> Line {
        let slope = (k1 - k0) / (x1 - x0);
        Line { x0, k0, slope }
    }
}

/// The line of the points that `x` is on: rounding has moved the nodes, so a piece is told by its middle.
pub(crate) fn line(points: &[[f64; 2]], x: f64) -> Line {
    let after = points.partition_point(|point| point[0] <= x);
    let after = after.clamp(1, points.len() - 1);
    Line::through(points[after - 1], points[after])
}

/// The steepest of the lines between points, without its sign.
pub(crate) fn steepest(points: &[[f64; 2]]) -> f64 {
    let slopes = points
        .windows(2)
        .map(|pair| Line::through(pair[0], pair[1]).slope.abs());
    slopes.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factors of the table, as the mixer computes them, against the file's, densely.
    fn largest_error(correction: &Correction) -> f64 {
        let table = tabulate(correction);
        let [low, high] = table.range.map(f64::from);
        let steps = 20_000;
        let at = |step: u32| (low + (high - low) * f64::from(step) / f64::from(steps)) as f32;
        let errors = (0..=steps).map(at).map(|x| {
            let given = table.view().factors(x.clamp(table.range[0], table.range[1]));
            let file = correction.factors(f64::from(x));
            let error = |k: usize| (f64::from(given[k]) / file[k] - 1.0).abs();
            error(0).max(error(1))
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn tables_follow_their_laws() {
        let pack = |reference: f64, range: [f64; 2], e: f64| {
            Correction::of(reference, range, [Law::Exponent(e), Law::Exponent(0.9 * e)])
        };
        for e in [0.0, 0.3, 0.75, 1.0, 1.5, 1.75, 2.0, 2.7, 3.5, 4.0] {
            for (reference, range) in [(14.8, [12.8, 16.8]), (14.8, [3.0, 40.0]), (1.204, [0.6, 1.4])] {
                let error = largest_error(&pack(reference, range, e));
                assert!(error < 1.2e-5, "{e} over {range:?}: {error}");
            }
        }
        let points = vec![[12.7, 0.77], [14.0, 0.91], [14.8, 1.0], [16.81, 1.25]];
        let correction = Correction::of(14.8, [12.8, 16.8], [Law::Points(points), Law::Exponent(1.8)]);
        assert!(largest_error(&correction) < 1.2e-5);
    }
}
