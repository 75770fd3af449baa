//! Level flight, with thrust and no torque: throttles and electrical power against thrust, and
//! throttles in hover against voltage, by the compiled mixer itself.

use crate::report::study::{Condition, Study};

/// Voltages at which hover is looked at.
const VOLTAGES: usize = 41;

/// Level flight at one thrust or voltage.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Total thrust, N, or voltage, V.
    pub at: f64,
    /// Mean throttle of each of the airframe's layers of rotors; NaN where the thrust is not delivered.
    pub throttles: Vec<f64>,
    /// Electrical power of all rotors at the reference voltage, W; NaN where the thrust is not
    /// delivered, or the file has no power map.
    pub power_w: f64,
}

/// Level flight at `count` thrusts from the floor to the ceiling of the reference voltage.
pub fn against_thrust(study: &Study<'_>, voltage_v: Option<f64>, count: usize) -> Vec<Level> {
    let condition = study.at(voltage_v);
    let thrusts = study.thrusts(count);
    thrusts
        .map(|thrust_n| level(study, thrust_n, thrust_n, &condition))
        .collect()
}

/// Hover over the voltage range; empty without a mass or without an effect of voltage.
pub fn against_voltage(study: &Study<'_>) -> Vec<Level> {
    let airframe = &study.compiled.airframe;
    let (Some(weight_n), Some(voltage)) = (airframe.weight_n(), &airframe.voltage) else {
        return Vec::new();
    };
    let [low, high] = voltage.range;
    let voltages = (0..VOLTAGES).map(|k| low + (high - low) * k as f64 / (VOLTAGES - 1) as f64);
    voltages
        .map(|volts| level(study, volts, weight_n, &study.at(Some(volts))))
        .collect()
}

fn level(study: &Study<'_>, at: f64, thrust_n: f64, condition: &Condition) -> Level {
    let (throttles, delivered) = study.mix([0.0, 0.0, 0.0, thrust_n], condition);
    let airframe = &study.compiled.airframe;
    let throttles = throttles.into_iter().map(f64::from);
    let channels: Vec<f64> = throttles
        .map(|throttle| if delivered { throttle } else { f64::NAN })
        .collect();
    let mean = |(_, outputs): (_, Vec<usize>)| {
        outputs.iter().map(|output| channels[*output]).sum::<f64>() / outputs.len() as f64
    };
    Level {
        at,
        throttles: airframe.layers().map(mean).collect(),
        power_w: airframe.power_w(&channels).unwrap_or(f64::NAN),
    }
}
