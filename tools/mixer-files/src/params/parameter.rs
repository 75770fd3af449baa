//! A parameter of a flight stack, and what of an airframe the parameters of both stacks need.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Pair};
use mixer_compiler::model::equal_throttle;
use mixer_rt::Health;

/// A parameter of a flight stack.
#[derive(Clone, Debug)]
pub(crate) struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: Value,
    /// Why it has this value; parameters of one reason follow each other.
    pub why: String,
}

/// A parameter's value, in the type that the stack holds it in.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    /// A whole number.
    Whole(i32),
    /// A number in single precision.
    Real(f64),
    /// None: the name is a line of its own.
    Line,
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Whole(value) => write!(f, "{value}"),
            Value::Real(value) => write!(f, "{value}"),
            Value::Line => Ok(()),
        }
    }
}

/// Parameters, and what of them cannot be known or deserves a look.
#[derive(Clone, Debug, Default)]
pub(crate) struct Parameters {
    /// In the order in which they are written.
    pub list: Vec<Parameter>,
    /// A sentence each.
    pub notes: Vec<String>,
}

/// Where parameters of one reason are added.
pub(crate) struct Reason<'a> {
    list: &'a mut Vec<Parameter>,
    why: String,
}

impl Parameters {
    /// The reason of the parameters that follow.
    pub(crate) fn because(&mut self, why: impl Into<String>) -> Reason<'_> {
        Reason {
            list: &mut self.list,
            why: why.into(),
        }
    }

    pub(crate) fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    /// The throttle in hover, which needs the vehicle's mass.
    pub(crate) fn hover(&mut self, name: &str, hover: Option<f64>, why: &str) {
        if let Some(hover) = hover {
            self.because(why).real(name, hover);
        } else {
            self.note(format!(
                "{name} is missing: `[vehicle] mass_kg` of the airframe file gives it"
            ));
        }
    }
}

impl Reason<'_> {
    fn add(&mut self, name: impl Into<String>, value: Value) -> &mut Self {
        let (name, why) = (name.into(), self.why.clone());
        self.list.push(Parameter { name, value, why });
        self
    }

    pub(crate) fn whole(&mut self, name: impl Into<String>, value: i32) -> &mut Self {
        self.add(name, Value::Whole(value))
    }

    /// A line of its own, of Betaflight's CLI.
    pub(crate) fn line(&mut self, line: impl Into<String>) -> &mut Self {
        self.add(line, Value::Line)
    }

    /// With four significant digits and at least four decimals: more is not known of any of them.
    pub(crate) fn real(&mut self, name: impl Into<String>, value: f64) -> &mut Self {
        let digits = 3.0 - libm::floor(libm::log10(value.abs().max(1e-12)));
        let unit = libm::pow(10.0, digits.max(4.0));
        self.add(name, Value::Real((value * unit).round() / unit + 0.0))
    }
}

/// Pulse widths that speed controllers take, microseconds.
pub(crate) const PULSES_US: [f64; 2] = [500.0, 2500.0];

/// Pulse widths of throttle 0 and 1 on the bench, microseconds, where the airframe remembers that
/// `identify` needed them.
pub fn bench_pulses(airframe: &Airframe) -> Option<[f64; 2]> {
    let of = |pair: &Pair| -> Option<[f64; 2]> {
        let options = &pair.bench_options;
        let at = options.iter().position(|option| option == "--pwm-range")?;
        let (low, high) = options.get(at + 1)?.split_once(',')?;
        let us = [low.parse().ok()?, high.parse().ok()?];
        let [least, most] = PULSES_US;
        us.iter().all(|us| (least..=most).contains(us)).then_some(us)
    };
    // Benches that disagree say nothing of the vehicle.
    let mut all = airframe.pairs.iter().map(of);
    let first = all.next()?;
    first.filter(|_| all.all(|other| other == first))
}

/// How a stack's own mixer makes throttles of the shares of the largest thrust that it asks rotors for.
#[derive(Clone, Copy)]
pub(crate) struct OwnCurve {
    /// Throttles of the shares 0 and 1.
    pub range: [f64; 2],
    /// The share of that range for a factor of the curve and a share of the thrust.
    pub output: fn(f64, f64) -> f64,
    /// The share of the thrust that the mixer takes for that share of the range.
    pub share: fn(f64, f64) -> f64,
}

