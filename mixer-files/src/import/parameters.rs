//! A flight stack's parameters by name.
//!
//! A line is `NAME,VALUE` or `NAME VALUE` (Mission Planner, MAVProxy) or, tab-separated, vehicle,
//! component, name, value and type (QGroundControl). `#` begins a comment.

use std::collections::BTreeMap;

use mixer_compiler::Source;

/// The parameters of one file.
#[derive(Debug)]
pub(super) struct Parameters {
    file: String,
    /// Each with its line.
    values: BTreeMap<String, (f64, u32)>,
}

/// Longest piece of a bad line in a message, characters.
const LONGEST_PIECE: usize = 80;

impl Parameters {
    pub(super) fn read(source: &Source) -> Result<Self, String> {
        let Source { name: file, text } = source;
        let mut values = BTreeMap::new();
        for (line, number) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
            let content = line.split('#').next().unwrap_or_default();
            let separated = |c: char| c.is_whitespace() || c == ',';
            let words: Vec<&str> = content.split(separated).filter(|word| !word.is_empty()).collect();
            let entry = match words[..] {
                [] => continue,
                [vehicle, _, name, value, _] if vehicle.parse::<u32>().is_ok() => Some((name, value)),
                [name, value] | [name, value, _] => Some((name, value)),
                _ => None,
            };
            let entry = entry.and_then(|(name, value)| Some((name, value.parse::<f64>().ok()?)));
            let Some((name, value)) = entry else {
                return Err(format!(
                    "{file}:{number}: `{}` is no parameter: NAME,VALUE or a line of QGroundControl's",
                    line.trim().chars().take(LONGEST_PIECE).collect::<String>()
                ));
            };
            if !value.is_finite() {
                return Err(format!(
                    "{file}:{number}: {name} is {value}: write the number that the stack has"
                ));
            }
            if let Some((_, first)) = values.insert(name.to_owned(), (value, number)) {
                return Err(format!(
                    "{file}:{number}: {name} is there twice, first in line {first}: leave one of them"
                ));
            }
        }
        Ok(Parameters {
            file: file.clone(),
            values,
        })
    }

    /// Where a parameter is, `file:line`; the file where it is not there.
    pub(super) fn place(&self, name: &str) -> String {
        match self.values.get(name) {
            Some((_, line)) => format!("{}:{line}", self.file),
            None => self.file.clone(),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.values.len()
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// A value. Stacks hold single precision, of which these are the decimal digits.
    pub(super) fn get(&self, name: &str) -> Option<f64> {
        let (value, _) = self.values.get(name)?;
        format!("{}", *value as f32).parse().ok()
    }

    /// A value, or the stack's default.
    pub(super) fn or(&self, name: &str, default: f64) -> f64 {
        self.get(name).unwrap_or(default)
    }

    /// A whole number from 0, if it is one.
    pub(super) fn whole(&self, name: &str) -> Option<usize> {
        let value = self.get(name)?;
        (value >= 0.0 && value.fract() == 0.0 && value < 1e6).then_some(value as usize)
    }
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
