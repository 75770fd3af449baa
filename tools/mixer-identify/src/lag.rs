//! The lag of a rotor, from a log of steps of its throttle.
//!
//! The speed w, over that of full throttle, follows the throttle d by the law of the simulator and of `mix_dynamic`
//! (docs/simulator.md), with s the share of the voltage that the motor's resistance takes at full throttle:
//!
//! ```text
//! t dw/dt = d - (1 - s) w - s w^2,   q = (1 - s) + 2 s w = sqrt((1 - s)^2 + 4 s d) at rest,   1/lag = q / t
//! ```
//!
//! After a step it has a closed form: with q_d the end, q = q_d (q_0 + q_d T) / (q_d + q_0 T), T = tanh(q_d time / (2 t)). A
//! controller that does not brake gives no less than the back-EMF (1 - s) w: 1/w then grows by s / t.
//!
//! Speed is affine in w, thrust in w^2. Both ends of every step are fitted with the step's own delay, so neither the curve of
//! the throttle nor when the row was written matters. What is left of all steps, by least squares, tells t; the steps, each
//! left out in turn (the jackknife), tell its interval.

use std::collections::BTreeMap;

use mixer_compiler::flywheel::ohmic_share;
use serde::Serialize;

use crate::bench::STOP_THROTTLE;
use crate::bench::read::Log;
use crate::fit::{student_t_975, ten_digits};
use crate::refusal::Refusal;
use crate::statistics::{extent, mean_of_finite};

/// What steps tell of a rotor.
#[derive(Debug, Clone, Serialize)]
pub struct RotorLag {
    /// The throttle that the lags are of.
    pub throttle: f64,
    /// The lag there, s, by all steps.
    pub lag_s: f64,
    /// Its 95 % interval, s.
    pub interval_s: [f64; 2],
    /// Lags by the steps up alone and by those down alone, s, as if the controller braked.
    pub up_down_s: [f64; 2],
    /// Steps up and down.
    pub steps: [usize; 2],
    /// Whether the controller brakes; `None` where the steps down are too small to tell.
    pub brakes: Option<bool>,
    /// Whether speeds were logged; else thrust.
    pub by_speed: bool,
    /// Names of the logs.
    pub files: Vec<String>,
}

/// A step of the throttle.
#[derive(Debug)]
struct Step {
    /// Throttles before and after.
    ends: [f64; 2],
    /// For how long either is held, s.
    held_s: f64,
    /// Time between the last row before and the first one after, s.
    gap_s: f64,
    /// Time since the first row after, s, and what was measured: from the middle of the time before.
    rows: Vec<[f64; 2]>,
}

/// Throttles nearer than this are one command.
const SAME_COMMAND: f64 = 0.005;

/// Least change of a throttle that is a step, and the least throttle of one: below, controllers start a rotor by rules of their own.
const STEP: f64 = 0.02;
const LEAST_THROTTLE: f64 = 10.0 * STOP_THROTTLE;

/// Fewest steps each way, and fewest rows of a command that is held.
const STEPS: usize = 3;
const ROWS: usize = 8;

/// Lags that are looked for, s, at so many of them in geometric order.
const LAGS_S: [f64; 2] = [0.008, 2.0];
const GRID: usize = 72;

/// Of a flight: a part that is left out in turn, fewest and most of them; the time that the law takes to forget where it began; the
/// longest time between rows that follow each other, s; fewest rows a second.
const PART_S: f64 = 5.0;
const PARTS: usize = 4;
const MOST_PARTS: usize = 24;
const FORGOTTEN_S: f64 = 1.0;
const FLIGHT_GAP_S: f64 = 0.25;
const FLIGHT_HZ: f64 = 18.0;

/// Longest delay from the row of a command to the rotor, s.
const DELAY_S: f64 = 0.1;

/// A step is fitted for so many lags, and needs a command that is held for so many.
const FITTED: f64 = 8.0;
const HELD: f64 = 3.0;

