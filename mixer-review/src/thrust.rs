//! The scale of the thrust: the model's over the measured one.

use mixer_compiler::airframe::GRAVITY;
use serde::Serialize;

use crate::rows::{Row, Rows};

/// Length of what is taken for one reading, s: longer than the rotors' lag and a step between outputs.
const BLOCK_S: f64 = 0.5;

/// Standard deviation of the mass, as a share: what scales and packs differ by.
pub(crate) const MASS_OFF: f64 = 0.005;

/// Standard deviation of an accelerometer's offset that could not be found, m/s2.
const OFFSET_OFF: f64 = 0.1;

/// Least time that a scale of its own rests on, s, and least ratio of the voltages that it spans.
const LEAST_S: f64 = 3.0;
const LEAST_SPAN: f64 = 1.04;

/// Thrusts over the weight between which a scale of its own is stated.
const THRUSTS: [f64; 4] = [0.0, 0.9, 1.1, f64::MAX];

/// The model's thrust over the measured one.
#[derive(Clone, Debug, Serialize)]
pub struct Thrust {
    /// The one scale of the flight.
    pub scale: f64,
    /// Where it lies in 19 of 20 flights, the mass' own error included.
    pub interval: [f64; 2],
    /// By the battery's voltage, V; empty where the log does not span them.
    pub by_voltage: Vec<Part>,
    /// By the thrust over the weight; empty likewise.
    pub by_thrust: Vec<Part>,
}

/// A scale of a part of the flight.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// Mean over the part of what it is a part by.
    pub at: f64,
    /// The model's thrust over the measured one.
    pub scale: f64,
    /// Its length, s.
    pub seconds: f64,
}

/// Half a second.
#[derive(Clone, Copy, Debug)]
struct Block {
    model_n: f64,
    measured_n: [f64; 2],
    volts: f64,
    seconds: f64,
}

/// Means over blocks of rows that are chosen and follow each other.
fn blocks(rows: &Rows, mass_kg: f64, is_of: impl Fn(&Row) -> bool) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut of_one: Vec<&Row> = Vec::new();
    for row in &rows.rows {
        let begins = of_one
            .first()
            .is_none_or(|first| row.time_s - first.time_s >= BLOCK_S);
        if begins || !row.follows || !is_of(row) {
            blocks.extend(block(&of_one, mass_kg));
            of_one.clear();
        }
        if is_of(row) {
            of_one.push(row);
        }
    }
    blocks.extend(block(&of_one, mass_kg));
    blocks
}

/// The mean of a block that is at least half full.
fn block(rows: &[&Row], mass_kg: f64) -> Option<Block> {
    let (first, last) = (rows.first()?, rows.last()?);
    let seconds = last.time_s - first.time_s;
    let mean =
        |number: &dyn Fn(&Row) -> f64| rows.iter().map(|row| number(row)).sum::<f64>() / rows.len() as f64;
    (seconds >= 0.5 * BLOCK_S).then(|| Block {
        model_n: mean(&|row| row.model[3]),
        measured_n: [0, 1].map(|k| mass_kg * mean(&|row| row.measured[k])),
        volts: mean(&|row| row.conditions.voltage_v.into()),
        seconds,
    })
}

fn scale(blocks: &[Block], k: usize) -> f64 {
    let sum = |number: &dyn Fn(&Block) -> f64| blocks.iter().map(number).sum::<f64>();
    sum(&|block| block.model_n) / sum(&|block| block.measured_n[k])
}

/// Standard error of the scale by the scatter of the blocks, as a share. Blocks are alike over some
/// seconds (gusts, the pack's state), so covariances of neighbours count, with Bartlett's weights
/// (Newey and West 1987).
fn scatter(blocks: &[Block], scale: f64) -> f64 {
    let n = blocks.len();
    let mean = blocks.iter().map(|block| block.model_n).sum::<f64>() / n as f64;
    let off: Vec<f64> = blocks
        .iter()
        .map(|block| (block.model_n - scale * block.measured_n[0]) / mean)
        .collect();
    let covariance = |lag: usize| off.iter().zip(&off[lag..]).map(|(a, b)| a * b).sum::<f64>() / n as f64;
    let lags = (n / 4).min(8);
    let weighted = |lag: usize| 2.0 * (1.0 - lag as f64 / (lags + 1) as f64) * covariance(lag);
    let variance = covariance(0) + (1..=lags).map(weighted).sum::<f64>();
    (variance.max(covariance(0) / 4.0) / n as f64).sqrt()
}

