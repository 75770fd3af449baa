//! The flight resampled at its outputs, with what the model says there.
//!
//! The accelerometer measures f = (T + D) / m with the thrust T along the body's axis and the drag D. At the
//! speeds of a hover in wind most of D is the rotors' own and lies in their plane (the momentum drag of
//! PX4's and ArduPilot's wind estimators; Burri et al. 2018), so that the body's axis has T alone. Were D
//! horizontal instead, the vertical part would have it. With d, the earth's downward direction in body axes:
//!
//! ```text
//! T / m = -(f_z + b)                in the rotors' plane
//! T / m = -(f . d + b) / d_z        horizontal
//! ```
//!
//! The first is used, and half of their difference is an error of it. b is the accelerometer's offset. The mean of
//! -f . d over a time is g plus the change of the upward velocity over it, whatever the drag, and the
//! velocity of the stack's estimator does not drift: that gives b.

use mixer_compiler::Compiled;
use mixer_compiler::airframe::GRAVITY;
use mixer_compiler::model::Physics;
use mixer_rt::{Conditions, Health};

use crate::flight::Flight;
use crate::log::Series;

/// Cosine of the largest tilt in hover: 10 degrees.
const LEVEL: f64 = 0.985;

/// Largest speeds in hover, m/s: with more the flow through the rotors changes their thrust.
const SLOW_VERTICAL: f64 = 0.5;
const SLOW_HORIZONTAL: f64 = 3.0;

/// Largest rate in a straight hover, rad/s.
const STRAIGHT: f64 = 0.1;

/// What is left out after take-off and before landing, s: the ground carries a part of the weight
/// there, and stacks see a landing late.
const NEAR_GROUND_S: [f64; 2] = [1.0, 2.0];

/// Ages beyond which a value counts as missing, s: of attitude, velocity, rates and force; of the voltage; of the density.
const MOTION_AGE_S: f64 = 0.5;
const VOLTAGE_AGE_S: f64 = 3.0;
const AIR_AGE_S: f64 = 60.0;

/// Times between outputs that are further apart than this do not follow each other, s.
const GAP_S: f64 = 0.5;

/// Share of the weight above which a vehicle flies whose log does not say so.
const CARRIES: f64 = 0.7;

/// One instant.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) time_s: f64,
    /// Throttle of each output, 0 where it is off.
    pub(crate) throttle: Vec<f32>,
    /// Rotors that are off.
    pub(crate) health: Health,
    pub(crate) conditions: Conditions,
    /// Roll, pitch, yaw (N m) and thrust (N) of the model.
    pub(crate) model: [f64; 4],
    /// Thrust over mass by the accelerometer, m/s2: by the body's axis, and by the vertical part.
    pub(crate) measured: [f64; 2],
    /// Whether the vehicle hovers, all rotors turning; and whether without turning about any axis.
    pub(crate) hovers: bool,
    pub(crate) is_straight: bool,
    /// Whether it follows the row before it.
    pub(crate) follows: bool,
}

/// The rows of a flight in the air, and what they rest on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub(crate) rows: Vec<Row>,
    /// The accelerometer's offset, m/s2; `None` where no velocity was logged.
    pub(crate) offset: Option<f64>,
    /// Length of the log, s.
    pub(crate) seconds: f64,
}

/// Whether the vehicle is in the air at a time, s, away from take-off and landing. What a message says holds until
/// the next one.
fn flies(landed: &Series, time_s: f64) -> bool {
    let [after, before] = NEAR_GROUND_S;
    let is_up = |row: &[f64]| row[0] == 0.0;
    let since = time_s - after;
    landed.at(since).is_some_and(is_up) && landed.within(since, time_s + before).iter().all(|row| is_up(row))
}

