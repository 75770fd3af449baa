//! An airframe file checked: text in, words and JSON out.

use std::fmt::Write as _;

use mixer_compiler::airframe::Axis;
use mixer_compiler::diagnostic::{Diagnostics, Severity};
use mixer_compiler::{Compiled, Source};
use serde::Serialize;
use serde_json::{Value, json};

use crate::checklist::Checklist;
use crate::facts::{Fact, facts};

/// A compiled airframe with all that there is to say of it.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The airframe.
    pub compiled: Compiled,
    /// What is plausibly a mistake and yet compiles.
    pub warnings: Diagnostics,
    /// Its facts.
    pub facts: Vec<Fact>,
}

/// Compiles an airframe file and says what came of it.
///
/// # Errors
/// The faults of the file; [`refusal`] is their JSON.
pub fn check(source: &Source) -> Result<Checked, Diagnostics> {
    mixer_compiler::compile(source).map(Checked::new)
}

/// The JSON of a refused file: `errors` and `warnings`.
pub fn refusal(faults: &Diagnostics) -> Value {
    let of = |severity| faults.records_of(severity);
    json!({ "errors": of(Severity::Error), "warnings": of(Severity::Warning) })
}

impl Checked {
    /// Of an airframe that is compiled already.
    pub fn new(compiled: Compiled) -> Self {
        Checked {
            warnings: mixer_compiler::lint(&compiled),
            facts: facts(&compiled),
            compiled,
        }
    }

    /// What an engineer asks first, in less than 30 lines.
    pub fn verdict(&self) -> String {
        let mut text: String = lines(self.facts.iter().filter(|fact| fact.in_verdict));
        for axis in Axis::ALL {
            if let Some(rises) = Checklist(&self.compiled).rises_in_words(axis, 0) {
                let command = format!("+{}", axis.name());
                let _ = writeln!(text, "{command:<18}  raises outputs {rises}");
            }
        }
        text
    }

    /// Every fact, units, M and M+, a line for each warning.
    pub fn report(&self) -> String {
        let (facts, warnings) = (lines(&self.facts), self.warnings.lines());
        let (units, matrices) = (units(&self.compiled), matrices(&self.compiled));
        let warnings: String = warnings.iter().map(|line| format!("{line}\n")).collect();
        format!("{units}{matrices}{facts}{warnings}")
    }

    /// The facts by key, the warnings' records, and `more`.
    pub fn json(&self, more: impl Serialize) -> Value {
        let facts = self.facts.iter().flat_map(|fact| fact.json.iter().cloned());
        let mut object: serde_json::Map<String, Value> =
            facts.map(|(key, value)| (key.to_owned(), value)).collect();
        object.insert("warnings".to_owned(), json!(self.warnings.records()));
        if let Ok(Value::Object(more)) = serde_json::to_value(more) {
            object.extend(more);
        }
        Value::Object(object)
    }
}

fn lines<'a>(facts: impl IntoIterator<Item = &'a Fact>) -> String {
    facts.into_iter().map(Fact::to_string).collect()
}

/// Airframes side by side: a row per fact that has a value, a column per airframe.
pub fn compare(all: &[Checked]) -> String {
    // Facts that only some airframes have stand behind the same facts as there.
    let mut names: Vec<(&str, &str)> = Vec::new();
    for checked in all {
        let mut next = 0;
        for fact in checked.facts.iter().filter(|fact| !fact.value.is_empty()) {
            let known = names.iter().position(|(name, _)| *name == fact.name);
            next = 1 + known.unwrap_or_else(|| {
                names.insert(next, (fact.name, fact.unit));
                next
            });
        }
    }
    let titles = names.iter().map(|(name, unit)| match *unit {
        "" => (*name).to_owned(),
        unit => format!("{name} ({unit})"),
    });
    let values = all.iter().map(|checked| {
        let value = |name: &str| {
            let fact = checked.facts.iter().find(|fact| fact.name == name);
            fact.map_or_else(String::new, |fact| fact.value.clone())
        };
        names.iter().map(|(name, _)| value(name)).collect()
    });
    let columns: Vec<Vec<String>> = [titles.collect()].into_iter().chain(values).collect();
    let width = |column: &Vec<String>| column.iter().map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = columns.iter().filter_map(width).collect();
    let mut text = String::new();
    for row in 0..names.len() {
        let cells = columns.iter().zip(&widths).enumerate();
        let line: String = cells
            .map(|(index, (column, width))| match (index, column[row].as_str()) {
                (0, title) => format!("{title:<width$}"),
                (_, "") => format!("  {:>width$}", "-"),
                (_, value) => format!("  {value:>width$}"),
            })
            .collect();
        let _ = writeln!(text, "{line}");
    }
    text
}

fn units(compiled: &Compiled) -> String {
    let is_pairs = compiled.airframe.single_units() == 0;
    let rotors = match is_pairs {
        true => "upper spin  upper channel  lower channel",
        false => "rotors",
    };
    let mut text = format!("unit   x (m)    y (m)    z (m)    {rotors}\n");
    for (index, unit) in compiled.airframe.units.iter().enumerate() {
        let [x, y, z] = unit.position_m;
        let rotors = match unit.lower_channel.filter(|_| is_pairs) {
            Some(lower) => format!(
                "{:<10}  {:<13}  {lower}",
                unit.upper_spin.name(),
                unit.upper_channel
            ),
            None => unit.in_words(),
        };
        let _ = writeln!(text, "{index:<4}  {x:>7.4}  {y:>7.4}  {z:>7.4}    {rotors}");
    }
    text
}

fn matrices(compiled: &Compiled) -> String {
    let n = compiled.airframe.units.len();
    let efforts: Vec<String> = ["f", "Q"]
        .iter()
        .flat_map(|letter| (0..n).map(move |i| format!("{letter}{i}")))
        .collect();
    let axes = Axis::ALL.map(|axis| axis.name().to_owned());
    let effectiveness = &compiled.effectiveness;
    let (m, inverse) = (&effectiveness.matrix, &effectiveness.pseudo_inverse);
    format!(
        "\nM: wrench (N m, N m, N m, N) = M efforts (f in N, Q in N m)\n{}\nM+: least-norm efforts = M+ wrench\n{}\n",
        matrix(&axes, &efforts, |row, column| m[(row, column)]),
        matrix(&efforts, &axes, |row, column| inverse[(row, column)])
    )
}

fn matrix(rows: &[String], columns: &[String], value: impl Fn(usize, usize) -> f64) -> String {
    let header: String = columns.iter().map(|name| format!("{name:>9}")).collect();
    let mut text = format!("{:8}{header}\n", "");
    for (row, name) in rows.iter().enumerate() {
        let values: String = (0..columns.len())
            .map(|column| format!("{:>9.4}", value(row, column)))
            .collect();
        let _ = writeln!(text, "{name:<8}{values}");
    }
    text
}