/// Fewest new values within two lags after a step, in the mean.
const NEW_VALUES: f64 = 1.8;

/// Logarithm of a likelihood ratio above which one law is preferred; neighbouring rows share some of their noise.
const PREFERRED: f64 = 10.0;

/// Largest ratio of the interval's ends that serves: half of the true lag is harmless, twice of it is not.
const WIDEST: f64 = 2.0;

const NEEDED: &str = "time, throttle and speed (or thrust) of one rotor at 50 Hz or more, its throttle stepping within one row between two \
                      that are held for half a second, three times up and down at least";

/// The lag at a throttle of the rotor whose steps these logs have; `exponent` is the voltage's.
///
/// # Errors
/// Logs without time, without steps, with rows that are too rare, or whose steps tell no lag.
pub fn find(logs: &[Log], exponent: f64, throttle: f64) -> Result<RotorLag, Refusal> {
    let files: Vec<String> = logs.iter().map(|log| log.name.clone()).collect();
    let refuse = |reason: String| Err(Refusal::of(files.join(", "), reason, NEEDED));
    let by_speed = logs.iter().all(has_speeds);
    let mut steps: Vec<Step> = logs.iter().flat_map(|log| of_log(log, by_speed)).collect();
    let law = Law {
        share: ohmic_share(exponent, 1.0),
        throttle,
        by_speed,
    };
    let mut window_s = f64::INFINITY;
    let mut lag_s = f64::NAN;
    for _ in 0..3 {
        let [up, down] = [true, false].map(|up| steps.iter().filter(|step| step.is_up() == up).count());
        if up.min(down) < STEPS {
            let longer = if lag_s.is_nan() {
                String::new()
            } else {
                format!(" held for {HELD} lags of {lag_s:.3} s")
            };
            return refuse(format!("{up} steps of the throttle up and {down} down{longer}"));
        }
        lag_s = least_of(
            &law.profiles(steps.iter().filter(|step| step.is_up()), false, window_s),
            None,
        );
        window_s = FITTED * lag_s;
        steps.retain(|step| step.held_s > HELD * lag_s);
    }
    let new_values = mean_of_finite(steps.iter().map(|step| step.new_values(2.0 * lag_s)));
    if new_values < NEW_VALUES {
        return refuse(format!(
            "the rows are too rare: {new_values:.1} new values in the first {:.3} s of a step",
            2.0 * lag_s
        ));
    }
    let (ups, downs): (Vec<&Step>, Vec<&Step>) = steps.iter().partition(|step| step.is_up());
    let sides = [&ups, &downs];
    let up_down_s = sides.map(|of| least_of(&law.profiles(of.iter().copied(), false, window_s), None));
    // The better of two laws for the steps down, by the lag of those up.
    let [braking, coasting] = [false, true].map(|coasts| {
        let misfits = downs
            .iter()
            .map(|step| law.misfit(step, up_down_s[0], coasts, window_s));
        misfits.sum::<f64>().max(f64::MIN_POSITIVE)
    });
    let rows: usize = downs.iter().map(|step| step.within(window_s).count()).sum();
    let preference = rows as f64 * libm::log(braking / coasting);
    let brakes = (preference.abs() > PREFERRED).then_some(preference < 0.0);
    let profiles = law.profiles(steps.iter(), brakes == Some(false), window_s);
    let (lag_s, interval_s) = agreed(&profiles);
    if !tells(interval_s) {
        let [low, high] = interval_s;
        return refuse(format!(
            "the steps agree on no lag: {lag_s:.3} s, {low:.3} to {high:.3} s of them"
        ));
    }
    Ok(RotorLag {
        throttle,
        lag_s,
        interval_s,
        up_down_s,
        steps: sides.map(Vec::len),
        brakes,
        by_speed,
        files,
    })
}

