//! The table of a flight: what the steps of the manoeuvre cost, from the truth.
//!
//! Errors are against the mean of the second before a step, so that a bias of the stack's estimator
//! is no error of its mixer.

use std::fmt;

use super::flight::Flight;
use super::plan::{FIRST_S, Hold, Plan, Target};
use super::record::{Record, Sample};
use crate::state::wrapped;

/// Time before a step over which the state is averaged, and after it for the root mean square, s.
const BEFORE_S: f64 = 1.0;
const RMS_S: f64 = 3.0;

/// Time before the first step that counts as hover, s.
const HOVER_S: f64 = 3.0;

/// Steps of one kind: the kind, and what was measured of each.
pub type Row = (String, Vec<Step>);

/// What is measured of a step, in the order of [`COLUMNS`]. The time is that of the largest part where there are
/// more, NaN if never; errors of the height are NaN where it is to change.
pub type Step = [f64; 7];

/// The table's columns after the kind and the number of its steps, and their decimals.
pub const COLUMNS: [(&str, usize); 7] = [
    ("time to 90 %, s", 3),
    ("overshoot, %", 1),
    ("height error, most, m", 3),
    ("rms over 3 s, m", 3),
    ("thrust over weight, most", 3),
    ("least", 3),
    ("roll or pitch, most, deg", 2),
];

/// The table.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Throttle in hover by the map that was flown.
    pub model_throttle: f64,
    /// The hover before the first step: means of the stack's thrust setpoint, of all rotors' throttles and of the voltage, V;
    /// standard deviation of the height, m. `None` where the flight did not come to it.
    pub hover: Option<[f64; 4]>,
    /// One row per kind of step.
    pub rows: Vec<Row>,
    /// After a rotor has stopped, until the next step: largest change of roll or pitch and of heading, degrees, and of height, m.
    /// `None` where no rotor stopped, or the flight ended at once.
    pub failure: Option<[f64; 3]>,
    /// Thrust over the first seconds of all steps in heading, against that of the second before: mean, rms, most and least, %.
    pub thrust_percent: Option<[f64; 4]>,
}

impl Score {
    /// Measures a record; only steps that were flown to their end count.
    pub fn new(flight: &Flight) -> Score {
        let vehicle = &flight.world.vehicle;
        let mut score = Score {
            model_throttle: vehicle.hover_throttle,
            hover: None,
            rows: Vec::new(),
            failure: None,
            thrust_percent: None,
        };
        let Some(plan) = flight.pilot.as_ref().and_then(|pilot| pilot.plan()) else {
            return score;
        };
        let flown = Flown(&flight.record);
        score.hover = match plan.steps.is_empty() {
            true => flown.hover(0.0, plan.end_s),
            false => flown.hover(FIRST_S - HOVER_S, FIRST_S),
        };
        let (mut before, mut turns) = (Target::default(), Vec::new());
        let ends = plan.steps.iter().skip(1).map(|(begin_s, _)| *begin_s);
        for ((begin_s, target), end_s) in plan.steps.iter().zip(ends.chain([plan.end_s])) {
            let from = std::mem::replace(&mut before, *target);
            if target.yaw_deg != from.yaw_deg {
                turns.push(*begin_s);
            }
            let measured =
                name(&from, target).zip(flown.step([*begin_s, end_s], &from, target, vehicle.weight_n()));
            let Some((name, step)) = measured else { continue };
            match score.rows.iter_mut().find(|(known, _)| *known == name) {
                Some((_, steps)) => steps.push(step),
                None => score.rows.push((name, vec![step])),
            }
        }
        score.thrust_percent = flown.thrust_percent(&turns);
        score.failure = flight
            .failed_s
            .and_then(|failed_s| flown.after_failure(failed_s, plan));
        score
    }
}

