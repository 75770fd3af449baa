//! Reading of typed values from TOML tables; every fault is noted and reading goes on.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{self, Key, Shape};
use super::value::{Item, Read, place_of};
use crate::diagnostic::{Code, Diagnostic, MOST_FAULTS, nearest, quoted};

/// One table of the file while it is read.
pub(crate) struct Fields<'a, 'f> {
    table: &'a DeTable<'a>,
    shape: Shape,
    /// Path of the table; empty for the top of the file.
    path: String,
    /// Where to point for what the table lacks.
    place: Range<usize>,
    /// Which keys the unknown ones are likely to be meant for, and where these are.
    meant: Vec<(&'static str, Range<usize>)>,
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
        let mut fields = Self {
            table,
            shape,
            path,
            place,
            meant: Vec::new(),
            faults,
        };
        for key in fields.table.keys() {
            if fields.faults.len() >= MOST_FAULTS {
                break;
            }
            if fields.shape.key(key.get_ref()).is_none() {
                let near = fields.nearest(key.get_ref());
                fields.meant.extend(near.map(|name| (name, key.span())));
                let fault = fields.unknown(key, near);
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

    /// Reports required keys that are absent, except where a misspelt key was reported in their
    /// stead.
    pub(crate) fn require(&mut self) {
        for key in self.shape.keys.iter().filter(|key| key.required) {
            if self.key_place(key.name).is_none() {
                let fault = self.missing(key.name);
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
        let written = self.table.get_key_value(name).map(|(key, _)| key.span());
        let meant = || {
            self.meant
                .iter()
                .find(|(meant, _)| *meant == name)
                .map(|(_, place)| place.clone())
        };
        written.or_else(meant)
    }

    /// Reports a fault of the table as a whole.
    pub(crate) fn report(&mut self, fault: Diagnostic) {
        self.faults.push(fault);
    }

    /// The key that an unknown one is likely to be meant for, rather one that the table still
    /// lacks.
    fn nearest(&self, key: &str) -> Option<&'static str> {
        let names = || self.shape.keys.iter().map(|key| key.name);
        nearest(key, names().filter(|name| !self.table.contains_key(*name))).or_else(|| nearest(key, names()))
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

    fn unknown(&self, key: &Spanned<Cow<'a, str>>, near: Option<&'static str>) -> Diagnostic {
        let name = key.get_ref();
        let (here, shape) = match self.shape.header {
            "" => ("at the top of the file".to_string(), "the file".to_string()),
            header => (format!("in `{header}`"), format!("`{header}`")),
        };
        let home = keys::ALL.iter().find(|shape| shape.key(name).is_some());
        // What is spelt as a key of another table is that key, unless this table lacks one that is
        // nearly spelt so.
        let near = near.filter(|near| home.is_none() || !self.table.contains_key(*near));
        let elsewhere = keys::ALL.iter().find_map(|shape| {
            let names = shape.keys.iter().map(|key| key.name);
            Some((shape.header, nearest(name, names)?))
        });
        let (label, help) = match (near, home) {
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
            (None, None) if elsewhere.is_some() => {
                let (header, near) = elsewhere.unwrap_or_default();
                let (belongs, place) = match header {
                    "" => (
                        "at the top".to_owned(),
                        "above the first `[table]` of the file".to_owned(),
                    ),
                    header => (format!("in `{header}`"), format!("under `{header}`")),
                };
                (
                    format!("did you mean `{near}`, which belongs {belongs}?"),
                    format!("rename it `{near}` and move it {place}, or remove it"),
                )
            }
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
