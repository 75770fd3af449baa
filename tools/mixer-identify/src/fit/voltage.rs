//! How thrust and torque follow the supply voltage.
//!
//! Model: y = g(u, l) (V / Vref)^k, with g free: one value per throttle level where files share
//! their levels, else a polynomial. Only rows at *equal throttle* and different voltage then say
//! anything about k; a battery that sags as throttle rises does not. The fit minimises the sum of w
//! (y - g r^k)2 with g profiled out and w = 1 / max(|y|, a tenth of full scale)2 (relative errors,
//! but no weight to noise near zero), by Gauss-Newton on the projected derivative (Kaufman), which
//! also gives the 95 % interval of k.
//!
//! A number is given only if it is sound: voltages at equal throttle differ by at least 8 %, at
//! four or more levels that span a good part of the range; the rows follow one power; the interval
//! is narrow; the value is one that a propeller can have. Otherwise the reason is given instead.

use std::collections::BTreeMap;

use mixer_compiler::airframe::Basis;
use serde::Serialize;

use self::exponent::Row;
pub use self::exponent::{Estimate, Exponent};
pub(crate) use self::profile::off_span;
use self::profile::{Regressors, profile};
use crate::bench::{Bench, BenchKind, Point};
use crate::fit::basis::Centred;
use crate::fit::range;
use crate::refusal::Refusal;
use crate::statistics::{dot, extent, rms};

mod exponent;
mod profile;

/// Least ratio of voltages at equal throttle.
const LEAST_RATIO: f64 = 1.08;
/// Least number of throttle levels measured at different voltages.
const LEAST_LEVELS: usize = 4;
/// Least spread of those levels, in throttle.
const LEAST_SPREAD: f64 = 0.3;
/// Relative root-mean-square residual above which the rows do not follow one power of voltage.
const ONE_POWER: f64 = 0.10;
/// Exponents between a rotor at constant torque and the square law with an ample margin.
const PLAUSIBLE: [f64; 2] = [1.2, 2.4];
/// Half-width of the interval above which the exponent says too little.
const WIDEST: f64 = 0.35;
/// Throttles closer than this are one level.
const LEVEL: f64 = 0.002;

/// The effect of the voltage on both channels.
#[derive(Debug, Clone, Serialize)]
pub struct Voltage {
    /// What the exponents come from.
    pub source: BenchKind,
    /// Of thrust.
    pub thrust: Exponent,
    /// Of torque.
    pub torque: Exponent,
    /// Least and greatest voltage of the rows, V.
    pub range_v: [f64; 2],
    /// Mean voltage of the rows, V.
    pub mean_v: f64,
}

impl Voltage {
    /// Both channels by name; one entry for both where they are refused for one reason.
    pub fn channels(&self) -> Vec<(&'static str, &Exponent)> {
        match (&self.thrust, &self.torque) {
            (Exponent::Refused { reason: a, .. }, Exponent::Refused { reason: b, .. }) if a == b => {
                vec![("thrust and torque", &self.thrust)]
            }
            (thrust, torque) => vec![("thrust", thrust), ("torque", torque)],
        }
    }

    /// The exponents of thrust and of torque, where both are known.
    pub fn exponents(&self) -> Option<[f64; 2]> {
        Some([self.thrust.value()?, self.torque.value()?])
    }

    /// Whether voltages differ enough that exponents could be expected of the files.
    pub fn varies(&self) -> bool {
        self.range_v[1] >= LEAST_RATIO * self.range_v[0]
    }
}

