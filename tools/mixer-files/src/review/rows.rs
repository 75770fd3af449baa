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
use mixer_rt::Health;

use crate::review::flight::Flight;
use crate::review::log::{Series, median};

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

/// Time on the ground from which on what follows is another flight, s: both of [`NEAR_GROUND_S`], less a step of the outputs.
const ON_GROUND_S: f64 = 2.5;

/// Ages beyond which a value counts as missing, s: of attitude, velocity, rates and force; of voltage and current; of the density; of a
/// rotor's speed.
const MOTION_AGE_S: f64 = 0.5;
const VOLTAGE_AGE_S: f64 = 3.0;
const AIR_AGE_S: f64 = 60.0;
const SPEED_AGE_S: f64 = 1.0;

/// Share of the other rotors' speed below which one has stopped.
const STOPS: f64 = 0.1;

/// Times between outputs that are further apart than this do not follow each other, s.
const GAP_S: f64 = 0.5;

/// Share of the weight above which a vehicle flies whose log does not say so.
const CARRIES: f64 = 0.7;

/// One instant.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) time_s: f64,
    /// Number of the take-off, from 1.
    pub(crate) flight: usize,
    /// Throttle of each output, 0 where it is off.
    pub(crate) throttle: Vec<f32>,
    /// Rotors that are off.
    pub(crate) health: Health,
    /// Voltage, V, and density of the air, kg/m3.
    pub(crate) conditions: [f32; 2],
    /// Speed of each rotor, rpm; NaN where it is not known.
    pub(crate) speeds: Vec<f64>,
    /// Of the battery, A.
    pub(crate) current_a: Option<f64>,
    /// Roll, pitch, yaw (N m) and thrust (N) of the model.
    pub(crate) model: [f64; 4],
    /// Thrust over mass by the accelerometer, m/s2: by the body's axis, and by the vertical part.
    pub(crate) measured: [f64; 2],
    /// The earth's downward direction in body axes.
    pub(crate) down: [f64; 3],
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
        let physics = compiled.physics();
        let mut rows = Rows::default();
        let mut before: Option<f64> = None;
        let (mut take_offs, mut on_ground_s) = (0, f64::INFINITY);
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
            let speeds = speeds(flight, rotors, time_s);
            let health = health(flight, &throttle, &speeds, time_s);
            let known = conditions(flight, compiled, time_s).map(|conditions| {
                let [volts, density] = conditions.map(f64::from);
                let factors = compiled.airframe.factors(volts, density);
                (conditions, physics.wrench(&throttle, factors, health))
            });
            let carries = || known.is_some_and(|(_, model)| model[3] > CARRIES * mass_kg * GRAVITY);
            let landed = flight.landed.as_ref();
            if !landed.map_or_else(carries, |landed| flies(landed, time_s)) {
                on_ground_s += time_s - last;
                continue;
            }
            take_offs += usize::from(on_ground_s > ON_GROUND_S);
            on_ground_s = 0.0;
            // The accelerometer around the time of the outputs: half a step to each side.
            let half = 0.5 * (time_s - last);
            let force = flight.force.mean(time_s - half, time_s + half, MOTION_AGE_S);
            let upright: &[f64] = &[0.0, 0.0, 1.0];
            let down = flight.down.as_ref();
            let down = down.map_or(Some(upright), |down| down.fresh(time_s, MOTION_AGE_S));
            let (Some(force), Some(down), Some((conditions, model))) = (force, down, known) else {
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
            let current = flight
                .current
                .as_ref()
                .and_then(|current| current.fresh(time_s, VOLTAGE_AGE_S));
            rows.rows.push(Row {
                time_s,
                flight: take_offs,
                speeds,
                current_a: current.map(|row| row[0]),
                throttle,
                health,
                conditions,
                model,
                measured: [-force[2], -along / down[2].max(0.1)],
                down: std::array::from_fn(|axis| down[axis]),
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

    /// Median of a number over the rows that are chosen; `None` where none is.
    pub(crate) fn median(&self, is_of: impl Fn(&Row) -> bool, number: impl Fn(&Row) -> f64) -> Option<f64> {
        let chosen = self.rows.iter().filter(|row| is_of(row));
        Some(median(chosen.map(number))).filter(|median| median.is_finite())
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
        // The sum of nothing is -0.
        pairs.map(|pair| pair[1].time_s - pair[0].time_s).sum::<f64>() + 0.0
    }
}

/// Voltage and density at a time; the reference of one that was never measured, or that thrust does not follow.
/// `None` where one is missing at the time.
fn conditions(flight: &Flight, compiled: &Compiled, time_s: f64) -> Option<[f32; 2]> {
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
    Some([volts as f32, density as f32])
}

/// Speed of each rotor; NaN where it is not known.
fn speeds(flight: &Flight, rotors: usize, time_s: f64) -> Vec<f64> {
    let speed = |output: usize| Some(flight.speeds.get(output)?.fresh(time_s, SPEED_AGE_S)?[0]);
    (0..rotors)
        .map(|output| speed(output).unwrap_or(f64::NAN))
        .collect()
}

/// Rotors whose output is off, those that the stack has found dead, and those that stand while others turn.
fn health(flight: &Flight, throttle: &[f32], speeds: &[f64], time_s: f64) -> Health {
    let usual = median(speeds.iter().copied().filter(|speed| speed.is_finite()));
    let found = flight.failed.as_ref().and_then(|failed| failed.at(time_s));
    let found = found.map_or(0, |mask| mask[0] as u64);
    let is_out = |channel: &usize| {
        throttle[*channel] <= 0.0 || (found >> channel) & 1 == 1 || speeds[*channel] < STOPS * usual
    };
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
