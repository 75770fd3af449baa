//! Error that the corrections add to the efforts that the inverse is given.
//!
//! The mixer divides efforts by the tabulated factors, in f32. The inverse is right about efforts divided
//! by the file's. Both are enclosed by Taylor models over parts of each table's pieces, the table by
//! running `mixer-rt`'s own operations; their difference bounds the relative error of the factor.

use super::taylor::Taylor;
use crate::airframe::{Airframe, Correction, Law};
use crate::model::law::{self, CorrectionTables, LawTable, Line};

/// Bounds under all conditions, of thrust and of torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CorrectionBounds {
    /// Relative error of the efforts that the inverse is given.
    pub input: [f64; 2],
    /// Largest correction factor.
    pub largest: [f64; 2],
}

/// Unit roundoff of f32.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// Parts of a piece of a table.
const PARTS: usize = 12;

impl CorrectionBounds {
    /// The file's tolerance for one unit, `[N, N m]`, at the bench's voltage and density: what remains of it
    /// where efforts are largest.
    pub(crate) fn tolerance_at_reference(&self, airframe: &Airframe) -> [f64; 2] {
        let inverse = &airframe.inverse;
        let stated = inverse.tolerances();
        [0, 1].map(|k| stated[k] / self.largest[k])
    }

    /// Of an airframe with its tabulated corrections.
    pub(crate) fn new(airframe: &Airframe, tables: &CorrectionTables) -> Self {
        let corrections = [(&airframe.voltage, &tables.voltage), (&airframe.air, &tables.air)];
        // The request is rounded, and times 1 / 1.
        let mut input = [UNIT; 2];
        for (correction, table) in corrections {
            let (Some(correction), Some(table)) = (correction, table) else {
                continue;
            };
            let errors = relative_errors(correction, table);
            input = [0, 1].map(|k| {
                if errors[k] < 0.5 {
                    // The product of factors, its reciprocal and the product with that are rounded.
                    let of_table = errors[k] / (1.0 - errors[k]) + 3.0 * UNIT;
                    (input[k] + (1.0 + input[k]) * of_table) * (1.0 + 8.0 * UNIT)
                } else {
                    f64::INFINITY
                }
            });
        }
        CorrectionBounds {
            input,
            largest: law::largest_factors(airframe),
        }
    }
}

/// Largest relative errors of a table, of thrust and of torque.
fn relative_errors(correction: &Correction, table: &LawTable) -> [f64; 2] {
    let laws = [&correction.thrust, &correction.torque];
    let starts = table.pieces.iter().map(|piece| piece.start);
    let ends = starts.skip(1).chain([table.range[1]]);
    let mut errors = [0.0; 2];
    for (piece, end) in table.pieces.iter().zip(ends) {
        let [low, high] = [piece.start, end].map(f64::from);
        let half = 0.5 * (high - low) / PARTS as f64;
        for part in 0..PARTS {
            let centre = low + half * (2 * part + 1) as f64;
            let width = half + 4.0 * f64::EPSILON * high.abs();
            let x = Taylor::coordinate(centre, width, false);
            let given = piece.factors(x);
            for k in [0, 1] {
                let truth = truth(laws[k], correction.reference, x, [centre, width], [low, high]);
                let difference = given[k].plus(&-truth.real()).computed();
                let least = truth.range().low;
                let error = match least > 0.0 {
                    true => difference.widened(given[k].error()).magnitude() / least,
                    false => f64::INFINITY,
                };
                errors[k] = larger(errors[k], error.next_up());
            }
        }
    }
    errors
}

/// The larger, or infinity if one is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::INFINITY
    } else {
        a.max(b)
    }
}

/// The file's law over a part of a piece from `low` to `high`. Where rounding has moved the piece's ends, the
/// file is on a neighbouring line for a moment.
fn truth(law: &Law, reference: f64, x: Taylor, part: [f64; 2], [low, high]: [f64; 2]) -> Taylor {
    match law {
        Law::Exponent(exponent) => power(*exponent, reference, part),
        Law::Points(points) => {
            let Line { x0, k0, slope: along } = law::line(points, 0.5 * (low + high));
            x.plus(&Taylor::exact(-x0))
                .times(along, 4.0 * f64::EPSILON * along.abs())
                .plus(&Taylor::exact(k0))
                .widened(2.0 * law::steepest(points) * UNIT * high)
        }
    }
}

/// (x / reference)^e = k0 (1 + e d + e (e - 1) / 2 d2 + e (e - 1) (e - 2) / 6 d3 (1 + y)^(e - 3)) with d
/// = x / x0 - 1 and y between 0 and d. `libm`'s power is within one unit in the last place; eight
/// are allowed here.
fn power(e: f64, reference: f64, [centre, half]: [f64; 2]) -> Taylor {
    let k0 = libm::pow(centre / reference, e);
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
