//! Reading of typed values from TOML tables; every fault is noted and reading goes on.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{self, Key, Shape};
use crate::diagnostic::{Code, Diagnostic, nearest, quoted};

/// One table of the file while it is read.
pub(crate) struct Fields<'a, 'f> {
    table: &'a DeTable<'a>,
    shape: Shape,
    /// Path of the table; empty for the top of the file.
    path: String,
    /// Where to point for what the table lacks.
    place: Range<usize>,
    faults: &'f mut Vec<Diagnostic>,
}

impl<'a, 'f> Fields<'a, 'f> {
    /// Starts on a table; reports its unknown keys.
    pub(crate) fn new(
        table: &'a DeTable<'a>,
        shape: Shape,
        path: String,
        place: Range<usize>,
        faults: &'f mut Vec<Diagnostic>,
    ) -> Self {
        let fields = Self {
            table,
            shape,
            path,
            place,
            faults,
        };
        for key in fields.table.keys() {
            if fields.shape.key(key.get_ref()).is_none() {
                let fault = fields.unknown(key);
                fields.faults.push(fault);
            }
        }
        fields
    }

    /// The value of a key, `None` where it is absent or was reported.
    pub(crate) fn read<T: Read>(&mut self, name: &str) -> Option<Spanned<T>> {
        let item = self.item(name)?;
        let value = T::read(&item, self.faults)?;
        Some(Spanned::new(item.place, value))
    }

    /// Reports those of `names` that are absent, except where a misspelt key was reported in their stead.
    pub(crate) fn require(&mut self, names: &[&str]) {
        for name in names {
            if self.key_place(name).is_none() {
                let fault = self.missing(name);
                self.faults.push(fault);
            }
        }
    }

    /// A table in this one.
    pub(crate) fn table<T>(
        &mut self,
        name: &str,
        shape: Shape,
        read: impl FnOnce(&mut Fields<'a, '_>) -> T,
    ) -> Option<T> {
        let item = self.item(name)?;
        let DeValue::Table(table) = item.value else {
            let help = match item.value {
                DeValue::Array(_) => format!("there is one such table: head it `{}`", shape.header),
                _ => format!("head the table `{}`", shape.header),
            };
            self.faults.push(item.wrong_type("a table").help(help));
            return None;
        };
        Some(read(&mut Fields::new(
            table,
            shape,
            item.path,
            item.place,
            self.faults,
        )))
    }

    /// An array of tables in this one; empty where it is absent or was reported.
    pub(crate) fn tables<T>(
        &mut self,
        name: &str,
        shape: Shape,
        mut read: impl FnMut(&mut Fields<'a, '_>) -> T,
    ) -> Vec<T> {
        let Some(item) = self.item(name) else {
            return Vec::new();
        };
        let DeValue::Array(elements) = item.value else {
            let help = format!(
                "head each of them `{}`, with two brackets on either side",
                shape.header
            );
            self.faults.push(item.wrong_type("an array of tables").help(help));
            return Vec::new();
        };
        let mut values = Vec::with_capacity(elements.len());
        for (index, element) in elements.iter().enumerate() {
            let element = item.element(index, element);
            match element.value {
                DeValue::Table(table) => {
                    let mut fields = Fields::new(table, shape, element.path, element.place, self.faults);
                    values.push(read(&mut fields));
                }
                _ => self.faults.push(
                    element
                        .wrong_type("a table")
                        .help(format!("head each of them `{}`", shape.header)),
                ),
            }
        }
        values
    }

    /// Path of the table.
    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    /// Place of the table's header.
    pub(crate) fn place(&self) -> Range<usize> {
        self.place.clone()
    }

    /// Place of a key, if the table has it, or what is likely to be meant for it.
    pub(crate) fn key_place(&self, name: &str) -> Option<Range<usize>> {
        let is_meant = |key: &str| self.shape.key(key).is_none() && self.nearest(key) == Some(name);
        let written = self.table.get_key_value(name).map(|(key, _)| key);
        let meant = || self.table.keys().find(|key| is_meant(key.get_ref()));
        written.or_else(meant).map(Spanned::span)
    }

    /// Reports a fault of the table as a whole.
    pub(crate) fn report(&mut self, fault: Diagnostic) {
        self.faults.push(fault);
    }

