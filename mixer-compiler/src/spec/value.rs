//! Reading of typed values; every fault is noted.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::keys::Key;
use crate::diagnostic::{Code, Diagnostic, MOST_FAULTS, is_plain, quoted};

/// A value while it is read.
pub(crate) struct Item<'a> {
    pub(super) path: String,
    pub(super) key: &'static Key,
    pub(super) place: Range<usize>,
    pub(super) value: &'a DeValue<'a>,
}

impl<'a> Item<'a> {
    pub(super) fn element(&self, index: usize, element: &'a Spanned<DeValue<'a>>) -> Item<'a> {
        Item {
            path: format!("{}[{index}]", self.path),
            key: self.key,
            place: element.span(),
            value: element.get_ref(),
        }
    }

    /// A fault of the value.
    fn fault(&self, code: Code, message: String, label: &str) -> Diagnostic {
        Diagnostic::new(code, self.path.as_str(), self.place.clone(), message)
            .label(label)
            .help(format!("write it like `{}`", self.key.example()))
    }

    pub(super) fn wrong_type(&self, wanted: &str) -> Diagnostic {
        let message = format!("`{}` is {}, not {wanted}", self.path, type_of(self.value));
        self.fault(Code::WrongType, message, &format!("expected {wanted}"))
    }
}

/// Where to point for a value: at the value itself, but for an array, which may run over many
/// lines, at its key. (What the parser takes for the place of a table is its header.)
pub(super) fn place_of(key: Range<usize>, value: &Spanned<DeValue<'_>>) -> Range<usize> {
    match value.get_ref() {
        DeValue::Array(_) => key,
        _ => value.span(),
    }
}

fn type_of(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date or time",
        DeValue::Array(elements) if elements.iter().any(|element| element.get_ref().is_table()) => {
            "an array of tables"
        }
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}

/// A type that a key can have.
pub(crate) trait Read: Sized {
    /// Reads the value, or notes why not.
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self>;
}

impl Read for bool {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let value = item.value.as_bool();
        faults.extend(value.is_none().then(|| item.wrong_type("true or false")));
        value
    }
}

impl Read for String {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let Some(text) = item.value.as_str() else {
            faults.push(item.wrong_type("a string"));
            return None;
        };
        // Strings reach the terminal and the comments of generated code.
        if let Some(other) = text.chars().find(|&c| !is_plain(c)) {
            let message = format!(
                "`{}` has the character U+{:04X}, which does not show as itself",
                item.path,
                u32::from(other)
            );
            faults.push(item.fault(Code::NotPlain, message, "expected plain text on one line"));
            return None;
        }
        Some(text.to_string())
    }
}

impl Read for f64 {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let number = match item.value {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => whole(integer.as_str(), integer.radix()),
            DeValue::String(text) if text.trim().parse::<f64>().is_ok() => {
                faults.push(item.wrong_type("a number").help("remove the quotes"));
                return None;
            }
            _ => None,
        };
        let Some(number) = number else {
            faults.push(item.wrong_type("a number"));
            return None;
        };
        if !number.is_finite() {
            let what = if number.is_nan() {
                "not a number"
            } else {
                "infinite, or too large for a float"
            };
            let fault = item.fault(
                Code::NotFinite,
                format!("`{}` is {what}", item.path),
                "must be finite",
            );
            faults.push(fault.help("write the measured number in the unit that the key names"));
            return None;
        }
        // No negative zeros: they would show in the generated code.
        Some(number + 0.0)
    }
}

/// A whole number, rounded as a float is where it has more digits than that holds.
fn whole(digits: &str, radix: u32) -> Option<f64> {
    match radix {
        10 => digits.parse().ok(),
        _ => digits.chars().try_fold(0.0, |sum, digit| {
            Some(sum * f64::from(radix) + f64::from(digit.to_digit(radix)?))
        }),
    }
}

impl Read for usize {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let DeValue::Integer(integer) = item.value else {
            faults.push(item.wrong_type("a whole number"));
            return None;
        };
        // 32 bits on every machine, so that all accept the same files.
        let number = u32::from_str_radix(integer.as_str(), integer.radix()).ok();
        if number.is_none() {
            let message = format!("`{}` = {} is not a count", item.path, quoted(integer.as_str()));
            faults.push(item.fault(Code::OutOfRange, message, "expected a small whole number, from 0"));
        }
        number.map(|number| number as usize)
    }
}

impl<T: Read> Read for Vec<Spanned<T>> {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let DeValue::Array(elements) = item.value else {
            faults.push(item.wrong_type("an array"));
            return None;
        };
        let mut values = Vec::with_capacity(elements.len());
        for (index, element) in elements.iter().enumerate() {
            if faults.len() >= MOST_FAULTS {
                break;
            }
            let element = item.element(index, element);
            values.extend(T::read(&element, faults).map(|value| Spanned::new(element.place, value)));
        }
        // A faulty element makes the rest useless: its length and its order would be wrong.
        (values.len() == elements.len()).then_some(values)
    }
}

impl<T: Read, const N: usize> Read for [Spanned<T>; N] {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let values = Vec::<Spanned<T>>::read(item, faults)?;
        let found = values.len();
        let array = values.try_into().ok();
        if array.is_none() {
            let elements = if found == 1 { "element" } else { "elements" };
            let message = format!("`{}` has {found} {elements}, not {N}", item.path);
            faults.push(item.fault(Code::WrongLength, message, &format!("expected {N} elements")));
        }
        array
    }
}
