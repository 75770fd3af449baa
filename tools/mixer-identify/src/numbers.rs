//! What a run must be, in numbers that need no unit: each with what right files have, and what a value outside means.
//!
//! `identify` and `predict` read the table for every file, `check` has its limits of what a map alone shows
//! ([`TORQUE_SPAN_M`], [`GROWTH`]). A value with a standard error is outside where it is by four of them. Of one group
//! the first number outside is named: it explains those behind it. `docs/warnings.md` has what the files at hand have.

use std::f64::consts::PI;

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use mixer_compiler::model::{GROWTH, TORQUE_PER_THRUST_M, TORQUE_SPAN_M};

use crate::bench::{Bench, BenchKind, Point, equal_commands, is_one_signal};
use crate::fit::Design;
use crate::fit::robust::JUDGING;
use crate::fit::voltage::off_span;
use crate::refusal::Refusal;
use crate::statistics::{dot, extent, greatest, median};

/// One of them.
#[derive(Clone, Copy)]
pub struct Number {
    /// What it is.
    pub name: &'static str,
    /// Where it lies in right files.
    pub limits: [f64; 2],
    /// Beyond these the file is refused.
    refused: [f64; 2],
    /// Cause and mend of a value outside.
    outside: Outside,
    /// The value and its standard error.
    of: fn(&Run) -> Option<[f64; 2]>,
}

/// A number outside.
#[derive(Debug, Clone)]
pub struct Anomaly {
    /// The file.
    pub file: String,
    /// The number, and the cause of it.
    pub text: String,
    /// What mends it.
    pub mend: String,
    name: &'static str,
    /// Of [`TABLE`].
    group: usize,
}

impl Anomaly {
    /// All that is said.
    pub(crate) fn sentence(&self) -> String {
        format!("{}: {}; {}", self.file, self.text, self.mend)
    }

    /// The refusal of a map, with the rows that explain it.
    pub(crate) fn explains(anomalies: &[Anomaly], refusal: Refusal) -> Refusal {
        match anomalies.iter().find(|anomaly| anomaly.group == 1) {
            Some(rows) => Refusal::of(
                &rows.file,
                format!("{}; {}", rows.text, refusal.reason),
                &rows.mend,
            ),
            None => refusal,
        }
    }

    /// Whether it is of rows by their neighbours or of the shape, which a drift changes as well.
    pub(crate) fn of_shape(&self) -> bool {
        (1..=2).contains(&self.group)
    }

    /// Whether it is a constant in the torque.
    pub(crate) fn is_torque_at_rest(&self) -> bool {
        self.name == TORQUE_AT_LOWEST
    }
}

/// Standard errors by which a value must be outside.
const SURE: f64 = 4.0;
const NEVER: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const TORQUE_AT_LOWEST: &str =
    "torque at the lowest throttle, beyond what the thrust there explains, over the greatest";
const LOWER_OVER_UPPER: &str =
    "thrust of the lower rotor over the upper one's at equal throttles, per torque where it is known";
const GROWS: &str =
    "power of the throttle with which thrust grows from middle to highest throttle, at one voltage";
/// Air in which nothing else is known, kg/m3.
const AIR: f64 = 1.2;

const ONE_ROTOR: Outside = [
    "a unit is wrong, the diameter, or this is no run of ONE rotor",
    "right units and diameter; where one signal drives both rotors of a pair, PRIOR",
];
const ZERO: Outside = [
    "the load cells read something at rest",
    "set the load cells to zero at rest, or record some rows at rest (throttle 0) before and after, which --tare takes off",
];

const fn number(
    name: &'static str,
    limits: [f64; 2],
    refused: [f64; 2],
    of: fn(&Run) -> Option<[f64; 2]>,
    outside: Outside,
) -> Number {
    Number {
        name,
        limits,
        refused,
        outside,
        of,
    }
}

/// Sizes, rows by their neighbours, shape, voltage. Rows out of order bend the shape as well.
pub const TABLE: [&[Number]; 4] = [&SIZES, &ROWS, &SHAPE, &VOLTAGE];

