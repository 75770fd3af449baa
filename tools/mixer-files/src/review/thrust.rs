//! The scale of the thrust: the model's over the measured one, by parts of the log.

use mixer_compiler::airframe::GRAVITY;
use serde::Serialize;

use crate::review::log::median;
use crate::review::rows::{Row, Rows};

/// Length of what is taken for one reading, s: longer than the rotors' lag and a step between outputs.
const BLOCK_S: f64 = 0.5;

/// Standard deviation of the mass, as a share: what scales and packs differ by.
pub(crate) const MASS_OFF: f64 = 0.005;

/// Standard deviation of an accelerometer's offset that could not be found, m/s2.
const OFFSET_OFF: f64 = 0.1;

/// Least time that a scale of its own rests on, s.
const LEAST_S: f64 = 3.0;

/// A change of the scale within a flight: its least share, how many standard errors it has, and the least number of blocks
/// on both sides.
const CHANGE: f64 = 0.03;
const CHANGE_ERRORS: f64 = 3.0;
const CHANGE_BLOCKS: usize = 10;

/// The model's thrust over the measured one.
#[derive(Clone, Debug, Serialize)]
pub struct Thrust {
    /// The one scale; `None` where the intervals of the parts have no value in common.
    pub scale: Option<f64>,
    /// Where it lies in 19 of 20 flights, the mass' own error included; where there is no one scale, from the least to the
    /// largest of the parts.
    pub interval: [f64; 2],
    /// A part per take-off, and more where the thrust changes in a flight.
    pub parts: Vec<Part>,
    /// Median over the whole log, whether its parts agree or not.
    #[serde(skip)]
    pub(crate) median: f64,
}

/// A flight, or a part of one over which the scale is the same.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// Number of the take-off, from 1.
    pub flight: usize,
    /// Begin and end, s of the log.
    pub from_s: f64,
    /// Likewise.
    pub to_s: f64,
    /// Mean of the battery's voltage, V.
    pub voltage_v: f64,
    /// The model's thrust over the measured one.
    pub scale: f64,
    /// Where it lies in 19 of 20 flights.
    pub interval: [f64; 2],
}

/// Means over half a second.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    flight: usize,
    from_s: f64,
    to_s: f64,
    volts: f64,
    /// The model's thrust over the measured one, by both of its measures.
    ratios: [f64; 2],
    /// Where the model's thrust acts, forward and right of the file's centre, m.
    pub(crate) centre_m: [f64; 2],
}

/// Means over blocks of rows that are chosen and follow each other.
pub(crate) fn blocks(rows: &Rows, mass_kg: f64, is_of: impl Fn(&Row) -> bool) -> Vec<Block> {
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
    let mean =
        |number: &dyn Fn(&Row) -> f64| rows.iter().map(|row| number(row)).sum::<f64>() / rows.len() as f64;
    let model: [f64; 4] = std::array::from_fn(|k| mean(&|row| row.model[k]));
    (last.time_s - first.time_s >= 0.5 * BLOCK_S).then(|| Block {
        flight: first.flight,
        from_s: first.time_s,
        to_s: last.time_s,
        volts: mean(&|row| row.conditions[0].into()),
        ratios: [0, 1].map(|k| model[3] / (mass_kg * mean(&|row| row.measured[k]))),
        // Roll is -y f and pitch x f: both vanish about the centre of gravity.
        centre_m: [model[1] / model[3], -model[0] / model[3]],
    })
}

