//! A correction as the runtime evaluates it: cubics between nodes, since there is no power function in
//! a mixer.
//!
//! Nodes are the range's ends, the reference and the points of the file. A power is interpolated with its
//! slopes at both ends of a piece (Hermite), which leaves h^4 / 384 of its largest fourth derivative;
//! pieces are divided until that is small. Points are lines, and lines are cubics.

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
    let mut nodes: Vec<f32> = inner.chain([correction.reference as f32]).collect();
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
        // Of equal ratio: a power's relative error is then the same in all.
        let [from, to] = [ends[0], ends[1]].map(f64::from);
        let mut count = 1;
        while laws
            .iter()
            .any(|law| remainder(law, from, to, count) > FIT_TOLERANCE)
        {
            count += 1;
        }
        let inside = |i: u32| (from * libm::pow(to / from, f64::from(i) / f64::from(count))) as f32;
        let mut start = ends[0];
        for i in 1..=count {
            let end = if i == count { ends[1] } else { inside(i) };
            let [thrust, torque] = laws.map(|law| cubic(law, correction.reference, [start, end]));
            table.pieces.push(tables::LawPiece {
                start,
                thrust,
                torque,
            });
            start = end;
        }
    }
    table
}

fn points(law: &Law) -> &[[f64; 2]] {
    match law {
        Law::Points(points) => points,
        Law::Exponent(_) => &[],
    }
}

/// Relative error of interpolation of a law from `from` to `to` in `count` pieces of equal ratio.
fn remainder(law: &Law, from: f64, to: f64, count: u32) -> f64 {
    let Law::Exponent(e) = law else { return 0.0 };
    // Over the factor at the piece's start, the least: powers grow.
    let ratio = libm::pow(to / from, 1.0 / f64::from(count));
    let fourth = (e * (e - 1.0) * (e - 2.0) * (e - 3.0)).abs() * libm::pow(ratio, e - 4.0).max(1.0);
    libm::pow(ratio - 1.0, 4.0) / 384.0 * fourth
}

/// A law between two neighbouring nodes: coefficients of x - start in descending powers.
fn cubic(law: &Law, reference: f64, ends: [f32; 2]) -> [f32; 4] {
    let [start, end] = ends.map(f64::from);
    let coefficients = match law {
        Law::Exponent(e) => {
            let width = end - start;
            let [k0, k1] = [start, end].map(|x| libm::pow(x / reference, *e));
            let [slope0, slope1] = [e * k0 / start, e * k1 / end];
            let chord = (k1 - k0) / width;
            let third = (slope0 + slope1 - 2.0 * chord) / (width * width);
            let second = (3.0 * chord - 2.0 * slope0 - slope1) / width;
            [third, second, slope0, k0]
        }
        Law::Points(_) => {
            let Line { x0, k0, slope } = line(points(law), 0.5 * (start + end));
            [0.0, 0.0, slope, k0 + slope * (start - x0)]
        }
    };
    coefficients.map(|c| c as f32)
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

    #[test]
    fn factors_are_one_at_the_reference() {
        let laws = [Law::Exponent(1.75), Law::Exponent(1.9)];
        for reference in [12.8, 14.8, 15.3, 16.8] {
            let table = tabulate(&Correction::of(reference, [12.8, 16.8], laws.clone()));
            let at = table.view().factors(table.reference);
            // Within f32's rounding of the reference itself; exactly 1 where it starts a piece.
            assert!(at.iter().all(|k| (k - 1.0).abs() < 3e-7), "{reference}: {at:?}");
        }
    }
}