/// Examines the files of one kind. Nothing if no row has a voltage.
pub fn examine(benches: &[Bench], kind: BenchKind) -> Option<Voltage> {
    let of_kind = benches.iter().filter(|b| b.kind == kind).flat_map(|b| &b.points);
    let points: Vec<&Point> = of_kind
        .filter(|p| p.voltage > 0.0 && p.voltage.is_finite())
        .collect();
    if points.is_empty() {
        return None;
    }
    let voltages = || points.iter().map(|p| p.voltage);
    let range_v = extent(voltages());
    let mean_v = voltages().sum::<f64>() / points.len() as f64;
    let levels = levels(&points);
    let rows = |of: fn(&Point) -> f64| -> Vec<Row> {
        let all = points.iter().zip(&levels).map(|(p, &level)| Row {
            throttle: [p.u, p.l],
            level,
            voltage: p.voltage,
            y: of(p),
        });
        all.filter(|r| r.y.is_finite()).collect()
    };
    Some(Voltage {
        source: kind,
        thrust: exponent(rows(|p| p.thrust), kind, mean_v),
        torque: exponent(rows(|p| p.torque), kind, mean_v),
        range_v,
        mean_v,
    })
}

/// Numbers the distinct throttle pairs, in order of appearance. A grid of cells as wide as a level
/// keeps the search to a pair's neighbours.
fn levels(points: &[&Point]) -> Vec<usize> {
    let mut known: Vec<[f64; 2]> = Vec::new();
    let mut cells: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    let number = |p: &&Point| {
        let place = [p.u, p.l];
        let [i, j] = place.map(|t| (t / LEVEL).floor() as i64);
        let near = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [i + a, j + b]));
        let same = |k: &usize| (0..2).all(|r| (known[*k][r] - place[r]).abs() < LEVEL);
        let found = near
            .filter_map(|cell| cells.get(&cell))
            .flatten()
            .copied()
            .filter(same)
            .min();
        found.unwrap_or_else(|| {
            known.push(place);
            cells.entry([i, j]).or_default().push(known.len() - 1);
            known.len() - 1
        })
    };
    points.iter().map(number).collect()
}

fn refused(reason: String, needed: &str) -> Exponent {
    Exponent::Refused {
        reason,
        needed: needed.into(),
    }
}

const ANOTHER_VOLTAGE: &str = "the same sweep at another supply voltage, at least 8 % away (a bench supply, or a pack \
                               with a cell more or less), as a second file";

fn exponent(rows: Vec<Row>, kind: BenchKind, reference: f64) -> Exponent {
    if rows.is_empty() {
        return Exponent::NotMeasured;
    }
    // Levels measured at voltages that differ enough.
    let count = rows.iter().map(|r| r.level + 1).max().unwrap_or(0);
    let mut of_level = vec![(f64::MAX, f64::MIN); count];
    for r in &rows {
        let (low, high) = &mut of_level[r.level];
        (*low, *high) = (low.min(r.voltage), high.max(r.voltage));
    }
    let varied = |level: usize| of_level[level].1 >= LEAST_RATIO * of_level[level].0;
    let varied_rows: Vec<&Row> = rows.iter().filter(|r| varied(r.level)).collect();
    let is_varied = |l: &usize| of_level[*l].0 <= of_level[*l].1 && varied(*l);
    let varied_levels = (0..count).filter(is_varied).count();
    let throttles = varied_rows.iter().map(|r| r.throttle[0].max(r.throttle[1]));
    let [least, most] = extent(throttles);
    let estimate = if varied_levels >= LEAST_LEVELS && most - least >= LEAST_SPREAD {
        profile(&varied_rows, &Regressors::Levels, reference).map(|mut e| {
            e.method = "equal throttles";
            e.levels = varied_levels;
            e
        })
    } else {
        match joint(&rows, kind, reference) {
            Ok(estimate) => estimate,
            Err(reason) => return reason,
        }
    };
    let Some(estimate) = estimate else {
        return refused("the rows do not determine an exponent".into(), ANOTHER_VOLTAGE);
    };
    sound(estimate)
}

