//! The voltage correction as the runtime evaluates it.
//!
//! Points are taken over; an exponent law k = (V / Vref)^e is fitted over the range by Chebyshev
//! interpolation, since there is no power function in a mixer.

use mixer_rt::tables;

use crate::airframe::{Airframe, Voltage, VoltageLaw};
use crate::diagnostic::{Code, Diagnostic};

/// The voltage correction.
#[derive(Clone, Debug, PartialEq)]
pub struct VoltageTable {
    /// The declared range, V.
    pub range_v: [f32; 2],
    /// k_f and k_Q.
    pub laws: [LawTable; 2],
}

/// One voltage law.
#[derive(Clone, Debug, PartialEq)]
pub enum LawTable {
    /// [`tables::VoltageLaw::Polynomial`].
    Polynomial {
        /// Scale and offset of the variable.
        variable: [f32; 2],
        /// Coefficients in descending powers.
        coefficients: Vec<f32>,
    },
    /// [`tables::VoltageLaw::Points`].
    Points(Vec<[f32; 2]>),
}

impl VoltageTable {
    /// The correction as `mixer-rt` reads it.
    pub fn view(&self) -> tables::Voltage<'_> {
        let [thrust, torque] = &self.laws;
        tables::Voltage {
            range_v: self.range_v,
            thrust: thrust.view(),
            torque: torque.view(),
        }
    }
}

impl LawTable {
    fn view(&self) -> tables::VoltageLaw<'_> {
        match self {
            LawTable::Polynomial {
                variable,
                coefficients,
            } => tables::VoltageLaw::Polynomial {
                variable: *variable,
                coefficients,
            },
            LawTable::Points(points) => tables::VoltageLaw::Points(points),
        }
    }
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

/// The correction, tabulated and rounded; `None` without one.
///
/// # Errors
/// A range over which no polynomial of moderate degree follows a law.
pub fn tabulate(airframe: &Airframe) -> Result<Option<VoltageTable>, Vec<Diagnostic>> {
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
        [Ok(thrust), Ok(torque)] => Ok(Some(VoltageTable {
            range_v: voltage.range_v.map(|v| v as f32),
            laws: [thrust, torque],
        })),
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
fn tabulate_law(law: &VoltageLaw, voltage: &Voltage) -> Result<LawTable, f64> {
    if let VoltageLaw::Points(points) = law {
        let rounded = points.iter().map(|point| point.map(|x| x as f32));
        return Ok(LawTable::Points(rounded.collect()));
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
            return Ok(LawTable::Polynomial {
                variable: [2.0 / (high - low), -(high + low) / (high - low)].map(|x| x as f32),
                coefficients: coefficients.into_iter().map(|c| c as f32).collect(),
            });
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
