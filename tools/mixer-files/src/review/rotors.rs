//! Rotors against their fellows, by the speeds that their controllers report.

use mixer_compiler::Compiled;
use mixer_compiler::flywheel::exponent;
use mixer_identify::lag::{Flown, in_flight};
use mixer_rt::Health;
use serde::Serialize;

use crate::review::log::median;
use crate::review::rows::{Row, Rows};

/// Ratio of speeds at one throttle within which rotors of one kind are alike: thrusts within 6 %.
const ALIKE: f64 = 0.03;

/// How long a rotor is off that has stopped, s.
const STOPPED_S: f64 = 1.0;

/// Change of all throttles for the slope of the speed.
const STEP: f32 = 0.01;

/// Speeds that are logged closer tell no more of a lag, s.
const CLOSEST_S: f64 = 0.008;

/// A rotor that stopped.
#[derive(Clone, Debug, Serialize)]
pub struct Stopped {
    /// Its output.
    pub output: usize,
    /// When, s of the log.
    pub time_s: f64,
}

/// A rotor's speed in a straight hover over that of the other upper or lower rotors at its throttle.
#[derive(Clone, Debug, Serialize)]
pub struct Speed {
    /// Its output.
    pub output: usize,
    /// The ratio.
    pub ratio: f64,
}

/// How fast rotors follow their throttles.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Lag {
    /// The lag by the logged speeds, s.
    pub lag_s: f64,
    /// Its 95 % interval by scatter, s.
    pub interval_s: [f64; 2],
    /// The throttle that it is of.
    pub throttle: f64,
    /// What `mix_dynamic` takes there, s.
    pub of_mixer_s: f64,
}

impl Lag {
    /// `None` where `mix_dynamic` is not proven, or outputs or speeds are logged more rarely than at 20 Hz.
    pub(crate) fn of(rows: &Rows, compiled: &Compiled) -> Option<Lag> {
        let airframe = &compiled.airframe;
        let taken = compiled.dynamics.as_ref()?.first()?;
        let rotor = |output: usize| {
            let values = rows
                .rows
                .iter()
                .map(|row| [row.time_s, row.throttle[output].into(), row.speeds[output]]);
            let mut rows: Vec<[f64; 3]> = Vec::new();
            // A speed is held until the next one comes; the law knows rotors that turn.
            for row in values.filter(|row| row[1] > 0.0 && row[2] > 0.0) {
                if rows
                    .last()
                    .is_none_or(|last| row[2] != last[2] && row[0] - last[0] > CLOSEST_S)
                {
                    rows.push(row);
                }
            }
            rows
        };
        let rotors: Vec<Vec<[f64; 3]>> = (0..airframe.rotors()).map(rotor).collect();
        let flown = Flown {
            exponent: exponent(airframe),
            throttle: taken.throttle,
            brakes: airframe
                .vehicle
                .as_ref()
                .is_none_or(|vehicle| vehicle.rotor_brakes),
        };
        in_flight(&rotors, flown).map(|(lag_s, interval_s)| Lag {
            lag_s,
            interval_s,
            throttle: taken.throttle,
            of_mixer_s: taken.lag_s,
        })
    }
}

impl Speed {
    pub(crate) fn is_alike(&self) -> bool {
        (self.ratio - 1.0).abs() < ALIKE
    }
}

/// Rotors that are off for [`STOPPED_S`] in the air: stock allocators take the throttle of one away for
/// shorter.
pub(crate) fn stopped(rows: &Rows) -> Vec<Stopped> {
    let outputs = rows.rows.first().map_or(0, |row| row.throttle.len());
    let first = |output: usize| {
        let mut since = None;
        rows.rows.iter().find_map(|row| {
            since = row
                .health
                .has_failed(output as u8)
                .then(|| since.unwrap_or(row.time_s));
            let time_s = since.filter(|since| row.time_s - since >= STOPPED_S)?;
            Some(Stopped { output, time_s })
        })
    };
    (0..outputs).filter_map(first).collect()
}

/// The rotors of known speed, where a layer has at least three of them. Speeds are brought to one throttle by the model: a
/// rotor's thrust follows the square of its speed.
pub(crate) fn speeds(rows: &Rows, compiled: &Compiled) -> Vec<Speed> {
    let hover = |row: &Row| row.is_straight;
    let throttle = |output: usize| rows.median(hover, |row| f64::from(row.throttle[output]));
    let units = &compiled.airframe.units;
    let all: Option<Vec<f32>> = (0..compiled.airframe.rotors())
        .map(|output| Some(throttle(output)? as f32))
        .collect();
    let conditions = rows.rows.iter().find(|row| hover(row)).map(|row| row.conditions);
    let Some((all, conditions)) = all.zip(conditions) else {
        return Vec::new();
    };
    let physics = compiled.physics();
    let [volts, density] = conditions.map(f64::from);
    let factors = compiled.airframe.factors(volts, density);
    let thrust = |scale: f32| {
        let throttle: Vec<f32> = all.iter().map(|throttle| scale * throttle).collect();
        physics.wrench(&throttle, factors, Health::GOOD)[3]
    };
    // Of the logarithms of speed and throttle.
    let slope = 0.5 * libm::log(thrust(1.0 + STEP) / thrust(1.0 - STEP)) / (2.0 * f64::from(STEP));
    let at_one_throttle = |output: usize| {
        let known = |row: &Row| hover(row) && row.speeds[output] > 0.0;
        let speed = rows.median(known, |row| libm::log(row.speeds[output]))?;
        Some((output, speed - slope * libm::log(all[output].into())))
    };
    // Single rotors are not like those of a pair.
    let layer = |layer: &str| {
        let rotors = units.iter().flat_map(|unit| unit.rotors());
        let outputs = rotors
            .filter(|rotor| rotor.layer == layer)
            .map(|rotor| rotor.channel);
        let speeds: Vec<(usize, f64)> = outputs.filter_map(at_one_throttle).collect();
        let against = |(output, speed): &(usize, f64)| {
            let others = speeds
                .iter()
                .filter(|(other, _)| other != output)
                .map(|(_, speed)| *speed);
            Speed {
                output: *output,
                ratio: libm::exp(speed - median(others)),
            }
        };
        match speeds.len() {
            0..3 => Vec::new(),
            _ => speeds.iter().map(against).collect(),
        }
    };
    ["upper", "lower", "single"].map(layer).concat()
}