/// Student's t at 97.5 % for a number of degrees of freedom, within 2 % from 3 on.
fn student(freedom: f64) -> f64 {
    1.96 + 2.4 / freedom + 4.0 / (freedom * freedom)
}

impl Thrust {
    /// The scale over the rows of hover, or over all in the air where those are few; with whether they were few. `None` where the
    /// log has not even those. The model's thrust may be `[least, most]` times what it is at the reference voltage.
    pub(crate) fn new(rows: &Rows, mass_kg: f64, [least, most]: [f64; 2]) -> Option<(Thrust, bool)> {
        let whole = |row: &Row| row.health == mixer_rt::Health::GOOD;
        let hover = blocks(rows, mass_kg, |row| row.hovers);
        let all = blocks(rows, mass_kg, whole);
        let seconds = |blocks: &[Block]| blocks.iter().map(|block| block.seconds).sum::<f64>();
        let is_short = seconds(&hover) < LEAST_S;
        let used = if is_short { &all } else { &hover };
        if seconds(used) < LEAST_S {
            return None;
        }
        let one = scale(used, 0);
        let by_axis = (scale(used, 1) / one - 1.0) / 2.0;
        let no_offset = if rows.offset.is_some() {
            0.0
        } else {
            OFFSET_OFF / GRAVITY
        };
        let off = [scatter(used, one), by_axis, MASS_OFF, no_offset];
        let half = student(used.len() as f64 / 2.0) * off.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some((
            Thrust {
                scale: one,
                interval: [one * (1.0 - half) * least, one * (1.0 + half) * most],
                by_voltage: by_voltage(used),
                by_thrust: by_thrust(&all, mass_kg, one),
            },
            is_short,
        ))
    }
}

/// Parts of at least [`LEAST_S`]; none where only one is left.
fn parts(parts: impl Iterator<Item = Vec<Block>>, at: impl Fn(&Block) -> f64) -> Vec<Part> {
    let part = |blocks: Vec<Block>| Part {
        at: blocks.iter().map(&at).sum::<f64>() / blocks.len() as f64,
        scale: scale(&blocks, 0),
        seconds: blocks.iter().map(|block| block.seconds).sum(),
    };
    let of_time = |blocks: &Vec<Block>| blocks.iter().map(|block| block.seconds).sum::<f64>() >= LEAST_S;
    let parts: Vec<Part> = parts.filter(of_time).map(part).collect();
    if parts.len() > 1 { parts } else { Vec::new() }
}

/// Thirds of the voltage's range.
fn by_voltage(blocks: &[Block]) -> Vec<Part> {
    let volts = blocks.iter().map(|block| block.volts);
    let (low, high) = volts.fold((f64::MAX, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
    if high < LEAST_SPAN * low {
        return Vec::new();
    }
    let third = |block: &Block| ((3.0 * (block.volts - low) / (high - low)) as usize).min(2);
    let of = |k: usize| blocks.iter().filter(|block| third(block) == k).copied().collect();
    parts((0..3).map(of), |block| block.volts)
}

/// By the mean of both thrusts, so that the noise of neither sorts its own readings.
fn by_thrust(blocks: &[Block], mass_kg: f64, one: f64) -> Vec<Part> {
    let share = |block: &Block| 0.5 * (block.model_n / one + block.measured_n[0]) / (mass_kg * GRAVITY);
    let between = |k: usize| {
        let is_of = |block: &&Block| (THRUSTS[k]..THRUSTS[k + 1]).contains(&share(block));
        blocks.iter().filter(is_of).copied().collect()
    };
    parts((0..THRUSTS.len() - 1).map(between), share)
}
