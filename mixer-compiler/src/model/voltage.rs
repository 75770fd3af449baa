//! The voltage correction as the runtime evaluates it.
//!
//! Points are taken over; an exponent law k = (V / Vref)^e is fitted over the range by Chebyshev
//! interpolation, since there is no power function in a mixer.

use crate::airframe::{Airframe, Voltage, VoltageLaw};
use crate::diagnostic::{Code, Diagnostic};

/// A law as the runtime evaluates it, in f64.
#[derive(Clone, Debug, PartialEq)]
pub enum TabulatedLaw {
    /// Coefficients in descending powers of a variable that runs through [-1, 1] over the range.
    Polynomial(Vec<f64>),
    /// Points `[volts, k]`, ascending.
    Points(Vec<[f64; 2]>),
}

/// Largest relative error of a fitted law: 2.5 uN of 25 N, about what f32 rounds off.
pub(crate) const FIT_TOLERANCE: f64 = 1e-7;

/// Highest degree that is tried.
const HIGHEST_FITTED_DEGREE: usize = 12;

/// Largest correction factors `[k_f, k_Q]` over the range; `[1, 1]` without a correction. Laws of
/// exponents grow, those of points bend at points alone.
pub(crate) fn largest_factors(airframe: &Airframe) -> [f64; 2] {
    let Some(voltage) = &airframe.voltage else {
        return [1.0; 2];
    };
    let [low, high] = voltage.range_v;
    [&voltage.thrust, &voltage.torque].map(|law| {
        let points = match law {
            VoltageLaw::Points(points) => points.as_slice(),
            VoltageLaw::Exponent(_) => &[],
        };
        let inner = points
            .iter()
            .map(|point| point[0])
            .filter(|v| (low..=high).contains(v));
        let factors = inner
            .chain([low, high])
            .map(|volts| law.factor(volts, voltage.reference_v));
        factors.fold(0.0, f64::max)
    })
}

/// The laws of thrust and torque, tabulated; `None` without a correction.
///
/// # Errors
/// A range over which no polynomial of moderate degree follows a law.
pub fn tabulate(airframe: &Airframe) -> Result<Option<[TabulatedLaw; 2]>, Vec<Diagnostic>> {
    let Some(voltage) = &airframe.voltage else {
        return Ok(None);
    };
    let fault = |key: &str, error: f64| {
        airframe.diagnostic(
            Code::VoltageTable,
            key,
            format!("no polynomial up to degree {HIGHEST_FITTED_DEGREE} follows this law within {FIT_TOLERANCE:e}; the best is {error:.1e} off"),
            "",
            "narrow voltage.range_v to the voltages of the pack, or give points",
        )
    };
    match [&voltage.thrust, &voltage.torque].map(|law| tabulate_law(law, voltage)) {
        [Ok(thrust), Ok(torque)] => Ok(Some([thrust, torque])),
        laws => {
            let keys = ["voltage.thrust_exponent", "voltage.torque_exponent"].into_iter();
            let faults = keys
                .zip(laws)
                .filter_map(|(key, law)| Some(fault(key, law.err()?)));
            Err(faults.collect())
        }
    }
}

/// One law, or the relative error of the best polynomial.
fn tabulate_law(law: &VoltageLaw, voltage: &Voltage) -> Result<TabulatedLaw, f64> {
    if let VoltageLaw::Points(points) = law {
        return Ok(TabulatedLaw::Points(points.clone()));
    }
    let [low, high] = voltage.range_v;
    let factor = |x: f64| law.factor(0.5 * (low + high) + 0.5 * (high - low) * x, voltage.reference_v);
    let mut best = f64::INFINITY;
    for degree in 0..=HIGHEST_FITTED_DEGREE {
        let coefficients = interpolate(&factor, degree);
        let error = (0..=64)
            .map(|k| f64::from(k) / 32.0 - 1.0)
            .map(|x| (coefficients.iter().fold(0.0, |value, c| value * x + c) / factor(x) - 1.0).abs())
            .fold(0.0, f64::max);
        best = best.min(error);
        if error <= FIT_TOLERANCE {
            return Ok(TabulatedLaw::Polynomial(coefficients));
        }
    }
    Err(best)
}

/// Interpolates at Chebyshev's nodes: Newton's divided differences, expanded to descending powers.
fn interpolate(function: &dyn Fn(f64) -> f64, degree: usize) -> Vec<f64> {
    let count = degree + 1;
    let node = |k: usize| libm::cos(std::f64::consts::PI * (k as f64 + 0.5) / count as f64);
    let nodes: Vec<f64> = (0..count).map(node).collect();
    let mut differences: Vec<f64> = nodes.iter().map(|&x| function(x)).collect();
    for order in 1..count {
        for k in (order..count).rev() {
            differences[k] = (differences[k] - differences[k - 1]) / (nodes[k] - nodes[k - order]);
        }
    }
    // Horner on the Newton form: p <- p (x - node) + difference, ascending powers.
    let mut ascending = vec![0.0; count];
    for k in (0..count).rev() {
        for i in (0..count).rev() {
            let carried = if i > 0 { ascending[i - 1] } else { 0.0 };
            ascending[i] = carried - nodes[k] * ascending[i];
        }
        ascending[0] += differences[k];
    }
    ascending.reverse();
    ascending
}
