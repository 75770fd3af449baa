//! A flight stack's parameters by name.
//!
//! A line is `NAME,VALUE` or `NAME VALUE` (Mission Planner, MAVProxy) or, tab-separated, vehicle,
//! component, name, value and type (QGroundControl). `#` begins a comment. In a script, of PX4's
//! start or of MAVProxy, the parameters are those of `param set` and `param set-default`; all else is
//! passed over there.

use std::collections::BTreeMap;

use mixer_compiler::Source;

/// The parameters of one file.
#[derive(Debug)]
pub(crate) struct Parameters {
    file: String,
    /// Each with its line.
    values: BTreeMap<String, (f64, u32)>,
    /// The note on a file that is included.
    pub(crate) included: Option<String>,
}

/// Longest piece of a bad line in a message, characters.
const LONGEST_PIECE: usize = 80;

impl Parameters {
    pub(crate) fn read(source: &Source) -> Result<Self, String> {
        let Source { name: file, text, .. } = source;
        let lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
        let statements = lines.flat_map(|(line, number)| {
            let content = line.split('#').next().unwrap_or_default();
            content.split(';').map(move |statement| (statement, number))
        });
        let statements: Vec<_> = statements.collect();
        let is_script = statements
            .iter()
            .any(|(statement, _)| set(&words(statement)).is_some());
        let mut parameters = Parameters {
            file: file.clone(),
            values: BTreeMap::new(),
            included: None,
        };
        for (statement, number) in statements {
            let words = words(statement);
            let words = if is_script {
                set(&words).unwrap_or_default()
            } else {
                &words
            };
            let (name, value) = match *words {
                [] => continue,
                ["@include", name] => {
                    let told =
                        format!("{file}:{number}: @include {name} is passed over: what it sets is not read");
                    parameters.included = Some(told);
                    continue;
                }
                [vehicle, _, name, value, _] if vehicle.parse::<u32>().is_ok() => (name, value.parse()),
                [name, value] => (name, value.parse()),
                // A type, `@READONLY`, or a script's `fail`; not the rest of a number with a decimal comma.
                [name, value, more] if !statement.contains(',') || more.parse::<f64>().is_err() => {
                    (name, value.parse())
                }
                [name, ..] => (name, "".parse()),
            };
            match value {
                Ok(value) => parameters.add(name, value, number, is_script)?,
                // What a script computes is not known here.
                Err(_) if is_script && !is_of_rotors(name) => {}
                Err(_) => {
                    let piece: String = statement.trim().chars().take(LONGEST_PIECE).collect();
                    return Err(format!(
                        "{file}:{number}: `{piece}` is no parameter: NAME,VALUE with a number, or a line of QGroundControl's; a remark stands behind #"
                    ));
                }
            }
        }
        Ok(parameters)
    }

    /// A parameter of a line. One that was there before is the same again, or in a script a later
    /// value, though not of a rotor: a copied line whose number was left.
    fn add(&mut self, name: &str, value: f64, number: u32, is_script: bool) -> Result<(), String> {
        let file = &self.file;
        if !value.is_finite() {
            return Err(format!(
                "{file}:{number}: {name} is {value}: write the number that the stack has"
            ));
        }
        match self.values.insert(name.to_owned(), (value, number)) {
            Some((before, first)) if before != value && (!is_script || is_of_rotors(name)) => Err(format!(
                "{file}:{number}: {name} is there twice, first in line {first}: leave one of them"
            )),
            _ => Ok(()),
        }
    }

