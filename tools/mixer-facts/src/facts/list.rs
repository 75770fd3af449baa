//! Facts, and how they are said.

use std::fmt;

use mixer_compiler::airframe::Kind;
use serde::Serialize;
use serde_json::Value;

/// What costs are counted in.
pub(super) const INSTRUCTIONS: &str = "instructions";

/// Something to say of a compiled airframe: a number with its unit and the words to it.
#[derive(Clone, Debug)]
pub struct Fact {
    /// What it is of. No other fact of the airframe has this name.
    pub name: &'static str,
    /// The number or the word, short enough to stand beside those of other airframes; empty where
    /// there is none.
    pub value: String,
    /// The value's unit; empty where it has none.
    pub unit: &'static str,
    /// What else there is to say, to be read on after the unit.
    pub words: String,
    /// Keys and values of `cargo mixer check --json`.
    pub json: Vec<(&'static str, Value)>,
    /// Whether it is part of the verdict: what an engineer asks first.
    pub in_verdict: bool,
}

/// Facts in the order in which they are said.
pub(super) struct List(pub(super) Vec<Fact>);

impl List {
    pub(super) fn say(
        &mut self,
        name: &'static str,
        value: impl ToString,
        unit: &'static str,
        words: impl Into<String>,
    ) -> &mut Fact {
        let at = self.0.len();
        let (value, words) = (value.to_string(), words.into());
        let (json, in_verdict) = (Vec::new(), false);
        self.0.push(Fact {
            name,
            value,
            unit,
            words,
            json,
            in_verdict,
        });
        &mut self.0[at]
    }

    pub(super) fn count(&mut self, name: &'static str, count: Option<u32>, words: String) -> &mut Fact {
        match count {
            Some(count) => self.say(name, count, INSTRUCTIONS, words),
            None => self.say(name, "", INSTRUCTIONS, "not counted"),
        }
    }

    /// Says value and words of each kind of the `kinds` that there are.
    pub(super) fn say_of_each<'a>(
        &mut self,
        name: &'static str,
        unit: &'static str,
        kinds: usize,
        each: impl IntoIterator<Item = (Kind<'a>, String, String)>,
    ) -> &mut Fact {
        let each: Vec<_> = each.into_iter().collect();
        if let (1, [(_, value, words)]) = (kinds, each.as_slice()) {
            return self.say(name, value, unit, words.as_str());
        }
        let space = if unit.is_empty() { "" } else { " " };
        let told = each
            .iter()
            .map(|(of, value, words)| format!("{}{value}{space}{unit}{words}", whose(*of, kinds)));
        self.say(name, "", "", itertools::join(told, "; "))
    }
}

impl Fact {
    /// For the verdict, if `so`.
    pub(super) fn in_verdict_if(&mut self, so: bool) -> &mut Self {
        self.in_verdict = so;
        self
    }

    /// For the verdict.
    pub(super) fn in_verdict(&mut self) -> &mut Self {
        self.in_verdict_if(true)
    }

    pub(super) fn json(&mut self, key: &'static str, value: impl Serialize) -> &mut Self {
        // Numbers, words and lists have a value.
        self.json
            .push((key, serde_json::to_value(value).unwrap_or_default()));
        self
    }

    /// Whether it is a count of what the target executes.
    pub fn is_cost(&self) -> bool {
        self.unit == INSTRUCTIONS
    }

    /// All but the name.
    pub fn text(&self) -> String {
        match (self.value.as_str(), self.unit) {
            ("", _) | (_, "") => format!("{}{}", self.value, self.words),
            (value, unit) => format!("{value} {unit}{}", self.words),
        }
    }
}

/// A line of `check`.
impl fmt::Display for Fact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.text() {
            // Its keys of JSON hold without a pair, too.
            text if text.is_empty() => Ok(()),
            text => writeln!(f, "{:<18}  {}", self.name, text.trim_start()),
        }
    }
}

/// `text`, where there is a value to say it of.
pub(super) fn or_nothing<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or_else(String::new, text)
}

/// Whose it is what is said of a kind, where there are several.
pub(super) fn whose(kind: Kind<'_>, kinds: usize) -> String {
    match kinds {
        1 => String::new(),
        _ => format!("\"{}\" ", kind.name().1),
    }
}

/// The value of the pair; a list where units differ.
pub(super) fn one_or_list<T: Serialize>(values: &[T]) -> Value {
    let json = |value: &T| serde_json::to_value(value).unwrap_or_default();
    match values {
        [one] => json(one),
        _ => values.iter().map(json).collect(),
    }
}
