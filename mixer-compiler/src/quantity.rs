//! What values a quantity has, wherever one is given: a key of the airframe file, an option, a column, a
//! field of the page.

/// A measured quantity.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Its name, as messages have it.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Least and greatest value, in that unit.
    pub range: [f64; 2],
    /// Other units in which a value may be: factor and offset from them, and their names.
    others: &'static [(f64, f64, &'static str)],
}

impl Quantity {
    /// The value, in the unit.
    ///
    /// # Errors
    /// One out of the range, with the unit in which it would lie within.
    pub fn check(&self, value: f64) -> Result<f64, String> {
        let [low, high] = self.range;
        if (low..=high).contains(&value) {
            return Ok(value);
        }
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", self.unit)
        };
        let mut values = self
            .others
            .iter()
            .map(|(factor, offset, of)| (factor * value + offset, of));
        let meant = values.find(|(x, _)| (low..=high).contains(x));
        let meant = meant.map_or(String::new(), |(x, of)| {
            format!("; in {of} it is {}{unit}", (1e3 * x).round() / 1e3)
        });
        Err(format!("{value} is not within {low} to {high}{unit}{meant}"))
    }
}

const LENGTHS: &[(f64, f64, &str)] = &[(0.0254, 0.0, "inches"), (0.001, 0.0, "mm"), (0.01, 0.0, "cm")];

macro_rules! quantities {
    ($($(#[$doc:meta])* $constant:ident $name:literal $unit:literal $range:expr, $others:expr;)*) => {
        $($(#[$doc])* pub const $constant: Quantity =
            Quantity { name: $name, unit: $unit, range: $range, others: $others };)*
    };
}

quantities! {
    /// Of the air.
    TEMPERATURE "temperature" "degrees Celsius" [-40.0, 55.0],
        &[(1.0, -273.15, "kelvin"), (5.0 / 9.0, -160.0 / 9.0, "degrees Fahrenheit")];
    /// Of the air.
    PRESSURE "pressure" "hPa" [450.0, 1090.0],
        &[
            (0.01, 0.0, "Pa"), (10.0, 0.0, "kPa"), (1000.0, 0.0, "bar"),
            (33.863_886, 0.0, "inches of mercury"), (1.333_224, 0.0, "mm of mercury"),
        ];
    /// Of the air, from 12,000 m to a cold winter's day at the coast.
    DENSITY "density" "kg/m3" [0.3, 1.65], &[(1e3, 0.0, "g/cm3"), (1e-3, 0.0, "g/m3")];
    /// Of a pack or a supply.
    VOLTAGE "voltage" "V" [1.0, 1000.0], &[(0.001, 0.0, "mV")];
    /// Of a propeller.
    DIAMETER "diameter" "m" [0.03, 3.0], LENGTHS;
    /// Between the two propellers of a pair.
    SPACING "spacing" "m" [0.005, 2.0], LENGTHS;
    /// Between the two propellers of a pair.
    SPACING_RATIO "spacing over diameter" "" [0.02, 3.0], &[(0.01, 0.0, "per cent")];
    /// Of a rotor.
    TORQUE_PER_THRUST "torque per thrust" "m" [0.0005, 0.2], LENGTHS;
    /// Of a rotor.
    SPEED "speed" "rpm" [100.0, 200_000.0], &[(60.0, 0.0, "revolutions per second"), (1000.0, 0.0, "krpm")];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_in_other_units_are_told() {
        for (quantity, value, wanted) in [
            (TEMPERATURE, 293.15, "in kelvin it is 20 degrees Celsius"),
            (
                TEMPERATURE,
                68.0,
                "in degrees Fahrenheit it is 20 degrees Celsius",
            ),
            (PRESSURE, 101_325.0, "in Pa it is 1013.25 hPa"),
            (PRESSURE, 101.3, "in kPa it is 1013 hPa"),
            (PRESSURE, 29.92, "in inches of mercury it is 1013.207 hPa"),
            (PRESSURE, -3.0, "-3 is not within 450 to 1090 hPa"),
            (DENSITY, 1204.0, "in g/m3 it is 1.204 kg/m3"),
            (VOLTAGE, 22_200.0, "in mV it is 22.2 V"),
            (
                SPACING_RATIO,
                25.0,
                "25 is not within 0.02 to 3; in per cent it is 0.25",
            ),
        ] {
            let told = quantity.check(value).expect_err("another unit");
            assert!(told.contains(wanted), "{told}");
        }
        assert_eq!(DIAMETER.check(0.28), Ok(0.28));
        assert!(VOLTAGE.check(f64::NAN).is_err());
    }
}
