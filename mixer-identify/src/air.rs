//! The air at the bench, which thrust and torque follow.
//!
//! rho = p / (287.05 T), dry. With ordinary speed controllers a rotor in thin air acts like one at a
//! lower voltage: T(u; V, s rho) = T(u; s V, rho) / s by similarity of motor and propeller, so that
//! thrust and torque follow the density to the power k - 1 where they follow the voltage to the power
//! k. A speed that the controller holds gives 1. Electrical power is V I, so that it follows s^2 less
//! than at the voltage s V.

use mixer_compiler::atmosphere::density;
use serde::Serialize;

use crate::bench::Bench;
use crate::rotor::single::EXPONENT;
use crate::statistics::extent;

/// Temperatures and pressures of benches, degrees Celsius and hPa, and densities, kg/m3.
const TEMPERATURES_C: [f64; 2] = [-40.0, 55.0];
const PRESSURES_HPA: [f64; 2] = [450.0, 1090.0];
pub(crate) const DENSITIES: [f64; 2] = [0.5, 1.65];

/// Densities in flight, kg/m3, where nothing else is known, and what they are.
const IN_FLIGHT: [f64; 2] = [0.75, 1.4];
const OF_FLIGHT: &str = "in flight: 3,000 m at 40 C to sea level at -20 C";

/// Exponent of the density where that of the voltage is the usual one.
pub const DENSITY_EXPONENT: f64 = EXPONENT - 1.0;

/// A density, and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Known {
    /// kg/m3.
    pub density_kg_m3: f64,
    /// As `20 C and 1013 hPa`.
    pub from: String,
}

impl Known {
    /// That of a temperature, degrees Celsius, and a pressure at the place, hPa.
    ///
    /// # Errors
    /// Values that no bench has, with the unit that they may be in.
    pub fn of_weather(temperature_c: f64, pressure_hpa: f64) -> Result<Known, String> {
        Ok(Known {
            density_kg_m3: density(
                100.0 * pressure(pressure_hpa)?,
                temperature(temperature_c)? + 273.15,
            ),
            from: format!("{temperature_c} C and {pressure_hpa} hPa"),
        })
    }
}

fn within(value: f64, [low, high]: [f64; 2], unit: &str, mends: &[(f64, f64, &str)]) -> Result<f64, String> {
    let holds = |x: f64| (low..=high).contains(&x);
    if holds(value) {
        return Ok(value);
    }
    let mut mends = mends
        .iter()
        .map(|(factor, offset, of)| (factor * value + offset, of));
    let mend = mends.find(|(x, _)| holds(*x));
    let mend = mend.map_or(String::new(), |(x, of)| format!("; in {of} it is {x:.1} {unit}"));
    Err(format!("{value} is not within {low} to {high} {unit}{mend}"))
}

/// A temperature of benches, degrees Celsius.
///
/// # Errors
/// Another one, with what it may be.
pub fn temperature(celsius: f64) -> Result<f64, String> {
    let mends = [
        (1.0, -273.15, "kelvin"),
        (5.0 / 9.0, -160.0 / 9.0, "degrees Fahrenheit"),
    ];
    within(celsius, TEMPERATURES_C, "degrees Celsius", &mends)
}

/// A pressure of benches, hPa.
///
/// # Errors
/// Another one, with what it may be.
pub fn pressure(hpa: f64) -> Result<f64, String> {
    let mends = [
        (0.01, 0.0, "Pa"),
        (10.0, 0.0, "kPa"),
        (1000.0, 0.0, "bar"),
        (33.863_886, 0.0, "inches of mercury"),
        (1.333_224, 0.0, "mm of mercury"),
    ];
    within(hpa, PRESSURES_HPA, "hPa", &mends)
}

/// A density of benches, kg/m3.
///
/// # Errors
/// Another one.
pub fn density_given(kg_m3: f64) -> Result<f64, String> {
    within(
        kg_m3,
        DENSITIES,
        "kg/m3",
        &[(1e3, 0.0, "g/cm3"), (1e-3, 0.0, "g/m3")],
    )
}

/// The air of an identification.
#[derive(Debug, Clone, Serialize)]
pub struct Air {
    /// At the bench, or in the mean of the files, to which their rows are brought, kg/m3; none where
    /// it is not known.
    pub density_kg_m3: Option<f64>,
    /// Where it comes from.
    pub from: String,
    /// Least and greatest of the files, kg/m3.
    pub range_kg_m3: Option<[f64; 2]>,
    /// Exponents of thrust and of torque.
    pub exponents: [f64; 2],
}

