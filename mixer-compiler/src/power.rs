//! Electrical power in level flight and its saving by the power bias, by the mixer itself and the
//! file's power map; and what a rotor takes with it that stops there.

use mixer_rt::{Health, Wrench};
use serde::Serialize;

use crate::airframe::Unit;
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
    /// Share of their units' thrust that an upper and a lower rotor take with them that stop, until the
    /// mixer leaves them out, percent.
    pub stop_percent: [f64; 2],
    /// The same with all torques zero.
    pub without_bias_stop_percent: [f64; 2],
    /// Whether the thrust is the vehicle's weight.
    pub is_hover: bool,
}

impl LevelPower {
    /// Of a compiled airframe; `None` where the file has no power map, or the thrust is not
    /// attainable.
    pub fn new(compiled: &Compiled) -> Option<LevelPower> {
        let weight = compiled.airframe.weight_n();
        let thrust_n = weight.unwrap_or(LEVEL * f64::from(compiled.thrust_range_n[1]));
        let (power_w, stop_percent) = at(compiled, &compiled.tables, thrust_n)?;
        let without = compiled.tables.with_power_bias(0.0);
        let (without_bias_w, without_bias_stop_percent) = at(compiled, &without, thrust_n)?;
        Some(LevelPower {
            thrust_n,
            power_w,
            without_bias_w,
            saving_percent: 100.0 * (1.0 - power_w / without_bias_w),
            flight_time_percent: 100.0 * (without_bias_w / power_w - 1.0),
            stop_percent,
            without_bias_stop_percent,
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

/// Power of all rotors at a level thrust, W, and what an upper and a lower rotor take with them that
/// stop, percent of their units' thrust; `None` where it is not delivered.
fn at(compiled: &Compiled, tables: &MixerTables, thrust_n: f64) -> Option<(f64, [f64; 2])> {
    let setpoint = Wrench {
        thrust_n: thrust_n as f32,
        ..Wrench::default()
    };
    let airframe = &compiled.airframe;
    let (throttle, _, saturation) = tables.mix(&setpoint, airframe.reference_v() as f32).ok()?;
    let physics = compiled.physics();
    let thrust = |is_out: [bool; 2]| -> f64 {
        let of_unit = |(index, unit): (usize, &Unit)| {
            let out = unit.channels().zip(is_out).filter(|(_, is_out)| *is_out);
            let health = out.fold(Health::GOOD, |health, (channel, _)| {
                health.with_failed(channel as u8)
            });
            physics.efforts(index, &throttle, health)[0]
        };
        airframe.units.iter().enumerate().map(of_unit).sum()
    };
    let all = thrust([false; 2]);
    let stop = [[true, false], [false, true]].map(|is_out| 100.0 * (1.0 - thrust(is_out) / all));
    let each: Vec<f64> = throttle.iter().copied().map(f64::from).collect();
    let power_w = airframe.power_w(&each).filter(|_| !saturation.any_axis())?;
    Some((power_w, stop))
}