impl Rows {
    pub(crate) fn new(flight: &Flight, compiled: &Compiled, mass_kg: f64) -> Rows {
        let physics = Physics {
            airframe: &compiled.airframe,
            map: &compiled.pair,
        };
        let mut rows = Rows::default();
        let mut before: Option<f64> = None;
        for (time_s, outputs) in flight.throttle.rows() {
            let last = before.replace(time_s);
            let rotors = compiled.airframe.rotors();
            let (Some(last), true) = (last.filter(|last| time_s - last < GAP_S), outputs.len() >= rotors)
            else {
                continue;
            };
            rows.seconds += time_s - last;
            let throttle: Vec<f32> = outputs[..rotors]
                .iter()
                .map(|x| if x.is_finite() { *x as f32 } else { 0.0 })
                .collect();
            let Some(conditions) = conditions(flight, compiled, time_s) else {
                continue;
            };
            let health = health(flight, &throttle, time_s);
            let factors = compiled
                .airframe
                .factors(conditions.voltage_v.into(), conditions.density_kg_m3.into());
            let model = physics.wrench(&throttle, factors, health);
            let in_the_air = flight
                .landed
                .as_ref()
                .map_or(model[3] > CARRIES * mass_kg * GRAVITY, |landed| {
                    flies(landed, time_s)
                });
            // The accelerometer around the time of the outputs: half a step to each side.
            let half = 0.5 * (time_s - last);
            let force = flight.force.mean(time_s - half, time_s + half, MOTION_AGE_S);
            let upright: &[f64] = &[0.0, 0.0, 1.0];
            let down = flight.down.as_ref();
            let down = down.map_or(Some(upright), |down| down.fresh(time_s, MOTION_AGE_S));
            let (Some(force), Some(down), true) = (force, down, in_the_air) else {
                continue;
            };
            let along: f64 = force.iter().zip(down).map(|(f, d)| f * d).sum();
            let is_slow = |v: &[f64]| libm::hypot(v[0], v[1]) < SLOW_HORIZONTAL && v[2].abs() < SLOW_VERTICAL;
            let slow = flight
                .velocity
                .as_ref()
                .is_none_or(|velocity| velocity.fresh(time_s, MOTION_AGE_S).is_some_and(is_slow));
            let is_still = |rates: Vec<f64>| rates.iter().all(|rate| rate.abs() < STRAIGHT);
            let still = flight.rates.as_ref().is_none_or(|rates| {
                let mean = rates.mean(time_s - half, time_s + half, MOTION_AGE_S);
                mean.is_some_and(is_still)
            });
            let is_whole = health == Health::GOOD;
            let hovers = is_whole && slow && down[2] > LEVEL;
            rows.rows.push(Row {
                time_s,
                throttle,
                health,
                conditions,
                model,
                measured: [-force[2], -along / down[2].max(0.1)],
                hovers,
                is_straight: hovers && still,
                follows: rows.rows.last().is_some_and(|row: &Row| row.time_s == last),
            });
        }
        rows.offset = flight
            .velocity
            .as_ref()
            .and_then(|velocity| offset(&rows.rows, flight, velocity));
        let offset = rows.offset.unwrap_or_default();
        for row in &mut rows.rows {
            row.measured = row.measured.map(|measured| measured - offset);
        }
        rows
    }

    /// Mean of a number over the rows that are chosen; `None` where none is.
    pub(crate) fn mean(&self, is_of: impl Fn(&Row) -> bool, number: impl Fn(&Row) -> f64) -> Option<f64> {
        let (mut count, mut sum) = (0.0, 0.0);
        for row in self.rows.iter().filter(|row| is_of(row)) {
            count += 1.0;
            sum += number(row);
        }
        (count > 0.0).then(|| sum / count)
    }

    /// Share of the rows.
    pub(crate) fn share(&self, is_of: impl Fn(&Row) -> bool) -> f64 {
        self.rows.iter().filter(|row| is_of(row)).count() as f64 / self.rows.len().max(1) as f64
    }

    /// Time of the rows that are chosen, s.
    pub(crate) fn seconds_of(&self, is_of: impl Fn(&Row) -> bool) -> f64 {
        let pairs = self
            .rows
            .windows(2)
            .filter(|pair| pair[1].follows && is_of(&pair[1]));
        pairs.map(|pair| pair[1].time_s - pair[0].time_s).sum()
    }
}

/// Voltage and density at a time; the reference of one that was never measured, or that thrust does not follow.
/// `None` where one is missing at the time.
fn conditions(flight: &Flight, compiled: &Compiled, time_s: f64) -> Option<Conditions> {
    let at = |series: &Option<Series>, age_s: f64, is_followed: bool, reference: f64| {
        let now = series.as_ref().and_then(|series| series.fresh(time_s, age_s));
        let is_needed = is_followed && series.is_some();
        let or_reference = if is_needed { None } else { Some(reference) };
        now.map(|row| row[0]).or(or_reference)
    };
    let airframe = &compiled.airframe;
    let [of_voltage, of_air] = [&airframe.voltage, &airframe.air].map(Option::is_some);
    let volts = at(&flight.voltage, VOLTAGE_AGE_S, of_voltage, airframe.reference_v())?;
    let density = at(&flight.density, AIR_AGE_S, of_air, airframe.reference_density())?;
    Some(Conditions {
        voltage_v: volts as f32,
        density_kg_m3: density as f32,
    })
}

/// Rotors whose output is off, and those that the stack has found dead.
fn health(flight: &Flight, throttle: &[f32], time_s: f64) -> Health {
    let found = flight.failed.as_ref().and_then(|failed| failed.at(time_s));
    let found = found.map_or(0, |mask| mask[0] as u64);
    let is_out = |channel: &usize| throttle[*channel] <= 0.0 || (found >> channel) & 1 == 1;
    let out = (0..throttle.len()).filter(is_out);
    out.fold(Health::GOOD, |health, channel| health.with_failed(channel as u8))
}

/// The accelerometer's offset upwards: its mean beyond gravity and the change of the velocity, m/s2.
fn offset(rows: &[Row], flight: &Flight, velocity: &Series) -> Option<f64> {
    let upward = |time_s: f64| Some(-velocity.at(time_s)?[2]);
    let (mut gained, mut integral, mut seconds) = (0.0, 0.0, 0.0);
    for pair in rows.windows(2).filter(|pair| pair[1].follows) {
        let [from, to] = [pair[0].time_s, pair[1].time_s];
        let cosine = |time_s| {
            flight
                .down
                .as_ref()
                .and_then(|down| down.at(time_s))
                .map_or(1.0, |down| down[2])
        };
        gained += upward(to)? - upward(from)?;
        integral +=
            0.5 * (to - from) * (pair[0].measured[1] * cosine(from) + pair[1].measured[1] * cosine(to));
        seconds += to - from;
    }
    (seconds > 0.0).then(|| integral / seconds - GRAVITY - gained / seconds)
}