/// Why a fitted factor of a stack's curve has its value.
pub(crate) const STEADIEST: &str = "Fitted: with it the thrust changes least while the frame yaws in hover.";

/// Rises of a throttle for which a factor is judged.
const RISES: u32 = 8;

/// The largest of them: by a third of the throttle in hover one rotor of a pair rises and its partner falls by more.
const LARGEST_RISE: f64 = 1.0 / 3.0;

/// Step of a share for a slope.
const STEP: f64 = 1e-4;

impl OwnCurve {
    /// That of PX4's `THR_MDL_FAC` (`FunctionMotors.hpp`) and ArduPilot's `MOT_THST_EXPO` (`AP_Motors_Thrust_Linearization.cpp`): the
    /// share is a t^2 + (1 - a) t.
    pub(crate) fn parabola(range: [f64; 2]) -> OwnCurve {
        let output = |a: f64, share: f64| {
            let b = 1.0 - a;
            let root = libm::sqrt(b * b + 4.0 * a * share);
            // Without a division by a or 0.
            2.0 * share / (b + root).max(f64::MIN_POSITIVE)
        };
        OwnCurve {
            range,
            output,
            share: |a, t| a * t * t + (1.0 - a) * t,
        }
    }

    /// The factor in [0, 1], to two decimals, with which the frame's thrust changes least while it yaws, in the mean of both senses:
    /// rotors of one spin rise from hover, or from half of the largest thrust where the mass is not known, by up to a third of their
    /// throttle, and the others fall by the same share of the thrust. Least squares. Where upper rotors turn alike, as on a Y6, one
    /// sense lifts more than the other: that is in proportion to the torque, and no factor changes it.
    pub(crate) fn steadiest(&self, compiled: &Compiled) -> f64 {
        let physics = compiled.physics();
        let [idle, top] = self.range;
        let spins: Vec<f64> = compiled.px4_rotors().iter().map(|rotor| rotor[7]).collect();
        let full_n = physics.wrench(&vec![top; spins.len()], [1.0; 2], Health::GOOD)[3];
        let half = || equal_throttle(physics.airframe, physics.maps, 0.5 * full_n);
        let hover = compiled.equal_hover_throttle().or_else(half);
        let hover = self.of_range(hover.unwrap_or(0.5 * top));
        let change = |a: f64, rise: f64, sense: f64| {
            let level = (self.share)(a, hover);
            let yaw = (self.share)(a, hover + rise) - level;
            let throttle = |spin: &f64| {
                let share = level + yaw * sense * spin.signum();
                idle + (top - idle) * (self.output)(a, share.max(0.0))
            };
            let throttles: Vec<f64> = spins.iter().map(throttle).collect();
            physics.wrench(&throttles, [1.0; 2], Health::GOOD)[3]
        };
        let error = |a: f64| {
            let level_n = change(a, 0.0, 1.0);
            let largest = (LARGEST_RISE * hover).min(1.0 - hover);
            let rises = (1..=RISES).map(|k| largest * f64::from(k) / f64::from(RISES));
            let changes = rises.map(|rise| change(a, rise, 1.0) + change(a, rise, -1.0) - 2.0 * level_n);
            changes.map(|change| change * change).sum::<f64>()
        };
        let tried = (0..=100)
            .map(|percent| f64::from(percent) / 100.0)
            .map(|a| (error(a), a));
        tried.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, a)| a)
    }

    /// The share of the largest thrust that the mixer asks for in hover, by a factor of its curve.
    pub(crate) fn hover(&self, compiled: &Compiled, factor: f64) -> Option<f64> {
        let throttle = compiled.equal_hover_throttle()?;
        Some((self.share)(factor, self.of_range(throttle)))
    }

    /// Slope in hover of the thrust over the request, both shares of the largest thrust, by a factor of the curve.
    pub(crate) fn slope_in_hover(&self, compiled: &Compiled, factor: f64) -> Option<f64> {
        let hover = self.hover(compiled, factor)?;
        let [idle, top] = self.range;
        let rise = (self.output)(factor, hover + STEP) - (self.output)(factor, hover - STEP);
        Some(compiled.slope_in_hover()? * (top - idle) * rise / (2.0 * STEP))
    }

    fn of_range(&self, throttle: f64) -> f64 {
        let [idle, top] = self.range;
        (throttle - idle) / (top - idle)
    }
}