/// The estimate if it is sound, or the reason why not.
fn sound(e: Estimate) -> Exponent {
    let ([least, most], missed, uncertain) = (PLAUSIBLE, e.residual_percent, e.ci95);
    let (reason, needed) = if missed > 100.0 * ONE_POWER {
        (
            format!(
                "at equal throttles the rows do not follow one power of voltage (they miss it by {missed:.0} %)"
            ),
            "files of one and the same rotor or pair; name others in a run of their own",
        )
    } else if uncertain > WIDEST {
        (
            format!("the exponent is uncertain by +-{uncertain:.2}"),
            "voltages further apart, or more throttle levels",
        )
    } else if !(least..=most).contains(&e.exponent) {
        (
            format!("the rows would ask for an exponent outside {least}..{most}, which no propeller has"),
            "files of one and the same rotor or pair, with the voltage measured at the speed controller",
        )
    } else {
        return Exponent::Identified(e);
    };
    refused(reason, needed)
}

/// A polynomial through all rows, where files do not share their levels: refused unless voltage
/// varies on its own.
fn joint(rows: &[Row], kind: BenchKind, reference: f64) -> Result<Option<Estimate>, Exponent> {
    let voltages = || rows.iter().map(|r| r.voltage);
    let [low, high] = extent(voltages());
    if high < LEAST_RATIO * low {
        return Err(refused(
            format!("all rows lie between {low:.2} and {high:.2} V: one voltage only"),
            ANOTHER_VOLTAGE,
        ));
    }
    let throttles: Vec<[f64; 2]> = rows.iter().map(|r| r.throttle).collect();
    let centred = Centred::new(Basis::Cubic, range(&throttles));
    let terms = |t: &[f64; 2]| -> Vec<f64> {
        match kind {
            BenchKind::Pair => centred.values(t[0], t[1]),
            BenchKind::SingleRotor => {
                let u = t[0];
                vec![u, u * u, u * u * u, u * u * u * u]
            }
        }
    };
    let columns: Vec<Vec<f64>> = throttles.iter().map(terms).collect();
    // What throttle does not explain of the logarithm of voltage is all that speaks of the
    // exponent.
    let with_constant: Vec<Vec<f64>> = columns.iter().map(|c| [&[1.0][..], c].concat()).collect();
    let logs: Vec<f64> = voltages().map(libm::log).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let total: f64 = logs.iter().map(|x| (x - mean) * (x - mean)).sum();
    let Some(own) = off_span(&with_constant, &logs) else {
        return Err(refused(
            "too few rows at different throttles".into(),
            ANOTHER_VOLTAGE,
        ));
    };
    let (own_rms, explained) = (rms(own.iter().copied()), 1.0 - dot(&own, &own) / total);
    // Two voltages in equal parts with the least ratio have an rms of half its logarithm.
    if own_rms < 0.5 * libm::log(LEAST_RATIO) {
        return Err(refused(
            format!(
                "voltage ({low:.2} to {high:.2} V) is confounded with throttle, which explains {:.0} % of it, as \
                 with a battery that sags: at equal throttle it varies by only {:.1} %",
                100.0 * explained,
                100.0 * own_rms
            ),
            ANOTHER_VOLTAGE,
        ));
    }
    let all: Vec<&Row> = rows.iter().collect();
    let estimate = profile(&all, &Regressors::Columns(columns), reference);
    Ok(estimate.map(|e| Estimate {
        method: "joint map",
        ..e
    }))
}

/// Refuses a pack whose voltages leave out the bench's: `[voltage]` holds around its reference.
pub(crate) fn in_pack(reference_v: Option<f64>, pack_v: Option<[f64; 2]>) -> Result<(), Refusal> {
    match (reference_v, pack_v) {
        (Some(reference), Some([low, high])) if !(low..=high).contains(&reference) => Err(Refusal::general(
            format!("the pack has {low:.1} to {high:.1} V, the bench had {reference:.2} V"),
            "the cells and chemistry of the pack that the rotors were measured for, or --reference-voltage within its range",
        )),
        _ => Ok(()),
    }
}

/// A warning of a `range_v` that is not the pack's.
pub(crate) fn bench_range([low, high]: [f64; 2]) -> String {
    format!(
        "range_v is {low:.2}..{high:.2} V, what the bench had, and a voltage outside is clamped: --cells N gives the pack's"
    )
}

#[cfg(test)]
mod tests;
