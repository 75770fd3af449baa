//! The standard atmosphere below 11 km.

/// Temperature at sea level, degrees Celsius, and its fall per metre.
const SEA_LEVEL_C: f64 = 15.0;
const FALL_C_PER_M: f64 = 0.0065;

/// Pressure at sea level, hPa.
const SEA_LEVEL_HPA: f64 = 1013.25;

/// Density at sea level, kg/m3.
pub const SEA_LEVEL_KG_M3: f64 = 1.225;

/// Fall of the temperature per metre over the absolute one at sea level, and the exponent of the
/// pressure; that of the density is less by 1.
const FALL_PER_M: f64 = 2.255_77e-5;
const EXPONENT: f64 = 5.255_88;

/// Where it holds, m.
pub const ALTITUDES_M: [f64; 2] = [-1000.0, 11_000.0];

/// Temperature at an altitude (m), degrees Celsius.
pub fn temperature_c(altitude_m: f64) -> f64 {
    SEA_LEVEL_C - FALL_C_PER_M * altitude_m
}

/// Pressure at an altitude (m), hPa.
pub fn pressure_hpa(altitude_m: f64) -> f64 {
    SEA_LEVEL_HPA * libm::pow(1.0 - FALL_PER_M * altitude_m, EXPONENT)
}

/// Altitude of a pressure (hPa), m.
pub fn altitude_of_pressure_m(hpa: f64) -> f64 {
    (1.0 - libm::pow(hpa / SEA_LEVEL_HPA, 1.0 / EXPONENT)) / FALL_PER_M
}

/// Density at an altitude (m), kg/m3.
pub fn density_kg_m3(altitude_m: f64) -> f64 {
    SEA_LEVEL_KG_M3 * libm::pow(1.0 - FALL_PER_M * altitude_m, EXPONENT - 1.0)
}

/// Altitude of a density (kg/m3), m.
pub fn altitude_of_density_m(kg_m3: f64) -> f64 {
    (1.0 - libm::pow(kg_m3 / SEA_LEVEL_KG_M3, 1.0 / (EXPONENT - 1.0))) / FALL_PER_M
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_that_of_the_tables() {
        // ISO 2533: altitude, temperature, pressure, density.
        for (altitude, celsius, hpa, kg_m3) in [
            (0.0, 15.0, 1013.25, 1.225),
            (1500.0, 5.25, 845.56, 1.0581),
            (3000.0, -4.5, 701.09, 0.9091),
        ] {
            assert_eq!(temperature_c(altitude), celsius);
            assert!((pressure_hpa(altitude) - hpa).abs() < 0.1);
            assert!((density_kg_m3(altitude) - kg_m3).abs() < 1.5e-4);
            // A gas: p = rho R T.
            let gas = 0.01 * density_kg_m3(altitude) * 287.053 * (celsius + 273.15);
            assert!((pressure_hpa(altitude) / gas - 1.0).abs() < 1e-4, "{gas}");
            assert!((altitude_of_pressure_m(pressure_hpa(altitude)) - altitude).abs() < 1e-6);
            assert!((altitude_of_density_m(density_kg_m3(altitude)) - altitude).abs() < 1e-6);
        }
    }
}