/// What is known of the rotors of a flight.
#[derive(Debug, Clone, Copy)]
pub struct Flown {
    /// Exponent of the thrust over the voltage.
    pub exponent: f64,
    /// The throttle that the lag is of.
    pub throttle: f64,
    /// Whether their controllers brake.
    pub brakes: bool,
}

/// The lag of rotors that fly, s, with its 95 % interval: rows of time, s, throttle and speed of each rotor, on which its throttle is
/// taken to go straight from row to row. `None` where rows are rarer than 20 Hz, or tell no lag.
///
/// As by steps, but the law is followed from row to row, and parts of five seconds are left out in turn. Speeds that come late by up
/// to a tenth of a second are known from a lag.
pub fn in_flight(rotors: &[Vec<[f64; 3]>], flown: Flown) -> Option<(f64, [f64; 2])> {
    let law = Law {
        share: ohmic_share(flown.exponent, 1.0),
        throttle: flown.throttle,
        by_speed: true,
    };
    let mut parts: BTreeMap<i64, Vec<&[[f64; 3]]>> = BTreeMap::new();
    for rows in rotors {
        let part = |row: &[f64; 3]| (row[0] / PART_S).floor() as i64;
        for run in rows.chunk_by(|a, b| part(a) == part(b) && b[0] - a[0] < FLIGHT_GAP_S) {
            let seconds = run[run.len() - 1][0] - run[0][0];
            if seconds > 0.5 * PART_S && run.len() as f64 > FLIGHT_HZ * seconds {
                parts.entry(part(&run[0])).or_default().push(run);
            }
        }
    }
    let every = parts.len().div_ceil(MOST_PARTS).max(1);
    let profiles: Vec<Vec<f64>> = parts
        .values()
        .step_by(every)
        .map(|runs| {
            grid(|lag_s| {
                let left = |delay_s| {
                    runs.iter()
                        .map(|run| left_of(law.flown(run, lag_s, delay_s, !flown.brakes)))
                        .sum()
                };
                least(left, [0.0, DELAY_S])
            })
        })
        .collect();
    if profiles.len() < PARTS {
        return None;
    }
    Some(agreed(&profiles)).filter(|(_, interval_s)| tells(*interval_s))
}

/// Whether speeds were measured: loggers write zeros where they are not.
fn has_speeds(log: &Log) -> bool {
    let speeds = log.samples.iter().flat_map(|sample| sample.speed);
    let [low, high] = extent(speeds.filter(|x| x.is_finite()));
    high > low
}

/// The steps of the rotor that has more of them.
fn of_log(log: &Log, by_speed: bool) -> Vec<Step> {
    let of_side = |side: usize| {
        let rows = log.samples.iter().map(|sample| {
            let [own, whole] = [sample.thrust.rotors[side], sample.thrust.whole];
            let thrust = if own.is_finite() { own } else { whole };
            [
                sample.time_s,
                sample.throttle[side],
                if by_speed { sample.speed[side] } else { thrust },
            ]
        });
        steps(
            &rows
                .filter(|row| row.iter().all(|x| x.is_finite()))
                .collect::<Vec<_>>(),
        )
    };
    let [upper, lower] = [0, 1].map(of_side);
    if lower.len() > upper.len() { lower } else { upper }
}

/// The steps of rows of time, s, throttle and what was measured.
fn steps(rows: &[[f64; 3]]) -> Vec<Step> {
    let holds: Vec<&[[f64; 3]]> = rows.chunk_by(|a, b| (a[1] - b[1]).abs() < SAME_COMMAND).collect();
    let step = |pair: &[&[[f64; 3]]]| {
        let [before, after] = pair else { return None };
        let ends = [before, after].map(|hold| mean_of_finite(hold.iter().map(|row| row[1])));
        let is_held = [before, after].iter().all(|hold| {
            let [low, high] = extent(hold.iter().map(|row| row[1]));
            hold.len() >= ROWS && high - low < 2.0 * SAME_COMMAND
        });
        let is_step = (ends[1] - ends[0]).abs() > STEP && ends[0].min(ends[1]) > LEAST_THROTTLE;
        let held_s = [before, after].map(|hold| hold[hold.len() - 1][0] - hold[0][0]);
        let (last, first) = (before[before.len() - 1][0], after[0][0]);
        let rows = before[before.len() / 2..].iter().chain(*after);
        (is_held && is_step).then(|| Step {
            ends,
            held_s: held_s[0].min(held_s[1]),
            gap_s: first - last,
            rows: rows.map(|row| [row[0] - first, row[2]]).collect(),
        })
    };
    holds.windows(2).filter_map(step).collect()
}