/// Name of a step; `None` where nothing changes.
fn name(from: &Target, to: &Target) -> Option<String> {
    let mut parts = Vec::new();
    let offset = to.offset - from.offset;
    if offset.z != 0.0 {
        parts.push(format!("{} m in height", offset.z.abs()));
    }
    if offset.xy().norm() > 0.0 {
        parts.push(format!("{} m sideways", offset.xy().norm()));
    }
    if to.yaw_deg != from.yaw_deg {
        parts.push(format!("{} deg in yaw", (to.yaw_deg - from.yaw_deg).abs()));
    }
    if to.roll_deg != 0.0 {
        parts.push(format!("{} deg in roll", to.roll_deg.abs()));
    }
    if to.hold == Hold::FullThrust && !parts.is_empty() {
        parts.push("full thrust".to_owned());
    }
    (!parts.is_empty()).then(|| parts.join(", "))
}

struct Flown<'a>(&'a Record);

impl Flown<'_> {
    /// Samples of the manoeuvre from `begin_s` to `end_s`.
    fn between(&self, begin_s: f64, end_s: f64) -> impl Iterator<Item = (f64, &Sample)> + Clone {
        let timed = self
            .0
            .samples
            .iter()
            .filter_map(|sample| Some((sample.manoeuvre_s?, sample)));
        timed.filter(move |(time_s, _)| (begin_s..end_s).contains(time_s))
    }

    /// The mean of a quantity; `None` of no samples.
    fn mean(&self, begin_s: f64, end_s: f64, of: impl Fn(&Sample) -> f64) -> Option<f64> {
        mean(self.between(begin_s, end_s).map(|(_, sample)| of(sample)))
    }

    fn hover(&self, begin_s: f64, end_s: f64) -> Option<[f64; 4]> {
        let over = |of: &dyn Fn(&Sample) -> f64| self.mean(begin_s, end_s, of);
        let height_m = over(&height)?;
        let square = |sample: &Sample| (height(sample) - height_m) * (height(sample) - height_m);
        let throttle = |sample: &Sample| mean(sample.throttles.iter().copied()).unwrap_or_default();
        let setpoint = over(&|sample| sample.thrust_setpoint)?;
        let volts = over(&|sample| sample.voltage_v)?;
        Some([setpoint, over(&throttle)?, volts, over(&square)?.sqrt()])
    }

    fn step(&self, [begin_s, end_s]: [f64; 2], from: &Target, to: &Target, weight_n: f64) -> Option<Step> {
        self.between(end_s - 0.1, end_s).next()?;
        let over = |of: &dyn Fn(&Sample) -> f64| self.mean(begin_s - BEFORE_S, begin_s, of);
        let height_m = over(&height)?;
        let window = || self.between(begin_s, end_s);
        let largest = |of: &dyn Fn(&Sample) -> f64| most(window().map(|(_, sample)| of(sample)));
        let error = |sample: &Sample| (height(sample) - height_m).abs();
        let offset = to.offset - from.offset;
        let holds_height = offset.z == 0.0 && to.hold == Hold::Place;
        let square = |sample: &Sample| error(sample) * error(sample);
        let rms = self.mean(begin_s, begin_s + RMS_S, square)?.sqrt();
        let turn = to.yaw_deg - from.yaw_deg;
        let [north, east] = [
            over(&|sample| sample.position.x)?,
            over(&|sample| sample.position.y)?,
        ];
        let roll = over(&|sample| sample.euler.x)?;
        let aimed = from.yaw_deg.to_radians();
        let yaw = over(&|sample| wrapped(sample.euler.z - aimed))? + aimed;
        let progress = |sample: &Sample, last: f64| {
            if to.roll_deg != 0.0 {
                (sample.euler.x - roll).to_degrees() / to.roll_deg
            } else if offset.xy().norm() > 0.0 {
                let moved = [sample.position.x - north, sample.position.y - east];
                (moved[0] * offset.x + moved[1] * offset.y) / offset.xy().norm_squared()
            } else if offset.z != 0.0 {
                (height(sample) - height_m) / offset.z
            } else {
                // Continuous: a step of 175 degrees may overshoot 180.
                let turned = wrapped(sample.euler.z - yaw).to_degrees() / turn;
                let round = 360.0 / turn.abs();
                turned + round * ((last - turned) / round).round()
            }
        };
        let (mut last, mut furthest, mut rise_s) = (0.0, 0.0f64, f64::NAN);
        for (time_s, sample) in window() {
            last = progress(sample, last);
            furthest = furthest.max(last);
            if last >= 0.9 && rise_s.is_nan() {
                rise_s = time_s - begin_s;
            }
        }
        let held = |value: f64| if holds_height { value } else { f64::NAN };
        Some([
            rise_s,
            100.0 * (furthest - 1.0).max(0.0),
            held(largest(&error)),
            held(rms),
            largest(&|sample| sample.thrust_n / weight_n),
            -largest(&|sample| -(sample.thrust_n / weight_n)),
            largest(&|sample| tilt_deg(sample, [0.0; 2])),
        ])
    }

    fn thrust_percent(&self, begins_s: &[f64]) -> Option<[f64; 4]> {
        let errors = begins_s.iter().flat_map(|&begin_s| {
            let before = self.mean(begin_s - BEFORE_S, begin_s, |sample| sample.thrust_n);
            let after = self
                .between(begin_s, begin_s + RMS_S)
                .map(|(_, sample)| sample.thrust_n);
            after.filter_map(move |thrust_n| Some(100.0 * (thrust_n / before? - 1.0)))
        });
        let errors: Vec<f64> = errors.collect();
        let least = -most(errors.iter().map(|error| -error));
        let rms = mean(errors.iter().map(|error| error * error))?.sqrt();
        Some([
            mean(errors.iter().copied())?,
            rms,
            most(errors.iter().copied()),
            least,
        ])
    }

    fn after_failure(&self, failed_s: f64, plan: &Plan) -> Option<[f64; 3]> {
        let mut begins = plan.steps.iter().map(|(begin_s, _)| *begin_s);
        let next = begins.find(|begin_s| *begin_s > failed_s + 0.1);
        let end_s = next.unwrap_or(plan.end_s);
        let before_s = failed_s - BEFORE_S;
        let over = |of: &dyn Fn(&Sample) -> f64| self.mean(before_s, failed_s, of);
        let height_m = over(&height)?;
        let was = [over(&|sample| sample.euler.x)?, over(&|sample| sample.euler.y)?];
        let first = self.between(before_s, failed_s).next()?.1.euler.z;
        let yaw = first + over(&|sample| wrapped(sample.euler.z - first))?;
        let window = || self.between(failed_s, end_s).map(|(_, sample)| sample);
        window().next()?;
        Some([
            most(window().map(|sample| tilt_deg(sample, was))),
            most(window().map(|sample| wrapped(sample.euler.z - yaw).to_degrees().abs())),
            most(window().map(|sample| (height(sample) - height_m).abs())),
        ])
    }
}

