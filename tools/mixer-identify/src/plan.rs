//! The throttle pairs that a bench has to run for a map.
//!
//! A bench that sweeps one throttle inside the other measures low throttles cold and at a full
//! battery, high ones warm and at an empty one: whatever drifts with time then looks like an effect
//! of throttle. The plan visits the cells of the grid, numbered row by row, with a constant stride
//! that is coprime to their number, so that it comes to each once. Of all strides it takes the one
//! with the least correlation, in size, of the place in the plan and of its square about the middle
//! with any term of the cubic basis: a drift of up to second order then leaves the terms alone.

use std::fmt::Write as _;

use mixer_compiler::airframe::Basis;

use crate::fit::basis::monomials;
use crate::statistics::dot;

/// The throttles `[u, l]` that correct a prediction (`identify --prior`): both rotors at half and at
/// full thrust, and either one far above the other.
pub const CORRECTING: [[f64; 2]; 4] = [[0.6, 0.6], [0.95, 0.4], [0.4, 0.95], [0.95, 0.95]];

/// The throttles `[u, l]` in the order of the plan: each of `levels` x `levels` pairs once.
pub fn plan(levels: usize, min: f64, max: f64) -> Vec<[f64; 2]> {
    let count = levels * levels;
    let level = |k: usize| {
        let exact = min + (max - min) * k as f64 / (levels - 1) as f64;
        (1e4 * exact).round() / 1e4
    };
    let with_stride = |stride: usize| -> Vec<[f64; 2]> {
        let cells = (0..count).map(|k| k * stride % count);
        cells
            .map(|cell| [level(cell / levels), level(cell % levels)])
            .collect()
    };
    let coprime = (1..count).filter(|&stride| gcd(stride, count) == 1);
    let best = coprime.min_by(|&a, &b| drift(&with_stride(a)).total_cmp(&drift(&with_stride(b))));
    with_stride(best.unwrap_or(1))
}

/// The pairs with two rows at rest before, in the middle and after: they tell the tare and its drift.
pub fn with_rests(pairs: &[[f64; 2]]) -> Vec<[f64; 2]> {
    const REST: [[f64; 2]; 2] = [[0.0; 2]; 2];
    let (before, after) = pairs.split_at(pairs.len() / 2);
    [&REST, before, &REST, after, &REST].concat()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The greatest correlation, in size, of a drift of first or second order in time with a term of
/// the cubic basis.
pub fn drift(pairs: &[[f64; 2]]) -> f64 {
    let middle = 0.5 * (pairs.len() - 1) as f64;
    let time: Vec<f64> = (0..pairs.len()).map(|k| k as f64 - middle).collect();
    let square: Vec<f64> = time.iter().map(|t| t * t).collect();
    let rows: Vec<Vec<f64>> = pairs
        .iter()
        .map(|&[u, l]| monomials(Basis::Cubic, u, l))
        .collect();
    let terms = 0..Basis::Cubic.exponents().len();
    let columns = terms.map(|term| rows.iter().map(|row| row[term]).collect::<Vec<f64>>());
    columns.fold(0.0, |worst, column| {
        worst
            .max(correlation(&time, &column).abs())
            .max(correlation(&square, &column).abs())
    })
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let centred = |x: &[f64]| -> Vec<f64> {
        let mean = x.iter().sum::<f64>() / x.len() as f64;
        x.iter().map(|x| x - mean).collect()
    };
    let (a, b) = (centred(a), centred(b));
    dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt()
}

/// The columns to fill in behind the throttles. Voltage and current are for the supply's sag and
/// for the power map, temperature and pressure of the air for its density; they may stay empty.
const TO_FILL: [&str; 8] = [
    "thrust_n",
    "torque_nm",
    "upper_voltage_v",
    "lower_voltage_v",
    "upper_current_a",
    "lower_current_a",
    "temperature_c",
    "pressure_hpa",
];

/// A CSV to fill in: throttles, or speeds in whole revolutions per minute where that at full throttle
/// is given.
pub fn template(pairs: &[[f64; 2]], full_rpm: Option<f64>) -> String {
    let unit = if full_rpm.is_some() { "_rpm" } else { "" };
    let mut text = format!("upper{unit},lower{unit},{}\n", TO_FILL.join(","));
    for pair in pairs {
        let [u, l] = pair.map(|throttle| match full_rpm {
            Some(full) => (throttle * full).round().to_string(),
            None => format!("{throttle:?}"),
        });
        let _ = writeln!(text, "{u},{l}{}", ",".repeat(TO_FILL.len()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_is_run_once_and_drift_averages_out() {
        for levels in 4..=20 {
            let pairs = plan(levels, 0.07, 1.0);
            let mut sorted = pairs.clone();
            sorted.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            let raster: Vec<[f64; 2]> = {
                let mut levels: Vec<f64> = sorted.iter().map(|[u, _]| *u).collect();
                levels.dedup();
                levels
                    .iter()
                    .flat_map(|&u| levels.iter().map(move |&l| [u, l]))
                    .collect()
            };
            assert_eq!(sorted, raster, "{levels}");
            assert_eq!(
                (sorted[0], sorted[levels * levels - 1]),
                ([0.07, 0.07], [1.0, 1.0])
            );
            let (ours, swept) = (drift(&pairs), drift(&raster));
            assert!(
                ours < if levels == 4 { 0.23 } else { 0.14 } && swept > 0.95,
                "{levels}: {ours} {swept}"
            );
        }
    }
}
