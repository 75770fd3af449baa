//! Header names taken apart: prefix, text, unit; what they measure and on which rotor.

use crate::bench::units::{self, Quantity};

/// A header name taken apart.
pub(super) struct Name {
    pub(super) raw: String,
    /// Text before " - ", normalised.
    prefix: Option<String>,
    /// The rest without its unit, normalised.
    pub(super) text: String,
    pub(super) unit: Option<String>,
}

/// Words that make a column something other than what its `thrust` or `torque` suggests.
const OTHERS: &str = "efficiency|power |speed|rpm|servo|centre|center|temp|vibration|offset|std";

/// Words that a force along the axis has beside it; one along another axis is no thrust.
const BESIDE_FORCE: &str = "axial total mean measured fz z motor upper lower top bottom left right a b";

fn of_any(words: &str, word: &str) -> bool {
    words.split(' ').any(|known| known == word)
}

/// Words that tell what a column measures, the first that is there.
const WORDS: [(Quantity, &str); 6] = [
    (Quantity::Throttle, "esc pwm throttle gas gaz acelerador"),
    (
        Quantity::Thrust,
        "thrust schub pouss\u{e9}e poussee empuje spinta",
    ),
    (Quantity::Torque, "torque drehmoment moment couple par coppia"),
    (Quantity::Voltage, "voltage spannung tension voltaje tensione"),
    (Quantity::Time, "time zeit temps tiempo tempo"),
    (Quantity::Current, "current strom courant corriente corrente"),
];

/// Words of the upper and of the lower rotor: those that say which is above; those of the first and of the
/// second in the air's way, on a stand that lies; those of a stand's own.
const ABOVE: [&str; 2] = [
    "upper top oben oberer obere haut sup\u{e9}rieur superieur arriba superior",
    "lower bottom unten unterer untere bas inf\u{e9}rieur inferieur abajo inferior",
];
const BEFORE: [&str; 2] = [
    "front fore vorn vorne vorderer avant delantero",
    "rear back aft hinten hinterer arri\u{e8}re arriere trasero",
];
const FIRST: [&str; 2] = ["left a", "right b"];

/// Which of the two a word is of.
fn side_of(words: [&str; 2], word: &str) -> Option<usize> {
    words.iter().position(|words| of_any(words, word))
}

impl Name {
    pub(super) fn new(raw: &str) -> Self {
        let raw = raw.trim().to_string();
        let spelled = units::normalised(&raw);
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

    /// What is measured beside thrust and torque: speed, electrical power.
    fn of_motor(&self) -> Option<Quantity> {
        const ELECTRICAL: &str = "electrical electric input supply total motor upper lower";
        let unit = self
            .unit
            .as_deref()
            .filter(|unit| units::scale(Quantity::Speed, unit).is_some());
        let mut words = self
            .words()
            .filter(|word| word.len() > 1 && !of_any(ELECTRICAL, word));
        match self.text.as_str() {
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
        if OTHERS.split('|').any(|other| padded.contains(other)) {
            return None;
        }
        if [ABOVE, BEFORE]
            .into_iter()
            .any(|words| side_of(words, &self.text).is_some())
        {
            return Some(Quantity::Throttle);
        }
        if self.is_force() {
            return Some(Quantity::Thrust);
        }
        let is_of = |words: &str| self.words().any(|own| of_any(words, own));
        WORDS
            .iter()
            .find(|(_, words)| is_of(words))
            .map(|(quantity, _)| *quantity)
    }

    /// Whether it is a thrust where no column is named so: a force or a load, along the axis.
    pub(super) fn is_force(&self) -> bool {
        let is_beside = |word: &&str| of_any(BESIDE_FORCE, word) || word.bytes().all(|b| b.is_ascii_digit());
        let mut words = self.words().filter(|word| !is_beside(word));
        let in_newtons = |unit: &String| units::scale(Quantity::Thrust, unit).is_some();
        matches!((words.next(), words.next()), (Some("force" | "load"), None))
            && self.unit.as_ref().is_none_or(in_newtons)
    }

    /// Words of the prefix and of the rest.
    fn all_words(&self) -> impl Iterator<Item = &str> {
        self.words().chain(self.prefix.iter().flat_map(|p| p.split(' ')))
    }

    pub(super) fn says_upper_or_lower(&self) -> bool {
        self.all_words().any(|word| side_of(ABOVE, word).is_some())
    }

    /// 0 or 1 for a column of one rotor, nothing for the whole.
    pub(super) fn side(&self, prefixes: &[&str]) -> Option<usize> {
        let named = [ABOVE, FIRST]
            .into_iter()
            .find_map(|words| self.all_words().find_map(|word| side_of(words, word)));
        // Prefixes are names of the stand's own, in their order: only a column's own words count.
        let named = named.or_else(|| self.words().find_map(|word| side_of(BEFORE, word)));
        let numbered = || {
            self.words()
                .find_map(|w| ["1", "2"].iter().position(|number| *number == w))
        };
        let prefixed = || match prefixes {
            [_] => None,
            _ => prefixes
                .iter()
                .position(|p| Some(*p) == self.prefix.as_deref())
                .map(|at| at.min(1)),
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
    // The last word, or two, as in `density_kg_m3`.
    for (at, _) in text.rmatch_indices([' ', '/']).take(2) {
        let (rest, last) = (text[..at].trim_end_matches([',', ':']), &text[at + 1..]);
        let named = Name {
            raw: String::new(),
            prefix: None,
            text: rest.to_owned(),
            unit: None,
        };
        use Quantity::{Power, Speed, Throttle, Thrust, Time, Torque, Voltage};
        let is_unit = match named.quantity() {
            Some(quantity) => units::scale(quantity, last).is_some(),
            // The A of amperes is also a side: it is a unit behind a current alone.
            None => [Speed, Power, Thrust, Torque, Voltage, Time, Throttle]
                .iter()
                .any(|&quantity| units::scale(quantity, last).is_some()),
        };
        let is_number = last.bytes().all(|byte| byte.is_ascii_digit());
        if is_unit && !is_number && last != "pwm" && rest.contains(char::is_alphabetic) {
            return (rest.to_owned(), Some(last.to_owned()));
        }
    }
    (text.to_owned(), None)
}