    fn nearest(&self, key: &str) -> Option<&'static str> {
        nearest(key, self.shape.keys.iter().map(|key| key.name))
    }

    fn key_path(&self, name: &str) -> String {
        if self.path.is_empty() {
            name.to_string()
        } else {
            format!("{}.{name}", self.path)
        }
    }

    fn item(&self, name: &str) -> Option<Item<'a>> {
        let key = self.shape.key(name)?;
        let (written, value) = self.table.get_key_value(name)?;
        Some(Item {
            path: self.key_path(name),
            key,
            place: place_of(written.span(), value),
            value: value.get_ref(),
        })
    }

    fn missing(&self, name: &str) -> Diagnostic {
        let path = self.key_path(name);
        let example = self.shape.key(name).map_or(name, |key| key.example);
        let (message, help) = match example.strip_prefix('[') {
            Some(_) => {
                let shape = keys::ALL.iter().find(|shape| shape.header == example);
                let keys = shape.map_or(&[] as &[Key], |shape| shape.keys);
                let keys: Vec<_> = keys.iter().map(|key| key.name).collect();
                let help = format!("add the table `{example}` with {}", keys.join(", "));
                (format!("the table `{example}` is missing"), help)
            }
            None => (
                format!("`{path}` is missing"),
                format!("add a line like `{example}`"),
            ),
        };
        let label = match self.shape.header {
            "" => format!("this airframe has no `{name}`"),
            header => format!("this `{header}` has no `{name}`"),
        };
        Diagnostic::new(Code::MissingKey, path, self.place(), message)
            .label(label)
            .help(help)
    }

    fn unknown(&self, key: &Spanned<Cow<'a, str>>) -> Diagnostic {
        let name = key.get_ref();
        let (here, shape) = match self.shape.header {
            "" => ("at the top of the file".to_string(), "the file".to_string()),
            header => (format!("in `{header}`"), format!("`{header}`")),
        };
        let home = keys::ALL.iter().find(|shape| shape.key(name).is_some());
        let (label, help) = match (self.nearest(name), home) {
            (Some(near), _) => (
                format!("did you mean `{near}`?"),
                format!("rename it `{near}`, or remove it"),
            ),
            // A key written under the wrong header is spelt as elsewhere.
            (None, Some(Shape { header: "", .. })) => (
                "belongs at the top".into(),
                "move it above the first `[table]` of the file".into(),
            ),
            (None, Some(home)) => (
                format!("belongs in `{}`", home.header),
                format!("move it under `{}`", home.header),
            ),
            (None, None) => {
                let known: Vec<_> = self.shape.keys.iter().map(|key| key.name).collect();
                (
                    "unknown".into(),
                    format!("remove it; the keys of {shape} are {}", known.join(", ")),
                )
            }
        };
        let message = format!("there is no key {} {here}", quoted(name));
        Diagnostic::new(Code::UnknownKey, self.key_path(name), key.span(), message)
            .label(label)
            .help(help)
    }
}

/// A value while it is read.
pub(crate) struct Item<'a> {
    path: String,
    key: &'static Key,
    place: Range<usize>,
    value: &'a DeValue<'a>,
}

impl<'a> Item<'a> {
    fn element(&self, index: usize, element: &'a Spanned<DeValue<'a>>) -> Item<'a> {
        Item {
            path: format!("{}[{index}]", self.path),
            key: self.key,
            place: element.span(),
            value: element.get_ref(),
        }
    }

    fn wrong_type(&self, wanted: &str) -> Diagnostic {
        let found = type_of(self.value);
        Diagnostic::new(
            Code::WrongType,
            self.path.as_str(),
            self.place.clone(),
            format!("`{}` is {found}, not {wanted}", self.path),
        )
        .label(format!("expected {wanted}"))
        .help(format!("write it like `{}`", self.key.example))
    }
}

/// Where to point for a value: at the value itself, but for an array, which may run over many lines, at its key.
/// (What the parser takes for the place of a table is its header.)
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

impl Read for String {
    fn read(item: &Item<'_>, faults: &mut Vec<Diagnostic>) -> Option<Self> {
        let text = item.value.as_str().map(str::to_string);
        if text.is_none() {
            faults.push(item.wrong_type("a string"));
        }
        text
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
            faults.push(
                Diagnostic::new(
                    Code::NotFinite,
                    item.path.as_str(),
                    item.place.clone(),
                    format!("`{}` is {what}", item.path),
                )
                .label("must be finite")
                .help("write the measured number in the unit that the key names"),
            );
            return None;
        }
        Some(number)
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
            faults.push(
                Diagnostic::new(
                    Code::OutOfRange,
                    item.path.as_str(),
                    item.place.clone(),
                    format!("`{}` = {} is not a count", item.path, quoted(integer.as_str())),
                )
                .label("expected a small whole number, from 0")
                .help(format!("write it like `{}`", item.key.example)),
            );
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
            faults.push(
                Diagnostic::new(
                    Code::WrongLength,
                    item.path.as_str(),
                    item.place.clone(),
                    format!("`{}` has {found} {elements}, not {N}", item.path),
                )
                .label(format!("expected {N} elements"))
                .help(format!("write it like `{}`", item.key.example)),
            );
        }
        array
    }
}
