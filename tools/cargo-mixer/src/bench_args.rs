//! Values of arguments that the commands about benches share.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use mixer_compiler::quantity::{self, Quantity};
use mixer_identify::bench::Preparation;
use mixer_identify::bench::air;
use mixer_identify::bench::header::{ByHand, ROLES, unknown_role};
use mixer_identify::bench::read::Reading;
use mixer_identify::bench::sign::{SignChoice, SignPolicy};
use mixer_identify::fit::basis::ThrottleBox;
use mixer_identify::identified::Settings;

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

/// A parser of a value that this quantity has on benches.
pub(crate) fn of(quantity: Quantity) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync {
    move |text| quantity.check(finite(text)?)
}

/// Largest exponent that is taken: a propeller has 2.5 at most.
const LARGEST_EXPONENT: f64 = 4.0;

/// Exponents of thrust and of torque.
pub(crate) fn exponents(text: &str) -> Result<[f64; 2], String> {
    let (thrust, torque) = text.split_once(',').unwrap_or((text, text));
    let exponent = |text| match positive(text)? {
        x if x > LARGEST_EXPONENT => Err(format!(
            "{x} is above {LARGEST_EXPONENT}; propellers have 1 to 2.5"
        )),
        x => Ok(x),
    };
    Ok([exponent(thrust)?, exponent(torque)?])
}

/// A throttle that turns a rotor.
pub(crate) fn throttle(text: &str) -> Result<f64, String> {
    number(text, |x| 0.0 < x && x <= 1.0, "is no throttle above 0, up to 1")
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
pub fn pwm_range(text: &str) -> Result<[f64; 2], String> {
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
    // The throttle of one rotor.
    let role = if role == "throttle" { "upper" } else { role };
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

/// How bench files are read.
#[derive(Debug, Clone, Args)]
pub struct ReadingArgs {
    /// Pulse widths of throttle 0 and 1, microseconds [default for pulse-width columns: 1000,2000].
    #[arg(long, value_name = "LOW,HIGH", value_parser = pwm_range)]
    pub pwm_range: Option<[f64; 2]>,
    /// The speed controllers hold a speed: the speed at full throttle, revolutions per minute.
    /// Where a file has columns of speeds, throttle is these over it.
    #[arg(long, value_name = "RPM", value_parser = of(quantity::SPEED))]
    pub rpm_at_full: Option<f64>,
    /// A column by hand, as upper="ESC A" or lower=#5 (number from 1). Roles: upper, lower, thrust,
    /// torque, upper_thrust, lower_thrust, upper_torque, lower_torque, voltage, lower_voltage,
    /// current, upper_current, lower_current, power, upper_power, lower_power, upper_speed, lower_speed,
    /// time, temperature, pressure, density (of the air).
    #[arg(long = "column", value_name = "ROLE=HEADER", value_parser = role)]
    pub columns: Vec<(String, String)>,
    /// A unit by hand, as thrust=gf, for a header without one.
    #[arg(long = "unit", value_name = "ROLE=UNIT", value_parser = role)]
    pub units: Vec<(String, String)>,
    /// Exchange upper and lower rotor.
    #[arg(long)]
    pub swap: bool,
    /// Take off all rows what the load cells read at rest, in the mean of the rows at rest: throttle 0
    /// with speeds of 0 or several rows that agree.
    #[arg(long)]
    pub tare: bool,
    /// Sign of thrust: auto, + or -; +,- and the like for a column per rotor (upper, lower).
    #[arg(long, value_name = "SIGN", default_value = "auto", value_parser = sign_choice, allow_hyphen_values = true)]
    pub thrust_sign: SignChoice,
    /// Sign of torque, likewise; torque is positive where the lower rotor outweighs the upper.
    #[arg(long, value_name = "SIGN", default_value = "auto", value_parser = sign_choice, allow_hyphen_values = true)]
    pub torque_sign: SignChoice,
}

impl ReadingArgs {
    /// The settings that these ask for, the rest as without options.
    pub fn settings(&self) -> Settings {
        Settings {
            reading: Reading {
                by_hand: ByHand {
                    columns: self.columns.clone(),
                    units: self.units.clone(),
                    full_rpm: self.rpm_at_full,
                    swap: self.swap,
                    ..ByHand::default()
                },
                pwm_range: self.pwm_range,
            },
            preparation: Preparation {
                tare: self.tare,
                signs: SignPolicy {
                    thrust: self.thrust_sign,
                    torque: self.torque_sign,
                },
                ..Preparation::default()
            },
            options: self.options(),
            ..Settings::default()
        }
    }

    /// These as words of a command line, without those that say what holds without them.
    fn options(&self) -> Vec<String> {
        let signs =
            [self.thrust_sign, self.torque_sign].map(|sign| (sign != SignChoice::Auto).then_some(sign));
        let one = [
            (
                "--pwm-range",
                self.pwm_range.map(|[low, high]| format!("{low},{high}")),
            ),
            ("--rpm-at-full", self.rpm_at_full.map(|rpm| rpm.to_string())),
            ("--thrust-sign", signs[0].map(|sign| sign.to_string())),
            ("--torque-sign", signs[1].map(|sign| sign.to_string())),
        ];
        let of_roles = |option: &'static str, roles: &[(String, String)]| {
            let words = roles.iter().map(|(role, value)| format!("{role}={value}"));
            words.map(|word| (option, Some(word))).collect::<Vec<_>>()
        };
        let all = of_roles("--column", &self.columns)
            .into_iter()
            .chain(of_roles("--unit", &self.units))
            .chain(one);
        let given = all.filter_map(|(option, value)| Some([option.to_owned(), value?]));
        let flags = [("--swap", self.swap), ("--tare", self.tare)].into_iter();
        let flags = flags.filter(|(_, is)| *is).map(|(flag, _)| flag.to_owned());
        given.flatten().chain(flags).collect()
    }

    /// Those that [`Settings::options`] has as words.
    ///
    /// # Errors
    /// Words that are no such options.
    pub fn remembered(options: &[String]) -> Result<ReadingArgs, String> {
        let read = parsed("identify", options.iter().map(String::as_str));
        read.map_err(|told: String| told.lines().next().unwrap_or_default().to_owned())
    }
}

/// The arguments of a command from its words.
///
/// # Errors
/// Words that are no such arguments.
pub fn parsed<'a, A: Args>(
    command: &'static str,
    words: impl IntoIterator<Item = &'a str>,
) -> Result<A, String> {
    let words = [command].into_iter().chain(words);
    let command = A::augment_args(clap::Command::new(command));
    let matches = command.try_get_matches_from(words);
    let read = matches.and_then(|matches| A::from_arg_matches(&matches));
    read.map_err(|error| said(&error))
}