fn height(sample: &Sample) -> f64 {
    -sample.position.z
}

/// The larger of roll and pitch from where they were, degrees.
fn tilt_deg(sample: &Sample, [roll, pitch]: [f64; 2]) -> f64 {
    let [a, b] = [sample.euler.x - roll, sample.euler.y - pitch];
    a.abs().max(b.abs()).to_degrees()
}

/// `None` of nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some([setpoint, throttle, volts, height_m]) = self.hover {
            writeln!(
                f,
                "hover: thrust setpoint {setpoint:.4} (the stack's, in its units), throttle {throttle:.4} (mean of the rotors' commands; \
                 {:.4} by the plant, all alike), height {height_m:.3} m rms, {volts:.2} V",
                self.model_throttle
            )?;
        }
        if let Some([tilt_deg, yaw_deg, height_m]) = self.failure {
            writeln!(
                f,
                "after the rotor has stopped: roll or pitch {tilt_deg:.2} deg, yaw {yaw_deg:.2} deg, height {height_m:.3} m at most"
            )?;
        }
        if let Some([mean, rms, most, least]) = self.thrust_percent {
            writeln!(
                f,
                "thrust over {RMS_S} s of turning, against the second before: {mean:+.2} % in the mean, {rms:.2} % rms, {least:+.1} to {most:+.1} %"
            )?;
        }
        if self.rows.is_empty() {
            return Ok(());
        }
        let titles = COLUMNS.map(|(title, _)| title).join(" | ");
        writeln!(f, "\n| step, mean of n | n | {titles} |")?;
        writeln!(f, "|---|---:|---:|---:|---:|---:|---:|---:|---:|")?;
        for (name, steps) in &self.rows {
            write!(f, "| {name} | {} |", steps.len())?;
            for (column, (_, decimals)) in COLUMNS.into_iter().enumerate() {
                match mean(steps.iter().map(|step| step[column])) {
                    Some(value) if !value.is_nan() => write!(f, " {value:.decimals$} |")?,
                    _ => write!(f, " - |")?,
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::sitl::plan::Manoeuvre;

    /// A flight of heading (degrees), height (m) and roll (degrees) over the time of the manoeuvre.
    fn flown(of: impl Fn(f64) -> [f64; 3]) -> Record {
        let sample = |k: u32| {
            let time_s = f64::from(k) * 0.004;
            let [yaw_deg, height_m, roll_deg] = of(time_s);
            Sample {
                time_s,
                manoeuvre_s: Some(time_s),
                target: None,
                position: Vector3::new(0.0, 0.0, -height_m),
                velocity: Vector3::zeros(),
                // As the truth has it: from -180 to 180 degrees.
                euler: Vector3::new(roll_deg.to_radians(), 0.0, wrapped(yaw_deg.to_radians())),
                rate: Vector3::zeros(),
                thrust_n: 10.0 + roll_deg,
                voltage_v: 15.0,
                current_a: 1.0,
                thrust_setpoint: 0.4,
                throttles: vec![0.5; 8],
            }
        };
        let mut record = Record::default();
        record.samples.extend((0..8000).map(sample));
        record
    }

    fn turn(to: f64) -> Target {
        Target {
            yaw_deg: to,
            ..Target::default()
        }
    }

    #[test]
    fn a_step_of_175_degrees_may_overshoot_180() {
        // A second to 175 degrees, then 10.5 too far; the height sags by 0.2 m meanwhile.
        let record = flown(|t| {
            let t = t - FIRST_S;
            let yaw = if t < 1.0 { 175.0 * t.max(0.0) } else { 185.5 };
            [2.0 + yaw, if (0.0..1.0).contains(&t) { 4.8 } else { 5.0 }, 0.0]
        });
        let step = Flown(&record)
            .step([FIRST_S, FIRST_S + 8.0], &turn(0.0), &turn(175.0), 10.0)
            .unwrap();
        let [
            rise_s,
            overshoot_percent,
            height_most_m,
            height_rms_m,
            thrust_most,
            thrust_least,
            _,
        ] = step;
        assert!((rise_s - 0.9).abs() < 0.005, "{step:?}");
        assert!((overshoot_percent - 6.0).abs() < 0.01, "{step:?}");
        assert!((height_most_m - 0.2).abs() < 1e-9, "{step:?}");
        // One of three seconds.
        assert!((height_rms_m - 0.2 / 3f64.sqrt()).abs() < 1e-3, "{step:?}");
        assert_eq!((thrust_most, thrust_least), (1.0, 1.0));
    }

    #[test]
    fn steps_that_do_not_arrive_or_end_have_no_time() {
        let record = flown(|_| [0.0, 5.0, 0.0]);
        let step = Flown(&record)
            .step([FIRST_S, FIRST_S + 8.0], &turn(0.0), &turn(90.0), 10.0)
            .unwrap();
        assert!(step[0].is_nan() && step[1] == 0.0, "{step:?}");
        assert_eq!(
            Flown(&record).step([FIRST_S + 8.0, FIRST_S + 16.0], &turn(0.0), &turn(90.0), 10.0),
            None
        );
    }

    #[test]
    fn a_step_in_roll_is_measured_within_its_second() {
        // To 16.5 degrees within half a second; then back, which is none of it.
        let record = flown(|t| {
            let t = t - FIRST_S;
            let roll = if t < 1.0 {
                (33.0 * t).clamp(0.0, 16.5)
            } else {
                -40.0
            };
            [0.0, 5.0, 0.2 + roll]
        });
        let plan = Manoeuvre::Roll.plan();
        let begins = [0, 1, 2, 3].map(|step: usize| plan.steps[step].0 - FIRST_S);
        assert_eq!((begins, plan.end_s - FIRST_S), ([0.0, 1.0, 2.0, 10.0], 40.0));
        // A second at an attitude goes before, so that what the step begins at is no setpoint of a place.
        let [(_, from), (_, to)] = [plan.steps[0], plan.steps[1]];
        assert_eq!(
            (from.hold, name(&Target::default(), &from)),
            (Hold::Attitude, None)
        );
        assert_eq!(name(&from, &to).as_deref(), Some("15 deg in roll"));
        let step = Flown(&record)
            .step([FIRST_S, FIRST_S + 1.0], &from, &to, 10.0)
            .unwrap();
        assert!((step[0] - 13.5 / 33.0).abs() < 0.005, "{step:?}");
        assert!((step[1] - 10.0).abs() < 1e-6 && step[2].is_nan(), "{step:?}");
    }

    #[test]
    fn a_turn_in_the_climb_has_no_height_to_hold() {
        let turn_s = FIRST_S + 5.0;
        let record = flown(|t| [(90.0 * (t - turn_s)).clamp(0.0, 90.0), 5.0 * t, 0.0]);
        let plan = Manoeuvre::Climb.plan();
        let [(_, level), (begin_s, from), (begins_s, to)] = [plan.steps[0], plan.steps[1], plan.steps[2]];
        assert_eq!(
            (begin_s, begins_s, plan.end_s),
            (FIRST_S + 1.0, turn_s, FIRST_S + 17.0)
        );
        assert_eq!((level.hold, from.hold), (Hold::Attitude, Hold::FullThrust));
        assert_eq!(name(&level, &from), None);
        assert_eq!(name(&from, &to).as_deref(), Some("90 deg in yaw, full thrust"));
        let step = Flown(&record)
            .step([turn_s, turn_s + 4.0], &from, &to, 10.0)
            .unwrap();
        assert!((step[0] - 0.9).abs() < 0.025 && step[2].is_nan(), "{step:?}");
    }

    #[test]
    fn after_a_failure_the_changes_count() {
        let record = flown(|t| {
            let after = if t < FIRST_S { 0.0 } else { 1.0 };
            [170.0 + 20.0 * after, 5.0 - 0.3 * after, 1.0 + 2.5 * after]
        });
        let plan = Manoeuvre::Failure.plan();
        let after = Flown(&record).after_failure(FIRST_S, &plan).unwrap();
        let expected = [2.5, 20.0, 0.3];
        assert!(
            after.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
            "{after:?}"
        );
    }

    #[test]
    fn steps_are_named_by_what_changes() {
        let names: Vec<Option<String>> = Manoeuvre::Sidestep
            .plan()
            .steps
            .windows(2)
            .map(|pair| name(&pair[0].1, &pair[1].1))
            .collect();
        let both = Some("6 m sideways, 90 deg in yaw".to_owned());
        let plain = Some("6 m sideways".to_owned());
        assert_eq!(names, [both, plain.clone(), plain]);
        assert_eq!(name(&turn(0.0), &turn(0.0)), None);
    }
}
