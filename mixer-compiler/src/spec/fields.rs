//! Reading of typed values from TOML tables; every fault is noted and reading goes on.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{Key, Shape, ValueKind};
use super::value::{Item, Read, place_of};
use crate::diagnostic::{Code, Diagnostic, MOST_FAULTS, any_of, nearest, number, quoted};

/// One table of the file while it is read.
pub(crate) struct Fields<'a, 'f> {
    table: &'a DeTable<'a>,
    shape: &'static Shape,
    /// The shape of the whole file, to tell where a misplaced key belongs.
    file: &'static Shape,
    /// Path of the table; empty for the top of the file.
    path: String,
    /// Where to point for what the table lacks.
    place: Range<usize>,
    /// Which keys the unknown ones are likely to be meant for, and where these are.
    meant: Vec<(&'static str, Range<usize>)>,
    /// The faults found so far.
    pub(crate) faults: &'f mut Vec<Diagnostic>,
}

impl<'a, 'f> Fields<'a, 'f> {
    /// Starts on the whole file; reports unknown and missing keys of its top.
    pub(crate) fn of_file(
        table: &'a DeTable<'a>,
        file: &'static Shape,
        place: Range<usize>,
        faults: &'f mut Vec<Diagnostic>,
    ) -> Self {
        Self::new(table, [file, file], String::new(), place, faults)
    }