/// What clap says of arguments, without what is about a command line.
pub fn said(error: &clap::Error) -> String {
    let told = error.render().to_string();
    let ends = ["\n\nUsage:", "\n\nFor more information"].map(|end| told.find(end).unwrap_or(told.len()));
    let told = &told[..ends[0].min(ends[1])];
    told.trim_start_matches("error: ").to_owned()
}

/// The air at the bench.
#[derive(Debug, Clone, Args)]
pub struct AirArgs {
    /// Temperature of the air at the bench, degrees Celsius: with --pressure it gives `[air]`, in
    /// place of columns of both or of the density.
    #[arg(long, value_name = "C", value_parser = of(quantity::TEMPERATURE), requires = "pressure", allow_negative_numbers = true)]
    pub temperature: Option<f64>,
    /// Pressure at the place of the bench, hPa, not that reduced to sea level.
    #[arg(long, value_name = "HPA", value_parser = of(quantity::PRESSURE), requires = "temperature")]
    pub pressure: Option<f64>,
    /// Density of the air at the bench, kg/m3, in place of both.
    #[arg(long, value_name = "KG_M3", value_parser = of(quantity::DENSITY), conflicts_with = "temperature")]
    pub density: Option<f64>,
}

impl AirArgs {
    /// The air, where it is given.
    pub fn air(&self) -> Option<air::BenchAir> {
        let weather = self.temperature.zip(self.pressure);
        let of_density = |density_kg_m3| air::BenchAir {
            density_kg_m3,
            from: "--density".to_owned(),
        };
        let of_weather = weather.and_then(|(t, p)| air::BenchAir::of_weather(t, p).ok());
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
