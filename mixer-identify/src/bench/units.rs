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
    /// Thrust over rho n^2 D^4, n in revolutions per second.
    ThrustCoefficient,
    /// Shaft power over rho n^3 D^5.
    PowerCoefficient,
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
    /// Multiply by this and by the square of the row's speed, revolutions per minute.
    OfSpeed(f64),
}

/// Spells a name or a unit one way: micro and dot signs, blanks and case.
pub fn spelled(text: &str) -> String {
    let folded: String = text
        .chars()
        .map(|c| match c {
            '\u{b5}' | '\u{3bc}' => 'u',
            '\u{b7}' | '\u{22c5}' | '\u{2219}' | '\u{2022}' | '\u{fffd}' => '·',
            '\u{a0}' | '_' => ' ',
            c => c,
        })
        .collect();
    let words: Vec<&str> = folded.split_whitespace().collect();
    words.join(" ").to_lowercase()
}

/// What a unit of a quantity is in SI units, the names of units as [`scale`] strips them.
const FACTORS: [(Quantity, &str, f64); 36] = [
    (Quantity::Throttle, "% percent", 0.01),
    (Quantity::Throttle, "1", 1.0),
    (Quantity::Thrust, "n newton newtons", 1.0),
    (Quantity::Thrust, "mn", 1e-3),
    (Quantity::Thrust, "kn", 1e3),
    (Quantity::Thrust, "g gf gram grams", 1e-3 * G),
    (Quantity::Thrust, "kg kgf kilogram kilograms", G),
    (Quantity::Thrust, "lb lbf lbs pound pounds", POUND),
    (Quantity::Thrust, "oz ozf ounce ounces", OUNCE),
    (Quantity::Torque, "nm", 1.0),
    (Quantity::Torque, "mnm nmm", 1e-3),
    (Quantity::Torque, "ncm", 1e-2),
    (Quantity::Torque, "kgfm kgm", G),
    (Quantity::Torque, "kgfcm kgcm", 1e-2 * G),
    (Quantity::Torque, "gfcm gcm", 1e-5 * G),
    (Quantity::Torque, "lbfin lbin inlb inlbf", POUND * INCH),
    (Quantity::Torque, "lbfft lbft ftlb ftlbf", POUND * 12.0 * INCH),
    (Quantity::Torque, "ozfin ozin inoz inozf", OUNCE * INCH),
    (Quantity::Voltage, "v volt volts", 1.0),
    (Quantity::Voltage, "mv", 1e-3),
    (Quantity::Current, "a amp amps ampere", 1.0),
    (Quantity::Current, "ma", 1e-3),
    (Quantity::Power, "w watt watts", 1.0),
    (Quantity::Power, "kw", 1e3),
    (Quantity::Speed, "rpm r/min u/min 1/min min1 min^1", 1.0),
    (Quantity::Speed, "krpm", 1e3),
    (Quantity::Time, "s sec", 1.0),
    (Quantity::Time, "ms", 1e-3),
    (Quantity::Temperature, "k kelvin", 1.0),
    (Quantity::Pressure, "pa", 1.0),
    (Quantity::Pressure, "hpa mbar mb", 100.0),
    (Quantity::Pressure, "kpa", 1000.0),
    (Quantity::Pressure, "bar", 1e5),
    (Quantity::Pressure, "mmhg", 133.322_4),
    (Quantity::Pressure, "inhg", 3_386.388_6),
    (Quantity::Density, "kg/m3 kgm3 kg/m^3 kg/m³ kgm^3", 1.0),
];

/// The scale of `unit` for this quantity, or nothing if the unit does not measure it.
pub fn scale(quantity: Quantity, unit: &str) -> Option<Scale> {
    let is_mark = |c: &char| matches!(c, '·' | '*' | '-' | '.' | ' ' | '°' | 'º');
    let unit: String = spelled(unit).chars().filter(|c| !is_mark(c)).collect();
    match (quantity, unit.as_str()) {
        (Quantity::Throttle, "us" | "pwm") => Some(Scale::Pulse(1.0)),
        (Quantity::Throttle, "ms") => Some(Scale::Pulse(1000.0)),
        (Quantity::Throttle, "") => Some(Scale::Factor(1.0)),
        (Quantity::Temperature, "c" | "degc" | "celsius") => Some(Scale::Affine(1.0, 273.15)),
        (Quantity::Temperature, "f" | "degf" | "fahrenheit") => {
            Some(Scale::Affine(5.0 / 9.0, 459.67 * 5.0 / 9.0))
        }
        (_, unit) => {
            let is = |names: &str| names.split(' ').any(|name| name == unit);
            let mut factors = FACTORS.iter();
            let found = factors.find(|(of, names, _)| *of == quantity && is(names))?;
            Some(Scale::Factor(found.2))
        }
    }
}

/// The units that `scale` knows, for messages.
pub fn known(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Throttle => "us, %, or none for a throttle in [0, 1]",
        Quantity::Thrust => "N, mN, gf, kgf, lbf, ozf",
        Quantity::Torque => "N·m, mN·m, N·cm, N·mm, kgf·m, kgf·cm, gf·cm, lbf·in, lbf·ft, ozf·in",
        Quantity::Voltage => "V, mV",
        Quantity::Current => "A, mA",
        Quantity::Power => "W, kW",
        Quantity::Speed => "rpm, krpm",
        Quantity::ThrustCoefficient | Quantity::PowerCoefficient => "none",
        Quantity::Time => "s, ms",
        Quantity::Temperature => "C, K, F",
        Quantity::Pressure => "hPa, mbar, Pa, kPa, bar, mmHg, inHg",
        Quantity::Density => "kg/m3",
    }
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
