//! What is known of the air at a bench: a density, from a temperature and a pressure that benches
//! have.

use mixer_compiler::atmosphere::density;
use serde::Serialize;

/// Temperatures and pressures of benches, degrees Celsius and hPa, and densities, kg/m3.
const TEMPERATURES_C: [f64; 2] = [-40.0, 55.0];
const PRESSURES_HPA: [f64; 2] = [450.0, 1090.0];
pub(crate) const DENSITIES: [f64; 2] = [0.5, 1.65];

/// A density, and where it comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BenchAir {
    /// kg/m3.
    pub density_kg_m3: f64,
    /// As `20 C and 1013 hPa`.
    pub from: String,
}

impl BenchAir {
    /// That of a temperature, degrees Celsius, and a pressure at the place, hPa.
    ///
    /// # Errors
    /// Values that no bench has, with the unit that they may be in.
    pub fn of_weather(temperature_c: f64, pressure_hpa: f64) -> Result<BenchAir, String> {
        Ok(BenchAir {
            density_kg_m3: density(
                100.0 * pressure(pressure_hpa)?,
                temperature(temperature_c)? + 273.15,
            ),
            from: format!("{temperature_c} C and {pressure_hpa} hPa"),
        })
    }
}

/// A value in the first other unit (factor, offset, name) in which it is within the range, with that name.
pub fn meant<'a>(value: f64, [low, high]: [f64; 2], units: &[(f64, f64, &'a str)]) -> Option<(f64, &'a str)> {
    let mut values = units
        .iter()
        .map(|(factor, offset, of)| (factor * value + offset, *of));
    values.find(|(x, _)| (low..=high).contains(x))
}

fn within(value: f64, [low, high]: [f64; 2], unit: &str, mends: &[(f64, f64, &str)]) -> Result<f64, String> {
    if (low..=high).contains(&value) {
        return Ok(value);
    }
    let mend = meant(value, [low, high], mends)
        .map_or(String::new(), |(x, of)| format!("; in {of} it is {x:.1} {unit}"));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weather_in_other_units_is_told() {
        let known = BenchAir::of_weather(20.0, 1013.25).expect("a density");
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