type Outside = [&'static str; 2];

#[rustfmt::skip]
const SIZES: [Number; 9] = [
    number("shaft power over electrical power", [0.4, 1.03], NEVER,
        |run| exact(median(run.points.iter().map(|p| p.shaft_w / p.power_w))?), [
            "the torque is a force at an arm, of another arm or in another unit, the current of one rotor, or the speed that of the motor's field",
            "torque in N m (force times arm) in its column, or --unit torque=UNIT; current and speed of all rotors that turn"]),
    number("torque per thrust in m", TORQUE_SPAN_M, TORQUE_PER_THRUST_M,
        |run| {
            let [low, high] = extent(run.of(|p| p.torque));
            exact((high.max(0.0) - low.min(0.0)) / run.most(|p| p.thrust)).filter(|[x, _]| *x > 0.0)
        }, [
            "propellers of 4 to 40 inch have that: a unit is another one, or this is no run of ONE rotor",
            "the units of both: --unit thrust=UNIT, --unit torque=UNIT; where one signal drives both rotors of a pair, PRIOR"]),
    number(LOWER_OVER_UPPER, [0.45, f64::INFINITY], NEVER,
        lower_over_upper, ["the stand of the lower rotor is in another unit than that of the upper one", "--unit lower_thrust=UNIT"]),
    number(LOWER_OVER_UPPER, [f64::NEG_INFINITY, 1.05], NEVER,
        lower_over_upper, [
            "the one taken as upper works in the wake of the other, or its stand is in another unit",
            "--swap exchanges the rotors; else --unit upper_thrust=UNIT"]),
    number("T^5 / (Q^4 rho n^2) of thrust, torque, density and speed (1/s)", [1.2e3, 1.8e4], NEVER,
        |run| {
            let rotors = [0, 1].into_iter().filter_map(|rotor| run.without_diameter(rotor));
            exact(rotors.max_by_key(|x| (1e3 * libm::log(x / 4.7e3).abs()) as i64)?)
        }, [
            "thrust or torque is in another unit (twice the thrust is 32 times as much, twice the torque a 16th), or the speed not the rotor's",
            "the units of both: --unit thrust=UNIT, --unit torque=UNIT; the rotor's revolutions per minute"]),
    // By momentum theory. A rotor in a wake has less.
    number("figure of merit (ideal over shaft power)", [0.48, 0.76], NEVER,
        |run| run.single(|p, d| ideal_w(p, d) / p.shaft_w), ONE_ROTOR),
    number("torque per thrust in diameters", [0.03, 0.1], [0.02, 0.15],
        |run| run.single(|p, d| p.torque / p.thrust / d), ONE_ROTOR),
    number("disc loading in N/m2", [15.0, 2500.0], [15.0, 2500.0],
        |run| run.single(|p, d| p.thrust / (0.25 * PI * d * d)), ONE_ROTOR),
    // A pair by the power of one rotor has 1.1.
    number("ideal power over electrical power", [0.15, 0.8], [0.08, 0.95],
        |run| run.single(|p, d| ideal_w(p, d) / p.power_w), ONE_ROTOR),
];

#[rustfmt::skip]
const ROWS: [Number; 2] = [
    number("share of the row after in each row", UP_TO_2_PERCENT, NEVER,
        |run| run.neighbour(true), [
            "thrust and torque are means over several rows (a moving average)",
            "the rows as they were measured, without smoothing"]),
    number("share of the row before in each row", UP_TO_2_PERCENT, NEVER,
        |run| run.neighbour(false), [
            "a row holds what the one before it gave (a short dwell, a low pass, a mean that begins too early)",
            "rows that begin after the step has settled: a longer dwell, or a mean over its end"]),
];

#[rustfmt::skip]
const SHAPE: [Number; 5] = [
    number(GROWS, [GROWTH[0], f64::INFINITY], NEVER, |run| run.growth(), [
            "something linearised the throttle (MOT_THST_EXPO, THR_MDL_FAC: about 1), or the supply reached its limit, which a column of the \
             voltage shows",
            "the outputs that the speed controllers got as throttles, or that correction switched off; the voltage of each row"]),
    number(GROWS, [f64::NEG_INFINITY, GROWTH[1]], NEVER, |run| run.growth(), [
            "the throttle is of another range of pulses",
            "the pulses that were sent, with --pwm-range LOW,HIGH of throttle 0 and 1, or shares of that range"]),
    number(TORQUE_AT_LOWEST, [f64::NEG_INFINITY, 0.03], NEVER,
        |run| {
            let (_, at) = run.equal.first().filter(|_| run.lowest().is_some())?;
            let [f, q] = [run.most(|p| p.thrust), run.most(|p| p.torque)];
            exact((at.torque / q).abs() - 0.2 * at.thrust.max(0.0) / f)
        }, ZERO),
    number("thrust at the lowest throttle over the greatest", [0.001, f64::INFINITY], NEVER,
        |run| run.lowest(), [
            "rotors may stand still there, or the load cells read something at rest",
            "without the rows below IDLE, where both turn; else set the load cells to zero at rest, or record some rows at rest for --tare"]),
    number("thrust over the speeds squared at the lowest throttle over that at the highest", [0.2, 1.45], NEVER,
        |run| {
            let at = |p: &Point| p.thrust / p.rpm.iter().map(|n| n * n).sum::<f64>();
            let [(_, low), (_, high)] = [run.equal.first()?, run.equal.last()?];
            exact(at(low) / at(high)).filter(|_| run.lowest().is_some())
        }, ZERO),
];

#[rustfmt::skip]
const VOLTAGE: [Number; 4] = [
    number("span of the voltage over the greatest, beside a power that varies", [1e-4, f64::INFINITY], NEVER,
        |run| {
            let ([low, high], [least, most]) = (extent(run.of(|p| p.voltage)), extent(run.of(|p| p.power_w)));
            exact((high - low) / high).filter(|_| run.points.len() >= 5 && most > 2.0 * least)
        }, [
            "the voltage is that of the pack at rest, or was typed in",
            "the voltage of each row under load, --column voltage=HEADER; a supply that holds it to the last digit needs nothing"]),
    number("share of the sag that the throttles of the row before explain", [f64::NEG_INFINITY, 0.4], NEVER,
        |run| {
            let (own, volts) = (run.of(load), run.of(|p| p.voltage));
            let before = run.pair()?.beside(&own, false);
            let ones = vec![1.0; own.len()];
            let [late, error] = slope(&[&ones, &own], &before, &volts)?;
            let all = late + slope(&[&ones, &before], &own, &volts)?[0];
            Some([late / all, (error / all).abs()])
        }, [
            "the voltage is that of the row before (another logger, a slow meter)",
            "its column moved up by one row, or a meter read when the step has settled"]),
    number("share of the sag that is of each voltage's own rotor more than of the other", [-0.2, f64::INFINITY], NEVER,
        |run| {
            let (sums, ones) = (run.pair()?.of(load), vec![1.0; run.points.len()]);
            let own = run.of(|p| cube(p.u) - cube(p.l));
            let apart = run.of(|p| 2.0 * p.imbalance * p.voltage);
            let sum = run.of(|p| 2.0 * p.voltage);
            let ([of_own, error], [all, _]) =
                (slope(&[&ones, &sums], &own, &apart)?, slope(&[&ones], &sums, &sum)?);
            Some([of_own / all, (error / all).abs()])
        }, [
            "the voltages of the rotors are exchanged",
            "--column voltage=HEADER of the upper rotor and --column lower_voltage=HEADER of the lower one"]),
    number("voltage of the lower meter less that of the upper one without load, over their mean", [-0.03, 0.03], NEVER,
        |run| {
            let (u, l) = (run.of(|p| cube(p.u)), run.of(|p| cube(p.l)));
            slope(&[&u, &l], &vec![1.0; u.len()], &run.of(|p| -2.0 * p.imbalance))
        }, [
            "two meters of one supply differ, or each rotor has a supply of its own",
            "of one supply the column of the right meter for both: --column voltage=HEADER --column lower_voltage=HEADER"]),
];

const UP_TO_2_PERCENT: [f64; 2] = [f64::NEG_INFINITY, 0.02];

/// A file whose numbers are looked at.
pub struct Run<'a> {
    bench: &'a Bench,
    points: &'a [Point],
    diameter_m: Option<f64>,
    /// Rows of one rotor, or of a pair with equal throttles, by their throttle.
    equal: Vec<(f64, &'a Point)>,
}

/// Throttles that differ by less are equal.
const EQUAL: f64 = 0.01;

impl<'a> Run<'a> {
    /// The run of a bench; the diameter of its propeller, m, where it is known.
    pub fn new(bench: &'a Bench, diameter_m: Option<f64>) -> Run<'a> {
        let near = bench
            .points
            .iter()
            .filter(|p| bench.kind == BenchKind::SingleRotor || (p.u - p.l).abs() < EQUAL);
        let throttle = |p: &Point| {
            if bench.kind == BenchKind::Pair {
                0.5 * (p.u + p.l)
            } else {
                p.u
            }
        };
        let mut equal: Vec<(f64, &Point)> = near.map(|p| (throttle(p), p)).collect();
        equal.sort_by(|a, b| a.0.total_cmp(&b.0));
        Run {
            bench,
            points: &bench.points,
            diameter_m,
            equal,
        }
    }

    /// The numbers of the table with their values here.
    pub fn values(&self) -> impl Iterator<Item = (usize, &'static Number, [f64; 2])> {
        let all = TABLE
            .into_iter()
            .enumerate()
            .flat_map(|(group, all)| all.iter().map(move |number| (group, number)));
        all.filter_map(|(group, number)| {
            Some((group, number, (number.of)(self).filter(|[x, _]| x.is_finite())?))
        })
    }

    fn pair(&self) -> Option<&Self> {
        (self.bench.kind == BenchKind::Pair).then_some(self)
    }

    fn of(&self, value: fn(&Point) -> f64) -> Vec<f64> {
        self.points.iter().map(value).collect()
    }

    fn most(&self, value: fn(&Point) -> f64) -> f64 {
        greatest(&self.of(value))
    }

    /// A number of one rotor and the diameter of its propeller, at its greatest throttle.
    fn single(&self, value: fn(&Point, f64) -> f64) -> Option<[f64; 2]> {
        let fastest = self.points.iter().max_by(|a, b| a.u.total_cmp(&b.u));
        let fastest = fastest.filter(|_| self.bench.kind == BenchKind::SingleRotor);
        exact(value(fastest?, self.diameter_m?))
    }

    /// Values of the rows after or before each; its own where there is none, 0 where there are rows at rest.
    fn beside(&self, values: &[f64], after: bool) -> Vec<f64> {
        let line = |k: usize| self.points[k].line;
        let at = |k: usize| {
            let other = if after { k + 1 } else { k.wrapping_sub(1) };
            let Some(value) = values.get(other) else {
                return values[k];
            };
            let between = line(k.min(other))..line(k.max(other));
            let rests = self.bench.rests.iter().any(|rest| between.contains(rest));
            if rests { 0.0 } else { *value }
        };
        (0..values.len()).map(at).collect()
    }

    /// What each row has of the fitted row after or before it, of thrust or torque, whichever shows it better.
    fn neighbour(&self, after: bool) -> Option<[f64; 2]> {
        let places: Vec<[f64; 2]> = self.pair()?.points.iter().map(|p| [p.u, p.l]).collect();
        let design = Design::within_its_points(JUDGING, &places).ok()?;
        let share = |value| {
            let y = self.of(value);
            let missed = design.residuals(&y, &design.coordinates(&y));
            let fitted: Vec<f64> = y.iter().zip(&missed).map(|(y, e)| y - e).collect();
            let [own, other] = [after, !after].map(|after| self.beside(&fitted, after));
            let rows = design.q.iter().zip(&other);
            let rows: Vec<Vec<f64>> = rows.map(|(q, other)| [q, &[*other][..]].concat()).collect();
            along(&rows, &own, &y)
        };
        let shares = [share(|p| p.thrust), share(|p| p.torque)].into_iter().flatten();
        shares.max_by(|[a, e], [b, f]| (a / e).total_cmp(&(b / f)))
    }

    /// The power of the throttle with which thrust, brought to one voltage, grows between the equal throttles next to
    /// the middle and the end of their range. A throttle that is a speed has no pulses and nothing to linearise.
    fn growth(&self) -> Option<[f64; 2]> {
        let (low, high) = (self.equal.first()?.0, self.equal.last()?.0);
        let distance = |(t, _): &&(f64, &Point)| (t - 0.5 * (low + high)).abs();
        let middle = self
            .equal
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let [(from, a), (to, b)] = [middle?, self.equal.last()?];
        let sag = Some(a.voltage / b.voltage)
            .filter(|sag| sag.is_finite())
            .unwrap_or(1.0);
        let thrust = libm::pow(sag, TYPICAL_EXPONENT) * b.thrust / a.thrust;
        let growth = libm::log(thrust) / libm::log(to / from);
        exact(growth).filter(|_| *to > 1.2 * from && !self.bench.holds_speed)
    }

    /// T^5 / (Q^4 rho n^2) of a rotor at its greatest thrust.
    fn without_diameter(&self, rotor: usize) -> Option<f64> {
        let own = |p: &Point| match self.pair() {
            None => [p.thrust, p.torque],
            Some(_) => [p.cells[rotor].abs(), p.cells[2 + rotor]],
        };
        let most = self
            .points
            .iter()
            .max_by(|a, b| own(a)[0].total_cmp(&own(b)[0]))?;
        let ([f, q], n) = (own(most), most.rpm[rotor] / 60.0);
        let air = self.bench.air.as_ref().map_or(AIR, |air| air.density_kg_m3);
        let value = libm::pow(f, 5.0) / (libm::pow(q, 4.0) * air * n * n);
        Some(value).filter(|x| x.is_finite() && *x > 0.0)
    }

    /// The lowest equal throttle that gives thrust.
    fn turning(&self) -> String {
        let least = 0.001 * self.most(|p| p.thrust);
        let first = self.equal.iter().find(|(_, p)| p.thrust > least);
        first.map_or("them".into(), |(throttle, _)| format!("{throttle:.2}"))
    }

    /// The share of the greatest thrust at the lowest equal throttles of a map over the whole range.
    fn lowest(&self) -> Option<[f64; 2]> {
        let [(low, at), (high, _)] = [self.pair()?.equal.first()?, self.equal.last()?];
        exact(at.thrust / self.most(|p| p.thrust)).filter(|_| *low < 0.151 && *high > 0.499)
    }
}

fn exact(value: f64) -> Option<[f64; 2]> {
    Some([value, 0.0])
}

/// The power that a disc needs for the thrust, W.
fn ideal_w(p: &Point, diameter_m: f64) -> f64 {
    libm::pow(p.thrust, 1.5) / (0.5 * AIR * PI * diameter_m * diameter_m).sqrt()
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// What the current of both rotors follows.
fn load(p: &Point) -> f64 {
    cube(p.u) + cube(p.l)
}

fn lower_over_upper(run: &Run) -> Option<[f64; 2]> {
    let ratio = |cell: usize| {
        let equal = run.points.iter().filter(|p| is_one_signal([p.u, p.l]));
        let [upper, lower] = equal.fold([0.0; 2], |[a, b], p| [a + p.cells[cell], b + p.cells[cell + 1]]);
        Some((lower / upper).abs()).filter(|ratio| ratio.is_finite())
    };
    exact(ratio(0)? / ratio(2).unwrap_or(1.0))
}

/// The coefficient of x beside these columns in y, and its standard error.
fn slope(columns: &[&Vec<f64>], x: &[f64], y: &[f64]) -> Option<[f64; 2]> {
    let rows: Vec<Vec<f64>> = (0..x.len())
        .map(|k| columns.iter().map(|column| column[k]).collect())
        .collect();
    along(&rows, x, y)
}

fn along(rows: &[Vec<f64>], x: &[f64], y: &[f64]) -> Option<[f64; 2]> {
    let (own, rest) = (off_span(rows, x)?, off_span(rows, y)?);
    let freedom = rows
        .len()
        .checked_sub(rows.first()?.len() + 1)
        .filter(|&n| n > 0)?;
    let size = dot(&own, &own);
    let slope = dot(&own, &rest) / size;
    let left = (dot(&rest, &rest) - slope * slope * size).max(0.0);
    Some([slope, (left / freedom as f64 / size).sqrt()]).filter(|value| value.iter().all(|x| x.is_finite()))
}

/// What is outside of the numbers of a file.
///
/// # Errors
/// A number that no pair, or no rotor, has.
pub(crate) fn anomalies(bench: &Bench, diameter_m: Option<f64>) -> Result<Vec<Anomaly>, Refusal> {
    let mut found: Vec<Anomaly> = Vec::new();
    let run = Run::new(bench, diameter_m);
    for (group, number, [x, error]) in run.values() {
        let is_outside = |[low, high]: [f64; 2]| x + SURE * error < low || x - SURE * error > high;
        let is_explained = |anomaly: &Anomaly| anomaly.group == group || (anomaly.group, group) == (1, 2);
        if bench.record_drifts && (1..=2).contains(&group) {
            continue;
        }
        if !is_outside(number.limits) || !is_outside(number.refused) && found.iter().any(is_explained) {
            continue;
        }
        let [low, high] = number.limits;
        let within = format!("{low} to {high}").replace("-inf to", "at most");
        let within = within.replace("to inf", "and more");
        let [cause, mend] = number.outside;
        let mend = mend
            .replace("PRIOR", &equal_commands(&[&bench.file]))
            .replace("IDLE", &run.turning());
        let text = format!(
            "the {} is {}, of right files {within}: {cause}",
            number.name,
            two_digits(x)
        );
        if is_outside(number.refused) {
            return Err(Refusal::of(&bench.file, text, mend));
        }
        found.push(Anomaly {
            file: bench.file.clone(),
            text,
            mend,
            name: number.name,
            group,
        });
    }
    Ok(found)
}

fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}