    fn new(
        table: &'a DeTable<'a>,
        [shape, file]: [&'static Shape; 2],
        path: String,
        place: Range<usize>,
        faults: &'f mut Vec<Diagnostic>,
    ) -> Self {
        let mut fields = Self {
            table,
            shape,
            file,
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
        // A misspelt key was reported in the stead of the one that it is meant for.
        for key in shape.keys.iter().filter(|key| key.required) {
            if fields.key_place(key).is_none() {
                let fault = fields.missing(key);
                fields.faults.push(fault);
            }
        }
        fields
    }

    /// The value of a key, `None` where it is absent or was reported.
    pub(crate) fn read<T: Read>(&mut self, key: &'static Key) -> Option<Spanned<T>> {
        let item = self.item(key)?;
        let value = T::read(&item, self.faults)?;
        Some(Spanned::new(item.place, value))
    }

    /// An array of as many values; `None` where the key is absent or was reported.
    pub(crate) fn array<T: Read, const N: usize>(&mut self, key: &'static Key) -> Option<[T; N]> {
        let values = self.read::<[Spanned<T>; N]>(key)?.into_inner();
        Some(values.map(|value| value.into_inner()))
    }

    /// A number within the key's range, or its default; `None` where there is none.
    pub(crate) fn number(&mut self, key: &'static Key) -> Option<f64> {
        if self.item(key).is_none() {
            return key.default;
        }
        let field = self.read::<f64>(key)?;
        let x = *field.get_ref();
        if let ValueKind::Number(range) = key.kind
            && let Some([label, help]) = key.refusal
            && !range.contains(x)
        {
            let (path, x) = (self.key_path(key.name), number(x));
            let message = format!("`{path}` = {x} is not {}", range.words());
            return self.refuse(key, Code::OutOfRange, message, label, help);
        }
        Some(x)
    }

    /// The value that a word stands for, of as many as the key has words; `None` where the key is
    /// absent or was reported.
    pub(crate) fn word<T: Copy>(&mut self, key: &'static Key, meanings: &[T]) -> Option<T> {
        let field = self.read::<String>(key)?;
        self.meaning(key, &field, meanings)
    }

    /// [`Fields::word`] of a word that was read already.
    pub(crate) fn meaning<T: Copy>(
        &mut self,
        key: &'static Key,
        field: &Spanned<String>,
        meanings: &[T],
    ) -> Option<T> {
        let (ValueKind::Word(words) | ValueKind::Words(words)) = key.kind else {
            return None;
        };
        let written = field.get_ref();
        let index = words.iter().position(|word| word == written);
        if index.is_none() {
            let path = self.key_path(key.name);
            let label = match nearest(written, words.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "unknown word".to_string(),
            };
            let message = format!("`{path}` cannot be {}", quoted(written));
            let fault = Diagnostic::new(Code::UnknownWord, path, field.span(), message)
                .label(label)
                .help(format!("write {}", any_of(words.iter().copied())));
            self.faults.push(fault);
        }
        meanings.get(index?).copied()
    }

    /// A table in this one.
    pub(crate) fn table<T>(
        &mut self,
        key: &'static Key,
        read: impl FnOnce(&mut Fields<'a, '_>) -> T,
    ) -> Option<T> {
        let item = self.item(key)?;
        let ValueKind::Table(shape) = key.kind else {
            return None;
        };
        let help = match item.value {
            DeValue::Array(_) => format!("there is one such table: head it `{}`", shape.header),
            _ => format!("head the table `{}`", shape.header),
        };
        self.inner(item, shape, help).map(|mut fields| read(&mut fields))
    }

    /// An array of tables in this one, or a table alone where the key takes either; empty where it is absent or was
    /// reported.
    pub(crate) fn tables<T>(
        &mut self,
        key: &'static Key,
        mut read: impl FnMut(&mut Fields<'a, '_>) -> T,
    ) -> Vec<T> {
        let (Some(item), ValueKind::Tables(shape) | ValueKind::TableOrTables(shape)) =
            (self.item(key), key.kind)
        else {
            return Vec::new();
        };
        let is_alone = matches!(key.kind, ValueKind::TableOrTables(_));
        let DeValue::Array(elements) = item.value else {
            if is_alone {
                let help = format!("head the table `{}`", shape.header);
                return self
                    .inner(item, shape, help)
                    .map(|mut fields| read(&mut fields))
                    .into_iter()
                    .collect();
            }
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
            let help = match is_alone {
                true => format!("head each of them `[{}]`", shape.header),
                false => format!("head each of them `{}`", shape.header),
            };
            values.extend(
                self.inner(element, shape, help)
                    .map(|mut fields| read(&mut fields)),
            );
        }
        values
    }

    /// A table in this one, or the fault of what is no table, with this help.
    fn inner(&mut self, item: Item<'a>, shape: &'static Shape, help: String) -> Option<Fields<'a, '_>> {
        let DeValue::Table(table) = item.value else {
            self.faults.push(item.wrong_type("a table").help(help));
            return None;
        };
        let shapes = [shape, self.file];
        Some(Fields::new(table, shapes, item.path, item.place, self.faults))
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
    pub(crate) fn key_place(&self, key: &Key) -> Option<Range<usize>> {
        let name = key.name;
        let written = self.table.get_key_value(name).map(|(key, _)| key.span());
        let meant = || {
            self.meant
                .iter()
                .find(|(meant, _)| *meant == name)
                .map(|(_, place)| place.clone())
        };
        written.or_else(meant)
    }

    /// Notes a fault of a key of the table at its value, which is then refused.
    pub(crate) fn refuse<T>(
        &mut self,
        key: &'static Key,
        code: Code,
        message: String,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> Option<T> {
        let fault = Diagnostic::new(code, self.key_path(key.name), self.value_place(key), message);
        self.faults.push(fault.label(label).help(help));
        None
    }

    /// Place of a key's value, or of the table that lacks it.
    pub(crate) fn value_place(&self, key: &'static Key) -> Range<usize> {
        self.item(key).map_or(self.place(), |item| item.place)
    }

    /// The key that an unknown one is likely to be meant for, rather one that the table still
    /// lacks.
    fn nearest(&self, key: &str) -> Option<&'static str> {
        let names = || self.shape.names();
        nearest(key, names().filter(|name| !self.table.contains_key(*name))).or_else(|| nearest(key, names()))
    }

    /// Path of a key of the table, like `unit[3].channels`.
    pub(crate) fn key_path(&self, name: &str) -> String {
        if self.path.is_empty() {
            name.to_string()
        } else {
            format!("{}.{name}", self.path)
        }
    }

    fn item(&self, key: &'static Key) -> Option<Item<'a>> {
        let (written, value) = self.table.get_key_value(key.name)?;
        Some(Item {
            path: self.key_path(key.name),
            key,
            place: place_of(written.span(), value),
            value: value.get_ref(),
        })
    }

    pub(crate) fn missing(&self, key: &Key) -> Diagnostic {
        let (name, path, example) = (key.name, self.key_path(key.name), key.example());
        let (message, help) = match key.kind {
            ValueKind::Table(shape) | ValueKind::Tables(shape) | ValueKind::TableOrTables(shape) => (
                format!("the table `{example}` is missing"),
                format!("add the table `{example}` with {}", joined(shape.required())),
            ),
            _ => (
                format!("`{path}` is missing"),
                format!("add a line like `{example}`"),
            ),
        };
        let label = format!(
            "{} has no `{name}`",
            of_header(self.shape, "this ", "this airframe")
        );
        Diagnostic::new(Code::MissingKey, path, self.place(), message)
            .label(label)
            .help(help)
    }

    fn unknown(&self, key: &Spanned<Cow<'a, str>>, near: Option<&'static str>) -> Diagnostic {
        let name = key.get_ref();
        let shapes = self.file.all();
        let home = shapes.iter().find(|shape| shape.key(name).is_some());
        // What is spelt as a key of another table is that key, unless this table lacks one that is
        // nearly spelt so.
        let near = near.filter(|near| home.is_none() || !self.table.contains_key(*near));
        let elsewhere = shapes
            .iter()
            .find_map(|shape| Some((shape, nearest(name, shape.names())?)));
        let belongs = |shape| format!("belongs {}", of_header(shape, "in ", "at the top"));
        let under = |shape| of_header(shape, "under ", "above the first `[table]` of the file");
        let (label, help) = match (near, home, elsewhere) {
            (Some(near), ..) => (
                format!("did you mean `{near}`?"),
                format!("rename it `{near}`, or remove it"),
            ),
            // A key written under the wrong header is spelt as elsewhere.
            (None, Some(home), _) => (belongs(home), format!("move it {}", under(home))),
            (None, None, Some((home, near))) => (
                format!("did you mean `{near}`, which {}?", belongs(home)),
                format!("rename it `{near}` and move it {}, or remove it", under(home)),
            ),
            (None, None, None) => {
                let (here, keys) = (of_header(self.shape, "", "the file"), joined(self.shape.names()));
                (
                    "unknown".to_owned(),
                    format!("remove it; the keys of {here} are {keys}"),
                )
            }
        };
        let here = of_header(self.shape, "in ", "at the top of the file");
        let message = format!("there is no key {} {here}", quoted(name));
        Diagnostic::new(Code::UnknownKey, self.key_path(name), key.span(), message)
            .label(label)
            .help(help)
    }
}

/// A table by its header after some words, or the top of the file in others.
fn of_header(shape: &Shape, words: &str, top: &str) -> String {
    match shape.header {
        "" => top.to_owned(),
        header => format!("{words}`{header}`"),
    }
}

fn joined<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
