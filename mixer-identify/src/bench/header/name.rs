//! Header names taken apart: prefix, text, unit; what they measure and on which rotor.

use crate::bench::units::{self, Quantity};

/// A header name taken apart.
pub(super) struct Name {
    pub(super) raw: String,
    /// Text before " - ", spelled.
    prefix: Option<String>,
    /// The rest without its unit, spelled.
    pub(super) text: String,
    pub(super) unit: Option<String>,
}

/// Words that make a column something other than what its `thrust` or `torque` suggests.
const OTHERS: [&str; 11] = [
    "efficiency",
    "power ",
    "speed",
    "rpm",
    "servo",
    "centre",
    "center",
    "temp",
    "vibration",
    "offset",
    "std",
];

/// Words that tell what a column measures, the first that is there.
const WORDS: [(&str, Quantity); 8] = [
    ("esc", Quantity::Throttle),
    ("pwm", Quantity::Throttle),
    ("throttle", Quantity::Throttle),
    ("thrust", Quantity::Thrust),
    ("torque", Quantity::Torque),
    ("voltage", Quantity::Voltage),
    ("time", Quantity::Time),
    ("current", Quantity::Current),
];

impl Name {
    pub(super) fn new(raw: &str) -> Self {
        let raw = raw.trim().to_string();
        let spelled = units::spelled(&raw);
        let (prefix, rest) = match spelled.rsplit_once(" - ") {
            Some((prefix, rest)) => (Some(prefix.to_string()), rest.to_string()),
            None => (None, spelled),
        };
        let (text, unit) = split_unit(&rest);
        Self {
            raw,
            prefix,
            text,
            unit,
        }
    }

    /// Words, a number at the end of one by itself: `esc1` is `esc` and `1`.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        let halves = |word: &'_ str| word.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let words = self.text.split([' ', '(', ')']);
        let words = words.flat_map(move |word| <[&str; 2]>::from(word.split_at(halves(word))));
        words.filter(|w| !w.is_empty())
    }

    /// What is measured of the air around the bench. Sensors in motors, controllers and of airspeed
    /// have other words in their names.
    fn of_air(&self) -> Option<Quantity> {
        const AIR: [&str; 6] = ["ambient", "air", "room", "barometric", "atmospheric", "station"];
        let words: Vec<&str> = self.words().filter(|w| !AIR.contains(w)).collect();
        match words[..] {
            ["temperature" | "temp"] => Some(Quantity::Temperature),
            ["pressure"] => Some(Quantity::Pressure),
            ["density"] => Some(Quantity::Density),
            _ => None,
        }
    }

    /// What is measured beside thrust and torque: speed, electrical power, coefficients.
    fn of_motor(&self) -> Option<Quantity> {
        const ELECTRICAL: [&str; 8] = [
            "electrical",
            "electric",
            "input",
            "supply",
            "total",
            "motor",
            "upper",
            "lower",
        ];
        let unit = self
            .unit
            .as_deref()
            .filter(|unit| units::scale(Quantity::Speed, unit).is_some());
        let mut words = self
            .words()
            .filter(|word| word.len() > 1 && !ELECTRICAL.contains(word));
        match self.text.as_str() {
            "ct" => Some(Quantity::ThrustCoefficient),
            "cp" => Some(Quantity::PowerCoefficient),
            text if text.contains("servo") => None,
            _ if unit.is_some() || self.words().any(|word| word == "rpm") => Some(Quantity::Speed),
            _ => (words.next() == Some("power") && words.next().is_none()).then_some(Quantity::Power),
        }
    }

    /// Whether the name is that of a command.
    pub(super) fn is_throttle(&self) -> bool {
        self.quantity() == Some(Quantity::Throttle)
    }

    pub(super) fn quantity(&self) -> Option<Quantity> {
        if let Some(quantity) = self.of_air().or_else(|| self.of_motor()) {
            return Some(quantity);
        }
        let padded = format!("{} ", self.text);
        if OTHERS.iter().any(|other| padded.contains(other)) {
            return None;
        }
        if matches!(self.text.as_str(), "upper" | "lower") {
            return Some(Quantity::Throttle);
        }
        let mut quantities = WORDS.iter();
        let found = quantities.find(|(word, _)| self.words().any(|own| own == *word));
        found.map(|(_, quantity)| *quantity)
    }

    /// Words of the prefix and of the rest.
    fn all_words(&self) -> impl Iterator<Item = &str> {
        self.words().chain(self.prefix.iter().flat_map(|p| p.split(' ')))
    }

    pub(super) fn says_upper_or_lower(&self) -> bool {
        self.all_words()
            .any(|w| matches!(w, "upper" | "lower" | "top" | "bottom"))
    }

    /// 0 or 1 for a column of one rotor, nothing for the whole.
    pub(super) fn side(&self, prefixes: &[&str]) -> Option<usize> {
        let named = self.all_words().find_map(|w| match w {
            "upper" | "top" | "left" | "a" => Some(0),
            "lower" | "bottom" | "right" | "b" => Some(1),
            _ => None,
        });
        let numbered = || {
            self.words()
                .find_map(|w| ["1", "2"].iter().position(|number| *number == w))
        };
        let prefixed = || match prefixes {
            [_] => None,
            _ => prefixes.iter().position(|p| Some(*p) == self.prefix.as_deref()),
        };
        named.or_else(numbered).or_else(prefixed)
    }
}