    /// Where a parameter is, `file:line`; the file where it is not there.
    pub(crate) fn place(&self, name: &str) -> String {
        match self.values.get(name) {
            Some((_, line)) => format!("{}:{line}", self.file),
            None => self.file.clone(),
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.values.len()
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// A value. Stacks hold single precision, of which these are the decimal digits.
    pub(crate) fn get(&self, name: &str) -> Option<f64> {
        // What is read is written back or named by `params`: nothing else may be read.
        #[cfg(test)]
        assert!(
            crate::params::read::back(name).is_some(),
            "{name} is in no table of params/read.rs"
        );
        let (value, _) = self.values.get(name)?;
        format!("{}", *value as f32).parse().ok()
    }

    /// A value, or the stack's default.
    pub(crate) fn or(&self, name: &str, default: f64) -> f64 {
        self.get(name).unwrap_or(default)
    }

    /// The names of all, in alphabetical order.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.values.keys().map(String::as_str)
    }

    /// A whole number from 0, if it is one.
    pub(crate) fn whole(&self, name: &str) -> Option<usize> {
        let value = self.get(name)?;
        (value >= 0.0 && value.fract() == 0.0 && value < 1e6).then_some(value as usize)
    }
}

/// The words of a line, without quotes and the flag of `param set -s`.
pub(crate) fn words(line: &str) -> Vec<&str> {
    let separated = |c: char| c.is_whitespace() || matches!(c, ',' | '=' | '"' | '\'');
    let words = line.split(separated);
    words.filter(|word| !matches!(*word, "" | "-s")).collect()
}

/// What follows `param set` or `param set-default`.
fn set<'a, 'b>(words: &'b [&'a str]) -> Option<&'b [&'a str]> {
    let is_set = |pair: &[&str]| matches!(pair, ["param", "set" | "set-default"]);
    let at = words.windows(2).position(is_set)?;
    Some(&words[at + 2..])
}

/// Whether a rotor's place or spin depends on it.
fn is_of_rotors(name: &str) -> bool {
    name.starts_with("CA_") || name.contains("FRAME_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_forms_are_read() {
        let text = "\u{feff}# a comment\r\nFRAME_CLASS,4\r\nMOT_SPIN_MIN\t0.15\n1\t1\tCA_ROTOR0_PX\t0.190500006079673767\t9\n";
        let parameters = Parameters::read(&Source::new("a.params", text)).unwrap();
        assert_eq!(parameters.count(), 3);
        assert_eq!(parameters.whole("FRAME_CLASS"), Some(4));
        assert_eq!(parameters.get("CA_ROTOR0_PX"), Some(0.1905));
        assert_eq!(parameters.or("MOT_SPIN_MAX", 0.95), 0.95);
    }

    #[test]
    fn scripts_are_read() {
        let text = "#!/bin/sh\n. ${R}etc/init.d/rc.mc_defaults\nset MIXER none\nif [ $X = yes ]\nthen\n\tparam set-default \
                    CA_ROTOR0_PX 0.5 # m\n  param set MC_P \"6.5\"; param set-default MAV_ID $((i+1))\nfi\nparam set MC_P 7\n";
        let parameters = Parameters::read(&Source::new("a", text)).unwrap();
        assert_eq!(parameters.count(), 2);
        assert_eq!(parameters.get("CA_ROTOR0_PX"), Some(0.5));
        assert_eq!(parameters.values["MC_P"].0, 7.0);
        for (line, message) in [
            (
                "param set CA_ROTOR0_PX 0.6",
                "a:10: CA_ROTOR0_PX is there twice, first in line 6",
            ),
            (
                "param set CA_ROTOR1_PX $ARM",
                "a:10: `param set CA_ROTOR1_PX $ARM` is no parameter",
            ),
        ] {
            let error = Parameters::read(&Source::new("a", format!("{text}{line}\n"))).unwrap_err();
            assert!(error.starts_with(message), "{error}");
        }
    }

    #[test]
    fn bad_lines_are_named() {
        for (text, message) in [
            ("A,1\nB\n", "a:2: `B` is no parameter"),
            ("A,x", "a:1: `A,x` is no parameter"),
            ("A,1\nA,2", "a:2: A is there twice"),
            ("A,nan", "a:1: A is NaN"),
        ] {
            assert!(
                Parameters::read(&Source::new("a", text))
                    .unwrap_err()
                    .starts_with(message),
                "{text}"
            );
        }
    }
}
