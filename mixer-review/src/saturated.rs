//! How often the vehicle got less than its controllers asked for, and what was left.

use mixer_compiler::Compiled;
use mixer_rt::{Axis, Health, Wrench};
use serde::Serialize;

use crate::flight::{Flight, Stack};
use crate::rows::{Row, Rows};

/// Largest time between a setpoint and the outputs that it is taken to give, s.
const SAME_TIME_S: f64 = 0.03;

/// Median difference of throttles below which the log was flown with this mixer. A stack's own differs by 0.02 to 0.1.
const SAME_THROTTLE: f64 = 0.01;

/// Least number of rows for that.
const LEAST_ROWS: usize = 20;

/// A setpoint of which more than this was left out, in the stack's units, is cut.
const LEFT_OUT: f64 = 1e-3;

/// Throttles this near a limit are on it.
const ON_LIMIT: f64 = 0.005;

/// Who says which axes were saturated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// This mixer, run on the logged setpoints: the log was flown with it.
    Mixer,
    /// PX4's `control_allocator_status`.
    Allocator,
    /// Nobody: the log does not say it.
    None,
}

/// Shares of the time in the air.
#[derive(Clone, Debug, Serialize)]
pub struct Saturated {
    /// Who says so.
    pub by: Source,
    /// Share of the time in which roll was not what was asked; `None` where nobody says so.
    pub roll: Option<f64>,
    /// Likewise.
    pub pitch: Option<f64>,
    /// Likewise.
    pub yaw: Option<f64>,
    /// Likewise.
    pub thrust: Option<f64>,
    /// Share of the time in which a rotor was at its largest throttle.
    pub at_full: f64,
    /// Share of the time in which one was at idle.
    pub at_idle: f64,
}

/// The least that was left to a rotor.
#[derive(Clone, Debug, Serialize)]
pub struct Margin {
    /// Throttle up to the largest.
    pub throttle: f64,
    /// The rotor's output.
    pub output: usize,
    /// When, s of the log.
    pub time_s: f64,
}

impl Saturated {
    pub(crate) fn new(rows: &Rows, flight: &Flight, compiled: &Compiled) -> Saturated {
        let shares = by_mixer(rows, flight, compiled).map(|shares| (Source::Mixer, shares));
        let shares = shares.or_else(|| Some((Source::Allocator, by_allocator(rows, flight)?)));
        let (by, shares) = shares.map_or((Source::None, [None; 4]), |(by, shares)| (by, shares.map(Some)));
        let [roll, pitch, yaw, thrust] = shares;
        let [min, max] = compiled.pair.range();
        let any =
            |is_of: &dyn Fn(f64) -> bool| rows.share(|row| turning(row).any(|(_, throttle)| is_of(throttle)));
        Saturated {
            by,
            roll,
            pitch,
            yaw,
            thrust,
            at_full: any(&|throttle| throttle >= max - ON_LIMIT),
            at_idle: any(&|throttle| throttle <= min + ON_LIMIT),
        }
    }
}

impl Margin {
    /// `None` without rows.
    pub(crate) fn new(rows: &Rows, compiled: &Compiled) -> Option<Margin> {
        let [_, max] = compiled.pair.range();
        let all = rows.rows.iter().flat_map(|row| {
            turning(row).map(|(output, throttle)| Margin {
                throttle: max - throttle,
                output,
                time_s: row.time_s,
            })
        });
        all.min_by(|a, b| a.throttle.total_cmp(&b.throttle))
    }
}

/// The rotors that turn, with their throttles.
fn turning(row: &Row) -> impl Iterator<Item = (usize, f64)> {
    let throttles = row
        .throttle
        .iter()
        .map(|throttle| f64::from(*throttle))
        .enumerate();
    throttles.filter(|(output, _)| !row.health.has_failed(*output as u8))
}

/// By this mixer, where it gives the logged throttles.
fn by_mixer(rows: &Rows, flight: &Flight, compiled: &Compiled) -> Option<[f64; 4]> {
    let scale = match flight.stack {
        Stack::Px4 => compiled.scale(),
        Stack::ArduPilot => compiled.ardupilot_scale(),
    };
    let setpoints = flight.setpoint.as_ref()?;
    let (mut differences, mut flagged, mut count) = (Vec::new(), [0.0; 4], 0.0);
    for row in &rows.rows {
        let Some(setpoint) = setpoints.nearest(row.time_s, SAME_TIME_S) else {
            continue;
        };
        let normalised = [0, 1, 2, 3].map(|k| setpoint[k] as f32);
        let wrench = Wrench::from_normalised(normalised, &scale);
        let Ok((throttle, _, saturation)) = compiled.tables.mix_in(&wrench, row.conditions, row.health)
        else {
            continue;
        };
        let off = throttle
            .iter()
            .zip(&row.throttle)
            .map(|(a, b)| f64::from((a - b).abs()));
        if row.health == Health::GOOD {
            differences.push(off.fold(0.0, f64::max));
        }
        for (flagged, axis) in flagged
            .iter_mut()
            .zip([Axis::Roll, Axis::Pitch, Axis::Yaw, Axis::Thrust])
        {
            *flagged += f64::from(u8::from(saturation.is_flagged(axis)));
        }
        count += 1.0;
    }
    differences.sort_by(f64::total_cmp);
    let median = differences.get(differences.len() / 2)?;
    (differences.len() >= LEAST_ROWS && *median < SAME_THROTTLE)
        .then(|| flagged.map(|flagged| flagged / count))
}

/// By PX4's own word.
fn by_allocator(rows: &Rows, flight: &Flight) -> Option<[f64; 4]> {
    let unallocated = flight.unallocated.as_ref()?;
    let share = |axis: usize| {
        rows.share(|row| {
            let left_out = unallocated.at(row.time_s).map(|row| row[axis].abs());
            left_out.is_some_and(|left_out| left_out > LEFT_OUT)
        })
    };
    Some([0, 1, 2, 3].map(share))
}
