//! What the voltage correction adds to the efforts that the inverse is given.
//!
//! The mixer divides efforts by the tabulated k, in f32. The inverse is right about efforts divided
//! by the file's k. Both are enclosed by Taylor models over pieces of the voltage range, the table
//! by running `mixer-rt`'s own operations; their difference bounds the relative error of k.

use mixer_rt::tables::VoltageLaw as Law;

use super::taylor::Taylor;
use crate::airframe::{Airframe, VoltageLaw};
use crate::model::voltage::{LawTable, VoltageTable};

/// Bounds over the voltage range, of thrust and of torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CorrectionBounds {
    /// Relative error of the efforts that the inverse is given.
    pub input: [f64; 2],
    /// Largest correction factor.
    pub largest: [f64; 2],
}

/// Unit roundoff of f32.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// Pieces of the range, or of a line between two points.
const PIECES: usize = 24;

impl CorrectionBounds {
    /// The file's tolerance for one unit, `[N, N m]`, at the reference voltage: what remains of it at
    /// the voltage where efforts are largest.
    pub(crate) fn tolerance_at_reference(&self, airframe: &Airframe) -> [f64; 2] {
        let inverse = &airframe.inverse;
        let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
        [0, 1].map(|k| stated[k] / self.largest[k])
    }

    /// Of an airframe with its tabulated correction.
    pub(crate) fn new(airframe: &Airframe, table: Option<&VoltageTable>) -> Self {
        let (Some(voltage), Some(table)) = (&airframe.voltage, table) else {
            // The request is rounded, and times 1 / 1.
            return CorrectionBounds {
                input: [UNIT; 2],
                largest: [1.0; 2],
            };
        };
        let range = table.range_v.map(f64::from);
        let laws = [&voltage.thrust, &voltage.torque];
        let bounds = [0, 1].map(|k| match &table.laws[k] {
            LawTable::Polynomial {
                variable,
                coefficients,
            } => over(range, |volts, span| Piece {
                truth: truth(laws[k], voltage.reference_v, span),
                table: Law::polynomial(*variable, coefficients, volts),
            }),
            LawTable::Points(points) => between_points(laws[k], points, range),
        });
        CorrectionBounds {
            // The request, the reciprocal of k and the product are rounded.
            input: bounds.map(|bound| {
                let table = bound.error / (1.0 - bound.error);
                if bound.error < 0.5 {
                    (3.0 * UNIT + table) * (1.0 + 8.0 * UNIT)
                } else {
                    f64::INFINITY
                }
            }),
            largest: bounds.map(|bound| bound.largest),
        }
    }
}

/// A law and its table over one piece of the range.
struct Piece {
    truth: Taylor,
    table: Taylor,
}

/// Relative error of a table and its law's largest value.
#[derive(Clone, Copy, Debug)]
struct Bound {
    error: f64,
    largest: f64,
}

impl Bound {
    fn join(self, other: Bound) -> Bound {
        Bound {
            error: larger(self.error, other.error),
            largest: larger(self.largest, other.largest),
        }
    }
}

/// The larger, or infinity if one is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}

/// Piece by piece over `[low, high]` V; `piece` is given the voltage and the piece's centre and
/// half width.
fn over([low, high]: [f64; 2], piece: impl Fn(Taylor, [f64; 2]) -> Piece) -> Bound {
    let half = 0.5 * (high - low) / PIECES as f64;
    let none = Bound {
        error: 0.0,
        largest: 0.0,
    };
    (0..PIECES).fold(none, |bound, index| {
        let centre = low + half * (2 * index + 1) as f64;
        let width = half + 4.0 * f64::EPSILON * high.abs();
        let Piece { truth, table } = piece(Taylor::coordinate(centre, width, false), [centre, width]);
        let difference = table.plus(&-truth.real()).computed();
        let range = truth.range();
        let error = if range.low > 0.0 {
            difference.widened(table.error()).magnitude() / range.low
        } else {
            f64::INFINITY
        };
        bound.join(Bound {
            error: error.next_up(),
            largest: range.high,
        })
    })
}

/// The file's law over a piece. Points are handled by [`between_points`].
fn truth(law: &VoltageLaw, reference_v: f64, [centre, half]: [f64; 2]) -> Taylor {
    match law {
        VoltageLaw::Exponent(exponent) => power(*exponent, reference_v, centre, half),
        VoltageLaw::Points(_) => Taylor::ball(f64::INFINITY),
    }
}

/// (V / Vref)^e = k0 (1 + e d + e (e - 1) / 2 d2 + e (e - 1) (e - 2) / 6 d3 (1 + x)^(e - 3)) with d
/// = V / V0 - 1 and x between 0 and d. `libm`'s power is within one unit in the last place; eight
/// are allowed here.
fn power(e: f64, reference_v: f64, centre: f64, half: f64) -> Taylor {
    let k0 = libm::pow(centre / reference_v, e);
    let d = half / centre;
    let mut growth = 1.0;
    let mut exponent = (e - 3.0).abs();
    while exponent > 0.0 {
        growth /= 1.0 - d;
        exponent -= 1.0;
    }
    let rest = (e * (e - 1.0) * (e - 2.0) / 6.0).abs() * d * d * d * growth;
    let rounding = (8.0 + 4.0 * e.abs()) * f64::EPSILON;
    let coefficients = [k0, k0 * e * d, 0.0, k0 * 0.5 * e * (e - 1.0) * d * d, 0.0, 0.0];
    Taylor::new(coefficients, k0 * (rest * 1.0001 + rounding))
}

/// Every line of the table against the line of the file. Where rounding has moved a corner, the
/// file is on the neighbouring line for a moment.
fn between_points(law: &VoltageLaw, table: &[[f32; 2]], [low, high]: [f64; 2]) -> Bound {
    let mut bound = Bound {
        error: 0.0,
        largest: 0.0,
    };
    let VoltageLaw::Points(points) = law else {
        return Bound {
            error: f64::INFINITY,
            largest: f64::INFINITY,
        };
    };
    let slope = |line: &[[f64; 2]]| (line[1][1] - line[0][1]) / (line[1][0] - line[0][0]);
    let steepest = points
        .windows(2)
        .map(|line| slope(line).abs())
        .fold(0.0, f64::max);
    let last = points.len().saturating_sub(2);
    for (index, (line, rounded)) in points.windows(2).zip(table.windows(2)).enumerate() {
        // The first line serves below its points, the last one above.
        let from = if index == 0 {
            low
        } else {
            f64::from(rounded[0][0]).max(low)
        };
        let to = if index == last {
            high
        } else {
            f64::from(rounded[1][0]).min(high)
        };
        if from > to {
            continue;
        }
        let astray = (line[0][0] - from).max(to - line[1][0]).max(0.0);
        let along = slope(line);
        bound = bound.join(over([from, to], |volts, _| Piece {
            truth: volts
                .plus(&Taylor::exact(-line[0][0]))
                .times(along, 4.0 * f64::EPSILON * along.abs())
                .plus(&Taylor::exact(line[0][1]))
                .widened(2.0 * steepest * astray),
            table: Law::line(rounded[0], rounded[1], volts),
        }));
    }
    bound
}
