//! Units as bench tools write them, and their factor to SI.
//!
//! The factors are exact by definition (standard gravity 9.80665 m/s2, pound 0.45359237 kg, inch
//! 25.4 mm).

/// Standard gravity, m/s2.
const G: f64 = 9.80665;
const POUND: f64 = 0.453_592_37 * G;
const OUNCE: f64 = POUND / 16.0;
const INCH: f64 = 0.0254;

/// What a column measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A rotor's command.
    Throttle,
    /// Thrust, to N.
    Thrust,
    /// Torque, to N m.
    Torque,
    /// Supply voltage, to V.
    Voltage,
    /// Supply current, to A.
    Current,
    /// Electrical power, to W.
    Power,
    /// Speed, to revolutions per minute.
    Speed,
    /// Time since the log's start, to s.
    Time,
    /// Temperature of the air, to K.
    Temperature,
    /// Pressure of the air, to Pa.
    Pressure,
    /// Density of the air, to kg/m3.
    Density,
}

/// How a column is to be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Multiply by this to reach the SI unit (or throttle in [0, 1]).
    Factor(f64),
    /// Multiply by the first and add the second.
    Affine(f64, f64),
    /// A pulse width; multiply to reach microseconds, then apply the PWM range.
    Pulse(f64),
    /// A speed that stands for a throttle; multiply.
    Speed(f64),
}

impl Scale {
    /// A value in SI units (or a throttle, but for pulse widths in microseconds).
    pub fn of(self, raw: f64) -> f64 {
        match self {
            Scale::Factor(factor) | Scale::Pulse(factor) | Scale::Speed(factor) => raw * factor,
            Scale::Affine(factor, offset) => raw * factor + offset,
        }
    }
}

/// Spells a name or a unit one way: micro and dot signs, blanks and case.
pub fn normalised(text: &str) -> String {
    let folded: String = text
        .chars()
        .map(|c| match c {
            '\u{b5}' | '\u{3bc}' => 'u',
            '\u{b7}' | '\u{22c5}' | '\u{2219}' | '\u{2022}' | '\u{fffd}' => '·',
            '\u{a0}' | '_' => ' ',
            c => c,
        })
        .collect();
    let words = folded.split_whitespace();
    itertools::join(words, " ").to_lowercase()
}

/// Units of each quantity, the first spelling for messages, and how to read them.
const UNITS: [(Quantity, &str, Scale); 40] = [
    (Quantity::Throttle, "us pwm", Scale::Pulse(1.0)),
    (Quantity::Throttle, "% percent", Scale::Factor(0.01)),
    (Quantity::Throttle, "ms", Scale::Pulse(1000.0)),
    (Quantity::Throttle, "1", Scale::Factor(1.0)),
    (Quantity::Thrust, "N newton newtons", Scale::Factor(1.0)),
    (Quantity::Thrust, "mN", Scale::Factor(1e-3)),
    (Quantity::Thrust, "kN", Scale::Factor(1e3)),
    (Quantity::Thrust, "gf g gram grams", Scale::Factor(1e-3 * G)),
    (Quantity::Thrust, "kgf kg kilogram kilograms", Scale::Factor(G)),
    (Quantity::Thrust, "lbf lb lbs pound pounds", Scale::Factor(POUND)),
    (Quantity::Thrust, "ozf oz ounce ounces", Scale::Factor(OUNCE)),
    (Quantity::Torque, "N·m", Scale::Factor(1.0)),
    (Quantity::Torque, "mN·m N·mm", Scale::Factor(1e-3)),
    (Quantity::Torque, "N·cm", Scale::Factor(1e-2)),
    (Quantity::Torque, "kgf·m kg·m", Scale::Factor(G)),
    (Quantity::Torque, "kgf·cm kg·cm", Scale::Factor(1e-2 * G)),
    (Quantity::Torque, "gf·cm g·cm", Scale::Factor(1e-5 * G)),
    (
        Quantity::Torque,
        "lbf·in in·lb in·lbf",
        Scale::Factor(POUND * INCH),
    ),
    (
        Quantity::Torque,
        "lbf·ft lb·ft ft·lb ft·lbf",
        Scale::Factor(POUND * 12.0 * INCH),
    ),
    (
        Quantity::Torque,
        "ozf·in oz·in in·oz in·ozf",
        Scale::Factor(OUNCE * INCH),
    ),
    (Quantity::Voltage, "V volt volts", Scale::Factor(1.0)),
    (Quantity::Voltage, "mV", Scale::Factor(1e-3)),
    (Quantity::Current, "A amp amps ampere", Scale::Factor(1.0)),
    (Quantity::Current, "mA", Scale::Factor(1e-3)),
    (Quantity::Power, "W watt watts", Scale::Factor(1.0)),
    (Quantity::Power, "kW", Scale::Factor(1e3)),
    (
        Quantity::Speed,
        "rpm r/min u/min 1/min min1 min^1",
        Scale::Factor(1.0),
    ),
    (Quantity::Speed, "krpm", Scale::Factor(1e3)),
    (Quantity::Time, "s sec", Scale::Factor(1.0)),
    (Quantity::Time, "ms", Scale::Factor(1e-3)),
    (
        Quantity::Temperature,
        "C degC celsius",
        Scale::Affine(1.0, 273.15),
    ),
    (Quantity::Temperature, "K kelvin", Scale::Factor(1.0)),
    (
        Quantity::Temperature,
        "F degF fahrenheit",
        Scale::Affine(5.0 / 9.0, 459.67 * 5.0 / 9.0),
    ),
    (Quantity::Pressure, "hPa mbar mb", Scale::Factor(100.0)),
    (Quantity::Pressure, "Pa", Scale::Factor(1.0)),
    (Quantity::Pressure, "kPa", Scale::Factor(1000.0)),
    (Quantity::Pressure, "bar", Scale::Factor(1e5)),
    (Quantity::Pressure, "mmHg", Scale::Factor(133.322_4)),
    (Quantity::Pressure, "inHg", Scale::Factor(3_386.388_6)),
    (
        Quantity::Density,
        "kg/m3 kgm3 kg/m^3 kg/m³ kgm^3",
        Scale::Factor(1.0),
    ),
];