impl Air {
    /// The air of files whose thrust and torque follow it by `exponents`.
    pub fn of<'a>(benches: impl IntoIterator<Item = &'a Bench>, exponents: [f64; 2]) -> Air {
        let known: Vec<&Known> = benches.into_iter().filter_map(|b| b.air.as_ref()).collect();
        let densities = || known.iter().map(|k| k.density_kg_m3);
        let mean = densities().sum::<f64>() / known.len() as f64;
        let mut from: Vec<&str> = known.iter().map(|k| k.from.as_str()).collect();
        from.dedup();
        Air {
            density_kg_m3: (!known.is_empty()).then(|| (1e4 * mean).round() / 1e4),
            from: from.join(", "),
            range_kg_m3: (!known.is_empty()).then(|| extent(densities())),
            exponents,
        }
    }

    /// Brings the rows of a file to this density.
    pub(crate) fn bring(&self, bench: &mut Bench) {
        let own = bench.air.as_ref().map(|own| own.density_kg_m3);
        if let Some((own, reference)) = own.zip(self.density_kg_m3) {
            let [f, q] = self.exponents;
            for p in &mut bench.points {
                *p = p.divided(own / reference, [f, q, 1.5 * f - 0.5]);
            }
        }
    }

    /// `[air]`, in comments where the density is not known; with exponents where `[voltage]` has
    /// none.
    pub fn table(&self, voltage_has_exponents: bool) -> String {
        let [low, high] = IN_FLIGHT;
        let reference = self.density_kg_m3;
        let [low, high] = [
            reference.map_or(low, |r| low.min(r)),
            reference.map_or(high, |r| high.max(r)),
        ];
        let mut lines = vec![
            "[air]".to_owned(),
            match reference {
                Some(density) => {
                    let line = format!("reference_density_kg_m3 = {density:?}");
                    format!("{line:<38} # of the bench: {}", self.from)
                }
                None => format!(
                    "{:<38} # of the bench: p / (287.05 T)",
                    "reference_density_kg_m3 = ?"
                ),
            },
            format!(
                "{:<38} # {OF_FLIGHT}",
                format!("range_kg_m3 = [{low:?}, {high:?}]")
            ),
        ];
        if !voltage_has_exponents {
            let why = match self.exponents == [1.0; 2] {
                true => "the speed controllers hold a speed",
                false => "of the voltage less 1; 1 where the controllers hold a speed",
            };
            let names = ["thrust_exponent", "torque_exponent"].into_iter();
            lines.extend(names.zip(self.exponents).map(|(name, e)| {
                let line = format!("{name} = {:?}", (1e3 * e).round() / 1e3);
                format!("{line:<38} # {why}")
            }));
        }
        match reference {
            Some(_) => lines
                .iter()
                .fold("\n".to_owned(), |text, line| text + line + "\n"),
            None => lines
                .iter()
                .fold(TO_FILL_IN.to_owned(), |text, line| text + "# " + line + "\n"),
        }
    }
}

impl Default for Air {
    /// Not known, with the usual exponents.
    fn default() -> Air {
        Air::of([], [DENSITY_EXPONENT; 2])
    }
}

const TO_FILL_IN: &str = "\n# No [air]: the mixer takes the bench's air at any altitude and temperature; at 3,000 m thrust is 20 % short.\n\
                          # To follow it, fill in what is open and uncomment: p is the pressure at the place, Pa, not that reduced\n\
                          # to sea level, T in K. (--temperature and --pressure of `identify` and `predict` do it.)\n";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weather_in_other_units_is_told() {
        let known = Known::of_weather(20.0, 1013.25).expect("a density");
        assert!((known.density_kg_m3 - 1.2041).abs() < 1e-4, "{known:?}");
        assert_eq!(known.from, "20 C and 1013.25 hPa");
        for (told, wanted) in [
            (temperature(293.15), "in kelvin it is 20.0 degrees Celsius"),
            (
                temperature(68.0),
                "in degrees Fahrenheit it is 20.0 degrees Celsius",
            ),
            (pressure(101_325.0), "in Pa it is 1013.2 hPa"),
            (pressure(101.3), "in kPa it is 1013.0 hPa"),
            (pressure(29.92), "in inches of mercury it is 1013.2 hPa"),
            (pressure(-3.0), "-3 is not within 450 to 1090 hPa"),
            (density_given(1204.0), "in g/m3 it is 1.2 kg/m3"),
        ] {
            let told = told.expect_err("another unit");
            assert!(told.contains(wanted), "{told}");
        }
    }
}
