//! Why a file, or a request about it, cannot be served.

use std::fmt;

use mixer_compiler::diagnostic::cut_to;

/// A reason and what would be needed instead.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The file, with the line if one line is to blame: `bench.csv:17`.
    pub place: Option<String>,
    /// What is wrong, with the numbers that matter.
    pub reason: String,
    /// What would serve.
    pub needed: String,
}

/// Longest message, characters: cells and lists of columns of a broken file can have megabytes.
const LONGEST: usize = 500;

/// Longest cell in a message, characters.
const LONGEST_CELL: usize = 80;

/// The text, of which at most [`LONGEST`] characters are left.
pub(crate) fn cut(text: String) -> String {
    cut_to(text, LONGEST)
}

/// The text of a cell, of which at most 80 characters are left.
pub(crate) fn cut_cell(text: String) -> String {
    cut_to(text, LONGEST_CELL)
}

impl Refusal {
    /// A refusal of the file (or of file:line) `place`.
    pub fn of(place: impl Into<String>, reason: impl Into<String>, needed: impl Into<String>) -> Self {
        Self {
            place: Some(cut(place.into())),
            reason: cut(reason.into()),
            needed: needed.into(),
        }
    }

    /// The file, or nothing, and the line in it.
    pub fn file_and_line(&self) -> (&str, Option<u64>) {
        let place = self.place.as_deref().unwrap_or_default();
        let parts = place.rsplit_once(':');
        let parts = parts.and_then(|(file, line)| Some((file, line.parse().ok()?)));
        parts.map_or((place, None), |(file, line)| (file, Some(line)))
    }

    /// A refusal that concerns all files together.
    pub fn general(reason: impl Into<String>, needed: impl Into<String>) -> Self {
        Self {
            place: None,
            reason: cut(reason.into()),
            needed: needed.into(),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        write!(f, "{}\n  needed: {}", self.reason, self.needed)
    }
}
