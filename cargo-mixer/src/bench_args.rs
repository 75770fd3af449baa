//! Values of arguments that the commands about benches share.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mixer_identify::bench::air;
use mixer_identify::bench::header::{ROLES, unknown_role};
use mixer_identify::bench::sign::SignChoice;
use mixer_identify::fit::basis::ThrottleBox;

pub(crate) fn finite(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    value.ok_or_else(|| format!("{text:?} is not a number"))
}

/// A finite number for which `holds`; `otherwise` is what is said of another one.
pub(crate) fn number(text: &str, holds: impl Fn(f64) -> bool, otherwise: &str) -> Result<f64, String> {
    match finite(text)? {
        x if holds(x) => Ok(x),
        x => Err(format!("{x} {otherwise}")),
    }
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    number(text, |x| x > 0.0, "is not positive")
}

/// A number above 0 of `units`, as `metres`.
pub(crate) fn quantity(text: &str, units: &str) -> Result<f64, String> {
    positive(text).map_err(|_| format!("{text:?} is not a positive number of {units}"))
}

fn two(text: &str) -> Result<[f64; 2], String> {
    let (a, b) = text
        .split_once(',')
        .ok_or_else(|| format!("{text:?} is not two numbers with a comma"))?;
    Ok([finite(a)?, finite(b)?])
}

pub(crate) fn throttle_box(text: &str) -> Result<ThrottleBox, String> {
    let [min, max] = two(text)?;
    if 0.0 <= min && min < max && max <= 1.0 {
        Ok(ThrottleBox { min, max })
    } else {
        Err(format!("{min},{max} is not 0 <= MIN < MAX <= 1"))
    }
}

/// `LOW,HIGH`, increasing, microseconds.
pub(crate) fn pwm_range(text: &str) -> Result<[f64; 2], String> {
    let [low, high] = two(text)?;
    if low < high {
        Ok([low, high])
    } else {
        Err(format!("{low} is not below {high}"))
    }
}

pub(crate) fn role(text: &str) -> Result<(String, String), String> {
    let (role, value) = text
        .split_once('=')
        .ok_or_else(|| format!("{text:?} is not ROLE=VALUE"))?;
    match ROLES.iter().any(|(known, ..)| *known == role) {
        true => Ok((role.to_string(), value.trim().to_string())),
        false => Err(unknown_role(role).to_string()),
    }
}

pub(crate) fn sign_choice(text: &str) -> Result<SignChoice, String> {
    let one = |t: &str| match t.trim() {
        "+" | "1" | "+1" | "plus" => Ok(1.0),
        "-" | "-1" | "minus" => Ok(-1.0),
        other => Err(format!("{other:?} is neither auto, + nor -")),
    };
    if text.trim() == "auto" {
        return Ok(SignChoice::Auto);
    }
    match text.split_once(',') {
        Some((upper, lower)) => Ok(SignChoice::Given([one(upper)?, one(lower)?])),
        None => one(text).map(|s| SignChoice::Given([s, s])),
    }
}

/// The air at the bench.
#[derive(Debug, Clone, Args)]
pub struct AirArgs {
    /// Temperature of the air at the bench, degrees Celsius: with --pressure it gives `[air]`, in
    /// place of columns of both or of the density.
    #[arg(long, value_name = "C", value_parser = |text: &str| air::temperature(finite(text)?), requires = "pressure", allow_negative_numbers = true)]
    pub temperature: Option<f64>,
    /// Pressure at the place of the bench, hPa, not that reduced to sea level.
    #[arg(long, value_name = "HPA", value_parser = |text: &str| air::pressure(finite(text)?), requires = "temperature")]
    pub pressure: Option<f64>,
    /// Density of the air at the bench, kg/m3, in place of both.
    #[arg(long, value_name = "KG_M3", value_parser = |text: &str| air::density_given(finite(text)?), conflicts_with = "temperature")]
    pub density: Option<f64>,
}

impl AirArgs {
    /// The air, where it is given.
    pub fn air(&self) -> Option<air::Known> {
        let weather = self.temperature.zip(self.pressure);
        let of_density = |density_kg_m3| air::Known {
            density_kg_m3,
            from: "--density".to_owned(),
        };
        let of_weather = weather.and_then(|(t, p)| air::Known::of_weather(t, p).ok());
        self.density.map(of_density).or(of_weather)
    }
}

/// A parser of the words of `all`, each with its value and what it means.
pub(crate) fn words<T: Copy + Send + Sync>(
    all: &'static [(T, &'static str, &'static str)],
) -> impl TypedValueParser<Value = T> {
    let values = all
        .iter()
        .map(|(_, word, meaning)| PossibleValue::new(*word).help(*meaning));
    PossibleValuesParser::new(values).try_map(move |given| {
        let found = all.iter().find(|(_, word, _)| *word == given);
        found.map(|(value, ..)| *value).ok_or("no such word")
    })
}
