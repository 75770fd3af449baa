//! Why a file, or a request about it, cannot be served.

use std::fmt;

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

impl Refusal {
    /// A refusal of the file (or of file:line) `place`.
    pub fn of(place: impl Into<String>, reason: impl Into<String>, needed: impl Into<String>) -> Self {
        Self {
            place: Some(place.into()),
            reason: reason.into(),
            needed: needed.into(),
        }
    }

    /// A refusal that concerns all files together.
    pub fn general(reason: impl Into<String>, needed: impl Into<String>) -> Self {
        Self {
            place: None,
            reason: reason.into(),
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
