//! Electrical power in level flight and its saving by the power bias, by the mixer itself and the
//! file's power map.

use mixer_rt::Wrench;
use serde::Serialize;

use crate::compiled::Compiled;
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::tables::MixerTables;

/// Share of the largest bare thrust at which vehicles without a mass are looked at.
const LEVEL: f64 = 0.5;

/// Power in level flight at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelPower {
    /// The weight; without a mass half of the largest bare thrust, N.
    pub thrust_n: f64,
    /// Electrical power of all rotors, W.
    pub power_w: f64,
    /// The same with all torques zero, W.
    pub without_bias_w: f64,
    /// The saving by the bias, percent of it.
    pub saving_percent: f64,
    /// By how much longer the flight is, percent.
    pub flight_time_percent: f64,
    /// Whether the thrust is the vehicle's weight.
    pub is_hover: bool,
}

impl LevelPower {
    /// Of a compiled airframe; `None` where the file has no power map, or the thrust is not
    /// attainable.
    pub fn new(compiled: &Compiled) -> Option<LevelPower> {
        let weight = compiled.airframe.weight_n();
        let thrust_n = weight.unwrap_or(LEVEL * f64::from(compiled.thrust_range_n[1]));
        let power_w = at(compiled, &compiled.tables, thrust_n)?;
        let without_bias_w = at(compiled, &compiled.tables.without_power_bias(), thrust_n)?;
        Some(LevelPower {
            thrust_n,
            power_w,
            without_bias_w,
            saving_percent: 100.0 * (1.0 - power_w / without_bias_w),
            flight_time_percent: 100.0 * (without_bias_w / power_w - 1.0),
            is_hover: weight.is_some(),
        })
    }
}

/// Share of the power without a bias by which a bias may cost, for what the power map misses.
const COSTS: f64 = 0.002;

/// Warns of a power bias that costs power at the vehicle's weight: the best number for the mean of
/// hovers at 0.3 to 0.7 of full thrust need not be the best at one of them.
pub(crate) fn warnings(compiled: &Compiled) -> Option<Diagnostic> {
    let airframe = &compiled.airframe;
    let bias = airframe.allocation.power_bias_nm_per_n;
    if bias == 0.0 {
        return None;
    }
    let level = LevelPower::new(compiled).filter(|level| level.is_hover)?;
    if level.power_w <= (1.0 + COSTS) * level.without_bias_w {
        return None;
    }
    Some(airframe.diagnostic(
        Code::PowerBiasCosts,
        "allocation.power_bias_nm_per_n",
        format!(
            "a power bias of {} N m per N takes {} W in hover at {} N, {} W without it: {:+.1} %",
            number(bias),
            rounded(level.power_w),
            rounded(level.thrust_n),
            rounded(level.without_bias_w),
            -level.saving_percent
        ),
        "costs flight time",
        "remove it, or choose a smaller one: `cargo mixer check --verbose` says what it saves",
    ))
}

/// Power of all rotors at a level thrust, W; `None` where it is not delivered.
fn at(compiled: &Compiled, tables: &MixerTables, thrust_n: f64) -> Option<f64> {
    let setpoint = Wrench {
        thrust_n: thrust_n as f32,
        ..Wrench::default()
    };
    let airframe = &compiled.airframe;
    let (throttle, _, saturation) = tables.mix(&setpoint, airframe.reference_v() as f32).ok()?;
    let throttle: Vec<f64> = throttle.into_iter().map(f64::from).collect();
    airframe.power_w(&throttle).filter(|_| !saturation.any_axis())
}