fn seconds(blocks: &[Block]) -> f64 {
    blocks.iter().map(|block| block.to_s - block.from_s).sum()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard error of a mean. Blocks are alike over some seconds (gusts, the pack's state), so covariances of
/// neighbours count, with Bartlett's weights (Newey and West 1987).
pub(crate) fn error(values: &[f64]) -> f64 {
    let (n, mean) = (values.len(), mean(values));
    let off: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let covariance = |lag: usize| off.iter().zip(&off[lag..]).map(|(a, b)| a * b).sum::<f64>() / n as f64;
    let lags = (n / 4).min(8);
    let weighted = |lag: usize| 2.0 * (1.0 - lag as f64 / (lags + 1) as f64) * covariance(lag);
    let variance = covariance(0) + (1..=lags).map(weighted).sum::<f64>();
    (variance.max(covariance(0) / 4.0) / n as f64).sqrt()
}

/// Student's t at 97.5 % for the degrees of freedom of a number of blocks that are alike in pairs, within 2 % from 3 on.
pub(crate) fn student(blocks: usize) -> f64 {
    let freedom = blocks as f64 / 2.0;
    1.96 + 2.4 / freedom + 4.0 / (freedom * freedom)
}

fn ratios(blocks: &[Block]) -> Vec<f64> {
    blocks.iter().map(|block| block.ratios[0]).collect()
}

/// Parts of a flight over which the scale is the same: it is cut where the means on both sides differ most, as long as
/// they do (binary segmentation; Scott and Knott 1974).
fn parts(blocks: &[Block]) -> Vec<&[Block]> {
    let ratios = ratios(blocks);
    let (count, all) = (ratios.len(), ratios.iter().sum::<f64>());
    let places = CHANGE_BLOCKS..(count + 1).saturating_sub(CHANGE_BLOCKS);
    // Between the means left and right of each place, squared, by both counts.
    let gains = ratios.iter().scan(0.0, |sum, ratio| {
        let before = *sum;
        *sum += ratio;
        Some(before)
    });
    let gains = gains
        .enumerate()
        .filter(|(at, _)| places.contains(at))
        .map(|(at, sum)| {
            let (left, right) = (at as f64, (count - at) as f64);
            let between = sum / left - (all - sum) / right;
            (at, left * right * between * between)
        });
    let Some((at, _)) = gains.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return vec![blocks];
    };
    let (left, right) = ratios.split_at(at);
    let change = (mean(left) - mean(right)).abs();
    match change > CHANGE * mean(left) && change > CHANGE_ERRORS * libm::hypot(error(left), error(right)) {
        true => [parts(&blocks[..at]), parts(&blocks[at..])].concat(),
        false => vec![blocks],
    }
}

impl Thrust {
    /// The scale over the rows of hover, or over all in the air where those are few; with whether they were few. `None` where the
    /// log has not even those. The model's thrust may be `[least, most]` times what it is at the reference voltage.
    pub(crate) fn new(rows: &Rows, mass_kg: f64, [least, most]: [f64; 2]) -> Option<(Thrust, bool)> {
        let hover = blocks(rows, mass_kg, |row| row.hovers);
        let is_short = seconds(&hover) < LEAST_S;
        let whole = |row: &Row| row.health == mixer_rt::Health::GOOD;
        let used = if is_short {
            blocks(rows, mass_kg, whole)
        } else {
            hover
        };
        if seconds(&used) < LEAST_S {
            return None;
        }
        let no_offset = if rows.offset.is_some() {
            0.0
        } else {
            OFFSET_OFF / GRAVITY
        };
        let estimate = |blocks: &[Block]| {
            let [scale, other] = [0, 1].map(|k| median(blocks.iter().map(|block| block.ratios[k])));
            let by_axis = (other / scale - 1.0) / 2.0;
            let off = [error(&ratios(blocks)) / scale, by_axis, MASS_OFF, no_offset];
            let half = student(blocks.len()) * off.iter().map(|x| x * x).sum::<f64>().sqrt();
            (scale, [scale * (1.0 - half) * least, scale * (1.0 + half) * most])
        };
        let part = |blocks: &[Block]| {
            let (scale, interval) = estimate(blocks);
            Part {
                flight: blocks[0].flight,
                from_s: blocks[0].from_s,
                to_s: blocks[blocks.len() - 1].to_s,
                voltage_v: mean(&blocks.iter().map(|block| block.volts).collect::<Vec<_>>()),
                scale,
                interval,
            }
        };
        let flights = used.chunk_by(|a, b| a.flight == b.flight).flat_map(parts);
        let parts: Vec<Part> = flights
            .filter(|blocks| seconds(blocks) >= LEAST_S)
            .map(part)
            .collect();
        let (median, interval) = estimate(&used);
        let [lows, highs] = [0, 1].map(|end| parts.iter().map(move |part| part.interval[end]));
        let [common, hull] = [
            [
                lows.clone().fold(f64::MIN, f64::max),
                highs.clone().fold(f64::MAX, f64::min),
            ],
            [lows.fold(f64::MAX, f64::min), highs.fold(f64::MIN, f64::max)],
        ];
        let agree = common[0] <= common[1] || parts.is_empty();
        let thrust = Thrust {
            scale: agree.then_some(median),
            interval: if agree { interval } else { hull },
            parts,
            median,
        };
        Some((thrust, is_short))
    }
}
