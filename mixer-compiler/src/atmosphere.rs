//! The U.S. Standard Atmosphere of 1976 below 11 km (NOAA-S/T 76-1562, eqs. (23), (33a), (42)).
//!
//! The temperature falls by L per metre. With the ideal gas, rho = p / (R T), hydrostatic balance
//! dp = -rho g dh then gives
//!
//! ```text
//! T = T0 - L h,   p = p0 (T / T0)^n,   rho = rho0 (T / T0)^(n - 1),   n = g / (R L) = 5.2559
//! ```

use crate::airframe::GRAVITY;

/// Gas constant R of dry air, J/(kg K).
pub const GAS_CONSTANT: f64 = 287.052_87;

/// Where the temperature stops falling, m.
pub const TOP_M: f64 = 11_000.0;

/// rho0, kg/m^3.
pub const SEA_LEVEL_KG_M3: f64 = 1.225;

/// L, K/m.
pub const LAPSE: f64 = 0.0065;

/// T0, K; p0, Pa.
const SEA_LEVEL_K: f64 = 288.15;
const SEA_LEVEL_PA: f64 = 101_325.0;

/// n.
const EXPONENT: f64 = GRAVITY / (GAS_CONSTANT * LAPSE);

/// Density of dry air, kg/m^3, at a pressure, Pa, and a temperature, K.
pub fn density(pressure_pa: f64, temperature_k: f64) -> f64 {
    pressure_pa / (GAS_CONSTANT * temperature_k)
}

/// Temperature, K, at an altitude above the sea, m.
pub fn temperature_at(altitude_m: f64) -> f64 {
    SEA_LEVEL_K - LAPSE * altitude_m
}

/// Pressure, Pa, at an altitude above the sea, m.
pub fn pressure_at(altitude_m: f64) -> f64 {
    SEA_LEVEL_PA * libm::pow(temperature_at(altitude_m) / SEA_LEVEL_K, EXPONENT)
}

/// Density, kg/m^3, at an altitude above the sea, m.
pub fn density_at(altitude_m: f64) -> f64 {
    density(pressure_at(altitude_m), temperature_at(altitude_m))
}

/// Altitude above the sea, m, at which the atmosphere has a density, kg/m^3; negative above 1.225.
pub fn altitude_of(density_kg_m3: f64) -> f64 {
    let share = libm::pow(density_kg_m3 / density_at(0.0), 1.0 / (EXPONENT - 1.0));
    SEA_LEVEL_K * (1.0 - share) / LAPSE
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Table I of the standard, by geopotential altitude: K, Pa, kg/m^3.
    #[test]
    fn the_atmosphere_is_the_standard() {
        for (altitude, temperature, pressure, density) in [
            (-1000.0, 294.65, 113_929.0, 1.3470),
            (0.0, 288.15, 101_325.0, 1.22500),
            (1500.0, 278.40, 84_556.0, 1.05807),
            (3000.0, 268.65, 70_108.5, 0.909122),
            (11_000.0, 216.65, 22_632.1, 0.363918),
        ] {
            assert!((temperature_at(altitude) - temperature).abs() < 1e-9);
            assert!(
                (pressure_at(altitude) / pressure - 1.0).abs() < 1e-5,
                "{altitude}"
            );
            assert!((density_at(altitude) / density - 1.0).abs() < 1e-5, "{altitude}");
            assert!((altitude_of(density_at(altitude)) - altitude).abs() < 1e-6);
        }
    }
}