/// The note on `gains` that were tuned with a stack's own mixer: `stock` and `fitted` are the slopes of its thrust in hover as it comes
/// (`settings`) and by what `--own` writes, over that of this mixer.
pub(crate) fn gains_note(gains: &str, settings: &str, [stock, fitted]: [Option<f64>; 2]) -> String {
    match stock.zip(fitted) {
        Some((stock, fitted)) => format!(
            "{gains}: for the same loop gain those that were tuned with {settings} are multiplied by {stock:.3}, those that were tuned \
             with what `params --own` writes by {fitted:.3}, the slopes of the thrust over the request in hover"
        ),
        None => format!(
            "{gains}: which factor keeps the loop gain is known with `[vehicle] mass_kg` in the airframe file; one unit of yaw is then \
             the slope in hover"
        ),
    }
}

#[cfg(test)]
mod tests {
    use mixer_compiler::Source;

    use super::*;

    /// Rotors that take no notice of each other: the upper ones with 9 d^2 + 6 d, the lower ones with a share of it.
    fn isolated(units: u32, lower: f64) -> Compiled {
        let [square, line] = [9.0 * lower, 6.0 * lower];
        let [torque, torque_line] = [0.02 * square, 0.02 * line];
        let text = format!(
            "name = \"a\"\n[throttle]\nmin = 0.1\nmax = 1.0\n[vehicle]\nmass_kg = 2.0\n\
             [pair]\nbasis = \"cubic\"\nupper_spin = \"cw\"\n\
             thrust_n = [0, 0, 0, 0, 9, 0, {square}, 6, {line}]\n\
             torque_nm = [0, 0, 0, 0, -0.18, 0, {torque}, -0.12, {torque_line}]\n\
             [layout]\narm_m = 0.4\nunits = {units}\nfirst_angle_deg = 45.0\n"
        );
        mixer_compiler::compile(&Source::new("a.toml", text)).unwrap()
    }

    /// They have one factor with which yaw leaves the thrust alone: that of their curve over the range of the stack, also
    /// where one sense of yaw lifts more than the other, as on a Y6 with weaker lower rotors.
    #[test]
    fn of_isolated_rotors_the_factor_is_that_of_their_curve() {
        let frames = [isolated(4, 1.0), isolated(3, 0.7)];
        let ranges = [[0.0, 1.0], [0.15, 1.0], [0.1, 0.95]];
        for (compiled, [idle, top]) in frames.iter().flat_map(|frame| ranges.map(|range| (frame, range))) {
            // 9 d^2 + 6 d at d = idle + (top - idle) t.
            let (square, line) = (
                9.0 * (top - idle) * (top - idle),
                (top - idle) * (6.0 + 18.0 * idle),
            );
            let curve = OwnCurve::parabola([idle, top]);
            let factor = curve.steadiest(compiled);
            assert!(
                (factor - square / (square + line)).abs() <= 0.005,
                "{idle}: {factor}"
            );
        }
    }

    /// A mixer that has the rotors' curve makes of a request its share of the thrust.
    #[test]
    fn with_the_rotors_curve_the_slope_is_one() {
        let compiled = isolated(4, 1.0);
        let curve = OwnCurve::parabola([0.0, 1.0]);
        let slopes = [0.6, 0.0].map(|factor| curve.slope_in_hover(&compiled, factor).unwrap());
        assert!((slopes[0] - 1.0).abs() < 1e-4, "{slopes:?}");
        assert!(
            (slopes[1] - compiled.slope_in_hover().unwrap()).abs() < 1e-6,
            "{slopes:?}"
        );
    }
}
