//! What values a quantity has, wherever one is given: an option, a column, a field of the page.

/// Another unit: factor and offset from it, and its name.
type Unit = (f64, f64, &'static str);

/// Units in which lengths are given by mistake.
const LENGTHS: &[Unit] = &[(0.0254, 0.0, "inches"), (0.001, 0.0, "mm"), (0.01, 0.0, "cm")];

/// Quantities with their unit, what benches have of it, and in which other unit a value may be.
const QUANTITIES: [(&str, &str, [f64; 2], &[Unit]); 9] = [
    (
        "temperature",
        " degrees Celsius",
        [-40.0, 55.0],
        &[
            (1.0, -273.15, "kelvin"),
            (5.0 / 9.0, -160.0 / 9.0, "degrees Fahrenheit"),
        ],
    ),
    (
        "pressure",
        " hPa",
        [450.0, 1090.0],
        &[
            (0.01, 0.0, "Pa"),
            (10.0, 0.0, "kPa"),
            (1000.0, 0.0, "bar"),
            (33.863_886, 0.0, "inches of mercury"),
            (1.333_224, 0.0, "mm of mercury"),
        ],
    ),
    (
        "density",
        " kg/m3",
        [0.5, 1.65],
        &[(1e3, 0.0, "g/cm3"), (1e-3, 0.0, "g/m3")],
    ),
    ("voltage", " V", [1.0, 1000.0], &[(0.001, 0.0, "mV")]),
    ("diameter", " m", [0.03, 3.0], LENGTHS),
    ("spacing", " m", [0.005, 2.0], LENGTHS),
    (
        "spacing over diameter",
        "",
        [0.02, 3.0],
        &[(0.01, 0.0, "per cent")],
    ),
    ("torque per thrust", " m", [0.0005, 0.2], LENGTHS),
    (
        "speed",
        " rpm",
        [100.0, 200_000.0],
        &[(60.0, 0.0, "revolutions per second"), (1000.0, 0.0, "krpm")],
    ),
];

/// A value of the quantity of this name.
///
/// # Errors
/// One that no bench has, with the unit in which it would be one.
pub fn quantity(name: &str, value: f64) -> Result<f64, String> {
    let known = QUANTITIES.iter().find(|(known, ..)| *known == name);
    let Some((_, unit, range, others)) =
        known.filter(|(_, _, [low, high], _)| !(*low..=*high).contains(&value))
    else {
        return Ok(value);
    };
    let [low, high] = range;
    let mut values = others
        .iter()
        .map(|(factor, offset, of)| (factor * value + offset, of));
    let meant = values.find(|(x, _)| (*low..=*high).contains(x));
    let meant = meant.map_or(String::new(), |(x, of)| {
        format!("; in {of} it is {}{unit}", (1e3 * x).round() / 1e3)
    });
    Err(format!("{value} is not within {low} to {high}{unit}{meant}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_in_other_units_are_told() {
        for (name, value, wanted) in [
            ("temperature", 293.15, "in kelvin it is 20 degrees Celsius"),
            (
                "temperature",
                68.0,
                "in degrees Fahrenheit it is 20 degrees Celsius",
            ),
            ("pressure", 101_325.0, "in Pa it is 1013.25 hPa"),
            ("pressure", 101.3, "in kPa it is 1013 hPa"),
            ("pressure", 29.92, "in inches of mercury it is 1013.207 hPa"),
            ("pressure", -3.0, "-3 is not within 450 to 1090 hPa"),
            ("density", 1204.0, "in g/m3 it is 1.204 kg/m3"),
            ("voltage", 22_200.0, "in mV it is 22.2 V"),
        ] {
            let told = quantity(name, value).expect_err("another unit");
            assert!(told.contains(wanted), "{told}");
        }
        assert_eq!(quantity("diameter", 0.28), Ok(0.28));
    }
}
