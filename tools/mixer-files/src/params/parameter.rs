//! A parameter of a flight stack, and what of an airframe the parameters of both stacks need.

use std::fmt;

use mixer_compiler::Compiled;
use mixer_compiler::airframe::{Airframe, Pair};

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

/// To two decimals.
pub(crate) fn hundredths(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

/// Points at which a curve is fitted.
const POINTS: u32 = 50;

/// The a in [0, 1] with which a t^2 + (1 - a) t is nearest to the share of the largest thrust that
/// both rotors give at the throttle t, least squares over the airframe's range; both stacks
/// describe a rotor by this curve. `stretched` counts t from 0 at the least throttle to 1 at the
/// largest.
pub(crate) fn curve(compiled: &Compiled, stretched: bool) -> f64 {
    let map = compiled.mean_map();
    let [min, max] = map.range();
    let full = map.efforts([max, max])[0];
    let (mut products, mut squares) = (0.0, 0.0);
    for k in 0..=POINTS {
        let share = f64::from(k) / f64::from(POINTS);
        let throttle = min + (max - min) * share;
        let t = if stretched { share } else { throttle };
        let bend = t * t - t;
        products += bend * (map.efforts([throttle, throttle])[0] / full - t);
        squares += bend * bend;
    }
    (products / squares).clamp(0.0, 1.0)
}

/// Value of such a curve.
pub(crate) fn on_curve(a: f64, t: f64) -> f64 {
    a * t * t + (1.0 - a) * t
}