/// The scale of `unit` for this quantity, or nothing if the unit does not measure it.
pub fn scale(quantity: Quantity, unit: &str) -> Option<Scale> {
    let bare = |unit: &str| -> String {
        let is_mark = |c: &char| matches!(c, '·' | '*' | '-' | '.' | ' ' | '°' | 'º');
        normalised(unit).chars().filter(|c| !is_mark(c)).collect()
    };
    let unit = bare(unit);
    let mut units = UNITS.iter().filter(|(of, ..)| *of == quantity);
    let found = units.find(|(_, names, _)| names.split(' ').any(|name| bare(name) == unit))?;
    Some(found.2)
}

/// The units that `scale` knows, for messages.
pub fn known(quantity: Quantity) -> String {
    let units = UNITS.iter().filter(|(of, ..)| *of == quantity);
    let names = units.filter_map(|(_, names, _)| names.split(' ').next());
    itertools::join(names, ", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(quantity: Quantity, unit: &str) -> f64 {
        match scale(quantity, unit) {
            Some(Scale::Factor(f)) => f,
            other => panic!("{unit}: {other:?}"),
        }
    }

    #[test]
    fn spellings_of_the_newton_metre_agree() {
        for unit in ["N·m", "N⋅m", "N-m", "Nm", "N*m", "n m", "N.m"] {
            assert_eq!(factor(Quantity::Torque, unit), 1.0, "{unit}");
        }
    }

    #[test]
    fn factors_against_published_conversions() {
        assert!((factor(Quantity::Thrust, "lbf") - 4.448_221_615_260_5).abs() < 1e-12);
        assert!((factor(Quantity::Thrust, "ozf") - 0.278_013_850_953_781).abs() < 1e-12);
        assert!((factor(Quantity::Torque, "lbf·in") - 0.112_984_829_027_616_7).abs() < 1e-12);
        assert!((factor(Quantity::Torque, "ozf·in") - 0.007_061_551_814_226).abs() < 1e-12);
        assert!((factor(Quantity::Thrust, "gf") - 0.009_806_65).abs() < 1e-15);
    }

    #[test]
    fn pulse_widths_and_strangers() {
        for unit in ["us", "µs", "μs"] {
            assert_eq!(scale(Quantity::Throttle, unit), Some(Scale::Pulse(1.0)));
        }
        assert_eq!(scale(Quantity::Thrust, "gf/W"), None);
        assert_eq!(scale(Quantity::Torque, "N"), None);
    }
}