impl Step {
    fn is_up(&self) -> bool {
        self.ends[1] > self.ends[0]
    }

    /// The rows that are not farther from the step.
    fn within(&self, window_s: f64) -> impl Iterator<Item = &[f64; 2]> {
        self.rows.iter().filter(move |row| row[0].abs() <= window_s)
    }

    /// How many values that are new follow within a time.
    fn new_values(&self, time_s: f64) -> f64 {
        let is_new =
            |pair: &&[[f64; 2]]| pair[1][0] > 0.0 && pair[1][0] <= time_s && pair[1][1] != pair[0][1];
        self.rows.windows(2).filter(is_new).count() as f64
    }
}

/// The lag of all profiles, s, and its interval by those that are left out in turn.
fn agreed(profiles: &[Vec<f64>]) -> (f64, [f64; 2]) {
    let lag_s = least_of(profiles, None);
    let count = profiles.len();
    let left_out: Vec<f64> = (0..count)
        .map(|out| libm::log(least_of(profiles, Some(out)) / lag_s))
        .collect();
    let mean = mean_of_finite(left_out.iter().copied());
    let square = mean_of_finite(left_out.iter().map(|x| (x - mean) * (x - mean)));
    let half_width = student_t_975(count - 1) * ((count - 1) as f64 * square).sqrt();
    (
        lag_s,
        [-half_width, half_width].map(|half| lag_s * libm::exp(half)),
    )
}

/// Whether an interval serves: narrow, and away from the grid's begin, where a flat profile has its least.
fn tells([low, high]: [f64; 2]) -> bool {
    high <= WIDEST * low && at(1.5) < low && high < LAGS_S[1]
}

/// What a straight line leaves of rows of a model and what was measured, by least squares.
fn left_of(rows: Vec<[f64; 2]>) -> f64 {
    let means = [0, 1].map(|k| mean_of_finite(rows.iter().map(|row| row[k])));
    let moment = |a: usize, b: usize| -> f64 {
        rows.iter()
            .map(|row| (row[a] - means[a]) * (row[b] - means[b]))
            .sum()
    };
    moment(1, 1) - moment(0, 1) * moment(0, 1) / moment(0, 0).max(f64::MIN_POSITIVE)
}

/// How rotors follow.
struct Law {
    /// s.
    share: f64,
    /// The throttle that lags are of.
    throttle: f64,
    by_speed: bool,
}

impl Law {
    /// q at rest at a throttle.
    fn root(&self, throttle: f64) -> f64 {
        let s = self.share;
        ((1.0 - s) * (1.0 - s) + 4.0 * s * throttle).sqrt()
    }

    /// w of q.
    fn of_root(&self, q: f64) -> f64 {
        (q - (1.0 - self.share)) / (2.0 * self.share)
    }

    /// q after a time of a throttle; the time is over t.
    fn after(&self, mut q: f64, to: f64, coasts: bool, mut time: f64) -> f64 {
        let s = self.share;
        let w = self.of_root(q);
        let slowest = to / (1.0 - s);
        if coasts && slowest < w {
            let coasting = time.min((1.0 / slowest - 1.0 / w) / s);
            time -= coasting;
            q = (1.0 - s) + 2.0 * s * w / (1.0 + s * w * coasting);
        }
        let end = self.root(to);
        let grown = libm::tanh(0.5 * end * time);
        end * (q + end * grown) / (end + q * grown)
    }