/// Prefixes of the columns that matter, in order of appearance.
pub(super) fn distinct_prefixes(names: &[Name]) -> Vec<&str> {
    use Quantity::{Throttle, Thrust, Torque, Voltage};
    let mut prefixes: Vec<&str> = Vec::new();
    let counts = |n: &&Name| {
        n.quantity()
            .is_some_and(|q| matches!(q, Throttle | Thrust | Torque | Voltage))
    };
    for prefix in names.iter().filter(counts).filter_map(|n| n.prefix.as_deref()) {
        if !prefixes.contains(&prefix) {
            prefixes.push(prefix);
        }
    }
    prefixes
}

/// Splits `force fz (thrust) (n)` into its text and the unit in its last brackets, `thrust n` (from
/// `thrust_n`) into text and suffix.
fn split_unit(text: &str) -> (String, Option<String>) {
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let (Some(inner), Some(start)) = (text.strip_suffix(close), text.rfind(open)) {
            return (
                text[..start].trim().to_string(),
                Some(inner[start + 1..].trim().to_string()),
            );
        }
    }
    let of_air = [
        ("density", Quantity::Density),
        ("temperature", Quantity::Temperature),
        ("pressure", Quantity::Pressure),
    ];
    for (word, quantity) in of_air {
        let unit = text.rsplit_once(word).map(|(_, unit)| unit.trim());
        if let Some(unit) = unit.filter(|unit| units::scale(quantity, unit).is_some()) {
            return (
                text[..text.len() - unit.len()].trim().to_string(),
                Some(unit.to_string()),
            );
        }
    }
    // `thrust/n`
    if let Some((rest, last)) = text.rsplit_once('/')
        && WORDS
            .iter()
            .any(|(word, of)| rest.split(' ').any(|own| own == *word) && suffix_of(*of, last))
    {
        return (rest.to_string(), Some(last.to_string()));
    }
    if let Some((rest, last)) = text.rsplit_once(' ') {
        let rest = rest.trim_end_matches([',', ':']);
        let known = [
            Quantity::Speed,
            Quantity::Power,
            Quantity::Thrust,
            Quantity::Torque,
            Quantity::Voltage,
            Quantity::Time,
            Quantity::Throttle,
        ];
        // The A of amperes is also a side: it is a unit behind a current alone.
        if rest.contains("current") && suffix_of(Quantity::Current, last) {
            return (rest.to_string(), Some(last.to_string()));
        }
        if rest.contains(|c: char| c.is_alphabetic()) && known.iter().any(|&q| suffix_of(q, last)) {
            return (rest.to_string(), Some(last.to_string()));
        }
    }
    (text.to_string(), None)
}

fn suffix_of(quantity: Quantity, suffix: &str) -> bool {
    !suffix.chars().any(|c| c.is_ascii_digit()) && suffix != "pwm" && units::scale(quantity, suffix).is_some()
}
