//! How often the vehicle got less than its controllers asked for.

use mixer_compiler::Compiled;
use mixer_rt::{Axis, Conditions, Health, Wrench};
use serde::Serialize;

use crate::stacks::stack::Stack;

use crate::review::flight::Flight;
use crate::review::log::median;
use crate::review::rows::{Row, Rows};

/// Largest time between a setpoint and the outputs that it is taken to give, s.
const SAME_TIME_S: f64 = 0.03;

/// Median difference of throttles below which the log was flown with this mixer. A stack's own differs by 0.02 to 0.1.
const SAME_THROTTLE: f64 = 0.01;

/// Least number of rows for that.
const LEAST_ROWS: usize = 20;

/// Throttles this near a limit are on it.
const ON_LIMIT: f64 = 0.005;

/// Who says which axes were saturated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// This mixer, run on PX4's logged setpoints: the log was flown with it.
    Mixer,
    /// PX4's `control_allocator_status`.
    Allocator,
    /// The flags of ArduPilot's rate controllers.
    Controllers,
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

impl Saturated {
    pub(crate) fn new(rows: &Rows, flight: &Flight, compiled: &Compiled) -> Saturated {
        let shares = by_mixer(rows, flight, compiled).map(|shares| (Source::Mixer, shares.map(Some)));
        let (by, [roll, pitch, yaw, thrust]) = shares
            .or_else(|| by_stack(rows, flight))
            .unwrap_or((Source::None, [None; 4]));
        let [min, max] = compiled.airframe.throttle.range();
        let any = |is_of: &dyn Fn(f64) -> bool| rows.share(|row| turning(row).any(is_of));
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

/// Throttles of the rotors that turn.
fn turning(row: &Row) -> impl Iterator<Item = f64> {
    let turns = |(output, throttle): (usize, &f32)| {
        (!row.health.has_failed(output as u8)).then_some(f64::from(*throttle))
    };
    row.throttle.iter().enumerate().filter_map(turns)
}

/// By this mixer, where it gives the throttles that PX4 logged.
fn by_mixer(rows: &Rows, flight: &Flight, compiled: &Compiled) -> Option<[f64; 4]> {
    let (mut differences, mut flagged, mut count) = (Vec::new(), [0.0; 4], 0.0);
    for row in &rows.rows {
        let Some(setpoint) = flight.setpoint.as_ref()?.nearest(row.time_s, SAME_TIME_S) else {
            continue;
        };
        let normalised = [0, 1, 2, 3].map(|k| setpoint[k] as f32);
        let wrench = Wrench::from_normalised(normalised, &compiled.scale());
        let [volts, density] = row.conditions;
        let conditions = Conditions::at_voltage(volts).in_air(density);
        let Ok((throttle, _, saturation)) = compiled.tables.mix_with_health(&wrench, conditions, row.health)
        else {
            continue;
        };
        if row.health == Health::GOOD {
            let off = throttle
                .iter()
                .zip(&row.throttle)
                .map(|(a, b)| (a - b).abs().into());
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
    let is_own = differences.len() >= LEAST_ROWS && median(differences.into_iter()) < SAME_THROTTLE;
    is_own.then(|| flagged.map(|flagged| flagged / count))
}

/// By the stack's own word.
fn by_stack(rows: &Rows, flight: &Flight) -> Option<(Source, [Option<f64>; 4])> {
    let cut = flight.cut.as_ref()?;
    let width = cut.rows().next()?.1.len();
    let is_cut = |row: &Row, axis: usize| cut.at(row.time_s).is_some_and(|row| row[axis] != 0.0);
    let shares = [0, 1, 2, 3].map(|axis| (axis < width).then(|| rows.share(|row| is_cut(row, axis))));
    let by = if flight.stack == Stack::Px4 {
        Source::Allocator
    } else {
        Source::Controllers
    };
    Some((by, shares))
}