    /// What is left of a step's rows, by least squares over both ends and the delay.
    fn misfit(&self, step: &Step, lag_s: f64, coasts: bool, window_s: f64) -> f64 {
        let time_s = lag_s * self.root(self.throttle);
        let [from, to] = step.ends;
        let left = |delay_s: f64| {
            let model = |row: &[f64; 2]| {
                let time = (row[0] - delay_s).max(0.0) / time_s;
                let w = self.of_root(self.after(self.root(from), to, coasts, time));
                if self.by_speed { w } else { w * w }
            };
            left_of(step.within(window_s).map(|row| [model(row), row[1]]).collect())
        };
        least(left, [-step.gap_s, DELAY_S])
    }

    /// w and the speed of rows of a flight, but of those before the law has forgotten where it began.
    fn flown(&self, rows: &[[f64; 3]], lag_s: f64, delay_s: f64, coasts: bool) -> Vec<[f64; 2]> {
        let time_s = lag_s * self.root(self.throttle);
        let mut q = self.root(rows[0][1]);
        // The throttle a time ago, on the line through the rows around it; `last` is a row after it.
        let throttle = |time: f64, last: usize| {
            let after = (1..=last)
                .rev()
                .take_while(|k| rows[k - 1][0] > time)
                .last()
                .map_or(last, |k| k - 1);
            let [from, to] = [rows[after.max(1) - 1], rows[after.max(1)]];
            let share = ((time - from[0]) / (to[0] - from[0])).clamp(0.0, 1.0);
            from[1] + share * (to[1] - from[1])
        };
        let mut told = Vec::new();
        for k in 1..rows.len() {
            let [from, to] = [rows[k - 1][0], rows[k][0]];
            let given = throttle(0.5 * (from + to) - delay_s, k);
            q = self.after(q, given, coasts, (to - from) / time_s);
            if to - rows[0][0] > FORGOTTEN_S {
                told.push([self.of_root(q), rows[k][2]]);
            }
        }
        told
    }

    /// What is left of each step by each lag of the grid.
    fn profiles<'a>(
        &self,
        steps: impl Iterator<Item = &'a Step>,
        coasts: bool,
        window_s: f64,
    ) -> Vec<Vec<f64>> {
        steps
            .map(|step| grid(|lag_s| self.misfit(step, lag_s, coasts, window_s)))
            .collect()
    }
}

/// A function at the lags of the grid.
fn grid(of: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..GRID).map(|k| of(at(k as f64))).collect()
}

/// The lag of a place on the grid, s.
fn at(place: f64) -> f64 {
    LAGS_S[0] * libm::pow(LAGS_S[1] / LAGS_S[0], place / (GRID - 1) as f64)
}

/// The lag, s, by which least is left of all steps but one: on the parabola through the least of the grid and its neighbours.
fn least_of(profiles: &[Vec<f64>], but: Option<usize>) -> f64 {
    let kept = || profiles.iter().enumerate().filter(|(k, _)| Some(*k) != but);
    let left: Vec<f64> = (0..GRID)
        .map(|place| kept().map(|(_, of)| of[place]).sum())
        .collect();
    let best = (1..GRID - 1)
        .min_by(|a, b| left[*a].total_cmp(&left[*b]))
        .unwrap_or_default();
    let [before, least, after] = [left[best - 1], left[best], left[best + 1]];
    let bend = before - 2.0 * least + after;
    let off = if bend > 0.0 {
        0.5 * (before - after) / bend
    } else {
        0.0
    };
    ten_digits(at(best as f64 + off.clamp(-1.0, 1.0)))
}

/// The least value of a function between two places, by the golden section.
fn least(of: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut values = inner.map(&of);
    for _ in 0..14 {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            values = [of(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            values = [values[1], of(inner[1])];
        }
    }
    values[0].min(values[1])
}

#[cfg(test)]
mod tests;
