//! What a key of the airframe file is. The keys themselves stand beside the checks of their tables,
//! in [`crate::airframe`]; the parser, advice, the schema for editors and the tables of
//! `docs/airframe.md` follow from them.

use crate::diagnostic::{any_of, number};

/// A key or a table of the file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name as written in the file.
    pub name: &'static str,
    /// A value that a user could write; empty for a table.
    example: &'static str,
    /// Whether its table must have it.
    pub required: bool,
    /// What it holds.
    pub kind: ValueKind,
    /// What it means, in a sentence.
    meaning: &'static str,
    /// The number that stands for it where the file does not have it.
    pub(crate) default: Option<f64>,
    /// Label and help of the fault of a number out of range; without them the table's own check
    /// judges it.
    pub(crate) refusal: Option<[&'static str; 2]>,
}

impl Key {
    pub(crate) const fn new(
        name: &'static str,
        example: &'static str,
        kind: ValueKind,
        meaning: &'static str,
    ) -> Self {
        Key {
            name,
            example,
            required: false,
            kind,
            meaning,
            default: None,
            refusal: None,
        }
    }

    pub(crate) const fn required(mut self) -> Self {
        self.required = true;
        self
    }

    pub(crate) const fn default(mut self, default: f64) -> Self {
        self.default = Some(default);
        self
    }

    pub(crate) const fn refusing(mut self, label: &'static str, help: &'static str) -> Self {
        self.refusal = Some([label, help]);
        self
    }

    /// The line, or the header, that a user could add.
    pub(crate) fn example(&self) -> String {
        match self.kind {
            ValueKind::Table(shape) | ValueKind::Tables(shape) | ValueKind::TableOrTables(shape) => {
                shape.header.to_owned()
            }
            _ => format!("{} = {}", self.name, self.example),
        }
    }

    /// What it means and what stands for it where the file does not have it.
    pub fn meaning(&self) -> String {
        let meaning = self.meaning;
        match (self.default, meaning.strip_suffix('.')) {
            (Some(default), Some(meaning)) => format!("{meaning}; {} without it.", number(default)),
            _ => meaning.to_owned(),
        }
    }
}

/// What a key holds.
#[derive(Clone, Copy, Debug)]
pub enum ValueKind {
    /// True or false.
    Flag,
    /// Any text.
    Text,
    /// A list of texts.
    Texts,
    /// The name of a Rust module: lower-case letters and digits in parts joined by single `-` or
    /// `_`.
    Name,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Some of these words.
    Words(&'static [&'static str]),
    /// A number in this range.
    Number(Range),
    /// A whole number in this range.
    Count([usize; 2]),
    /// Numbers, as many as in this range.
    Numbers([usize; 2]),
    /// Pairs of a voltage and its factor.
    Points,
    /// Outputs of the upper and of the lower rotor.
    Channels,
    /// Those of several units.
    ListOfChannels,
    /// A table.
    Table(&'static Shape),
    /// A list of tables.
    Tables(&'static Shape),
    /// A table, or a list of tables.
    TableOrTables(&'static Shape),
}

/// The numbers that a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Range {
    /// Those above 0.
    Positive,
    /// Those above 0, up to this one.
    UpTo(f64),
    /// From the first to the second.
    Within([f64; 2]),
}

impl Range {
    pub(crate) fn contains(self, x: f64) -> bool {
        match self {
            Range::Positive => x > 0.0,
            Range::UpTo(most) => x > 0.0 && x <= most,
            Range::Within([least, most]) => (least..=most).contains(&x),
        }
    }

    /// What a number of the range is, in words.
    pub fn words(self) -> String {
        match self {
            Range::Positive => "positive".to_owned(),
            Range::UpTo(most) => format!("above 0 and at most {}", number(most)),
            Range::Within([least, most]) => format!("between {} and {}", number(least), number(most)),
        }
    }
}

impl ValueKind {
    /// What a value is, in words.
    pub fn words(self) -> String {
        let count = |[least, most]: [usize; 2]| match least == most {
            true => least.to_string(),
            false => format!("{least} to {most}"),
        };
        match self {
            ValueKind::Flag => "true or false".to_owned(),
            ValueKind::Text => "text".to_owned(),
            ValueKind::Texts => "list of texts".to_owned(),
            ValueKind::Name => "lower-case letters and digits, joined by `-` or `_`".to_owned(),
            ValueKind::Word(words) => any_of(words.iter().copied()),
            ValueKind::Words(words) => format!("list of {}", any_of(words.iter().copied())),
            ValueKind::Number(range) => format!("number, {}", range.words()),
            ValueKind::Count(range) => format!("whole number, {}", count(range)),
            ValueKind::Numbers(range) => format!("{} numbers", count(range)),
            ValueKind::Points => "list of `[V, factor]`".to_owned(),
            ValueKind::Channels => "`[upper, lower]`, or `[single]`".to_owned(),
            ValueKind::ListOfChannels => "list of `[upper, lower]`".to_owned(),
            ValueKind::Table(_) => "table".to_owned(),
            ValueKind::Tables(_) => "tables".to_owned(),
            ValueKind::TableOrTables(_) => "table, or tables".to_owned(),
        }
    }
}

/// A table of the file.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Header with its brackets; empty for the top of the file.
    pub header: &'static str,
    /// Its keys, in the order of the documentation.
    pub keys: &'static [Key],
}

impl Shape {
    /// The key called `name`.
    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The names of its keys.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.keys.iter().map(|key| key.name)
    }

    /// The names of those that it must have; of all where it must have none.
    pub(crate) fn required(&self) -> impl Iterator<Item = &'static str> + use<> {
        let none = !self.keys.iter().any(|key| key.required);
        let keys = self.keys.iter().filter(move |key| none || key.required);
        keys.map(|key| key.name)
    }

    /// This table, and those in it.
    pub fn all(&'static self) -> Vec<&'static Shape> {
        let inner = self.keys.iter().flat_map(|key| match key.kind {
            ValueKind::Table(shape) | ValueKind::Tables(shape) | ValueKind::TableOrTables(shape) => {
                shape.all()
            }
            _ => Vec::new(),
        });
        std::iter::once(self).chain(inner).collect()
    }
}

/// The keys of a table: each a constant to read it by, `NAME "name" = "example", KIND, "meaning"`
/// with what else [`Key`] can say; and the table's shape.
macro_rules! keys {
    (
        $table:ident = $header:literal:
        $($key:ident $name:literal = $example:expr, $kind:expr, $meaning:literal $(.$more:ident($($of:expr),*))*;)+
    ) => {
        $(const $key: $crate::spec::keys::Key =
            $crate::spec::keys::Key::new($name, $example, $kind, $meaning)$(.$more($($of),*))*;)+

        pub(crate) const $table: $crate::spec::keys::Shape = $crate::spec::keys::Shape {
            header: $header,
            keys: &[$($key),+],
        };
    };
}
pub(crate) use keys;
