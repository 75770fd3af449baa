//! What is known of the air at a bench: a density, from a temperature and a pressure that benches
//! have.

use mixer_compiler::atmosphere::density;
use mixer_compiler::quantity::{PRESSURE, TEMPERATURE};
use serde::Serialize;

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
                100.0 * PRESSURE.check(pressure_hpa)?,
                TEMPERATURE.check(temperature_c)? + 273.15,
            ),
            from: format!("{temperature_c} C and {pressure_hpa} hPa"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weather_in_other_units_is_told() {
        let known = BenchAir::of_weather(20.0, 1013.25).expect("a density");
        assert!((known.density_kg_m3 - 1.2041).abs() < 1e-4, "{known:?}");
        assert_eq!(known.from, "20 C and 1013.25 hPa");
    }
}
