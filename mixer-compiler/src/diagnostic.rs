//! Faults in an airframe file and warnings of it: what is wrong, where, by how much, and what would mend it.

mod code;
mod wording;

use std::fmt;
use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use serde::Serialize;

pub use self::code::{Code, Severity};
pub(crate) use self::wording::{any_of, nearest, number, quoted, rounded};
use crate::source::{BYTE_ORDER_MARK, Source};

/// One fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Kind of fault.
    pub code: Code,
    /// Path of the key at fault, like `unit[3].channels`; empty where the whole file is.
    pub key: String,
    /// Bytes of the text to point at; `None` where the file has no such place.
    pub span: Option<Range<usize>>,
    /// One sentence with the number that matters, without a full stop.
    pub message: String,
    /// A few words beside the caret; may be empty.
    pub label: String,
    /// What would mend it; may be empty.
    pub help: String,
}

impl Diagnostic {
    /// A fault of kind `code` in `key`, without label and help yet.
    pub fn new(
        code: Code,
        key: impl Into<String>,
        span: impl Into<Option<Range<usize>>>,
        message: impl Into<String>,
    ) -> Self {
        Self {
            code,
            key: key.into(),
            span: span.into(),
            message: message.into(),
            label: String::new(),
            help: String::new(),
        }
    }

    /// The same fault with a few words beside the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same fault with advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }
}

/// All faults of one airframe file, or all warnings, in the order of their places.
///
/// Its `Display` is what the macro, the build-script helper and the command line show:
///
/// ```text
/// error[MIX101]: `throttle.min` = 0.9 is not 0.01 or more below `throttle.max` = 0.5
///  --> airframes/x8.toml:4:7
///   |
/// 4 | min = 0.9
///   |       ^^^ too high, or `max` too low
///   |
///   = help: `min` is the idle, typically 0.05 to 0.15, and `max` is mostly 1
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    source: Source,
    faults: Vec<Diagnostic>,
}

/// Faults that are shown. Nobody reads more at once, and a file that is no airframe at all may have thousands.
const MOST_SHOWN: usize = 100;

/// One fault for machines: `cargo mixer check --json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Record {
    /// `MIX014`.
    pub code: String,
    /// Path of the file as given.
    pub file: String,
    /// Line from 1, if the fault has a place.
    pub line: Option<usize>,
    /// Column in characters from 1, if the fault has a place.
    pub column: Option<usize>,
    /// Path of the key at fault.
    pub key: String,
    /// One sentence with the number that matters.
    pub message: String,
    /// A few words on the place.
    pub label: String,
    /// What would mend it.
    pub help: String,
}

impl Diagnostics {
    /// The faults of `source`, sorted by place; those without a place come last.
    pub fn new(source: Source, mut faults: Vec<Diagnostic>) -> Self {
        // Stable: faults of one place stay in the order in which the stages found them.
        faults.sort_by_key(|fault| fault.span.as_ref().map_or(usize::MAX, |span| span.start));
        faults.dedup();
        Self { source, faults }
    }

    /// The file that the faults are in.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The faults, sorted by place.
    pub fn faults(&self) -> &[Diagnostic] {
        &self.faults
    }

    /// Line of a fault, from 1.
    pub fn line(&self, fault: &Diagnostic) -> Option<usize> {
        fault.span.as_ref().map(|span| self.source.place(span.start).line)
    }

    /// Column of a fault in characters, from 1.
    pub fn column(&self, fault: &Diagnostic) -> Option<usize> {
        fault
            .span
            .as_ref()
            .map(|span| self.source.place(span.start).column)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.faults.is_empty()
    }

    /// Every diagnostic on one line, for logs that show no more: `x8.toml:4:7: warning[MIX303]: message; help`.
    pub fn lines(&self) -> Vec<String> {
        self.faults
            .iter()
            .map(|fault| {
                let severity = match fault.code.severity() {
                    Severity::Error => "error",
                    Severity::Warning => "warning",
                };
                let help = match fault.help.as_str() {
                    "" => String::new(),
                    help => format!("; {help}"),
                };
                let place = self.written_place(fault);
                format!("{place}: {severity}[{}]: {}{help}", fault.code, fault.message)
            })
            .collect()
    }

    /// `x8.toml:4:7`, or the file alone.
    fn written_place(&self, fault: &Diagnostic) -> String {
        match (self.line(fault), self.column(fault)) {
            (Some(line), Some(column)) => format!("{}:{line}:{column}", self.source.name),
            _ => self.source.name.clone(),
        }
    }

    /// The faults for machines, in the same order.
    pub fn records(&self) -> Vec<Record> {
        self.records_where(|_| true)
    }

    /// Those of one severity for machines, in the same order.
    pub fn records_of(&self, severity: Severity) -> Vec<Record> {
        self.records_where(|fault| fault.code.severity() == severity)
    }

    fn records_where(&self, is_wanted: impl Fn(&Diagnostic) -> bool) -> Vec<Record> {
        self.faults
            .iter()
            .filter(|fault| is_wanted(fault))
            .map(|fault| Record {
                code: fault.code.to_string(),
                file: self.source.name.clone(),
                line: self.line(fault),
                column: self.column(fault),
                key: fault.key.clone(),
                message: fault.message.clone(),
                label: fault.label.clone(),
                help: fault.help.clone(),
            })
            .collect()
    }

    /// The text for `compile_error!`. Editors show its first line alone, so that line says where and what;
    /// all faults follow as in `Display`.
    pub fn compile_error(&self) -> String {
        let mut errors = self
            .faults
            .iter()
            .filter(|fault| fault.code.severity() == Severity::Error);
        let Some(first) = errors.next() else {
            return format!("{}: refused", self.source.name);
        };
        let place = self.written_place(first);
        let others = match errors.count() {
            0 => String::new(),
            others => format!(" (first of {} faults)", others + 1),
        };
        format!("{place}: {}{others}\n\n{self}", first.message)
    }

    fn render(&self, fault: &Diagnostic) -> String {
        let level = match fault.code.severity() {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level
            .primary_title(fault.message.as_str())
            .id(fault.code.to_string());
        let mut group = match &fault.span {
            Some(span) => title.element(self.snippet(span, &fault.label)),
            None => title.element(Origin::path(self.source.name.as_str())),
        };
        if !fault.help.is_empty() {
            group = group.element(Level::HELP.message(fault.help.as_str()));
        }
        Renderer::plain().decor_style(DecorStyle::Ascii).render(&[group])
    }

    fn snippet<'a>(
        &'a self,
        span: &Range<usize>,
        label: &'a str,
    ) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        // The mark would be printed and counted as a character.
        let (text, skipped) = match self.source.text.strip_prefix(BYTE_ORDER_MARK) {
            Some(text) => (text, BYTE_ORDER_MARK.len_utf8()),
            None => (self.source.text.as_str(), 0),
        };
        let start = self.source.boundary(span.start);
        let mut end = self.source.boundary(span.end).max(start);
        // One line is enough to find the place, and a caret across lines would push the label away from it.
        if let Some(length) = self.source.text[start..end].find(['\r', '\n']) {
            end = start + length;
        }
        // A caret needs a character to stand under, where the line has one.
        let next = self.source.text[start..]
            .chars()
            .next()
            .filter(|next| !matches!(next, '\r' | '\n'));
        if let (true, Some(next)) = (start == end, next) {
            end += next.len_utf8();
        }
        let span = start.saturating_sub(skipped)..end.saturating_sub(skipped);
        let caret = AnnotationKind::Primary.span(span);
        Snippet::source(text)
            .path(self.source.name.as_str())
            .annotation(if label.is_empty() {
                caret
            } else {
                caret.label(label)
            })
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.faults.iter().take(MOST_SHOWN).enumerate() {
            if index > 0 {
                write!(f, "\n\n")?;
            }
            f.write_str(&self.render(fault))?;
        }
        match self.faults.len().checked_sub(MOST_SHOWN) {
            None | Some(0) => Ok(()),
            Some(others) => write!(f, "\n\n{others} more faults are not shown"),
        }
    }
}

impl std::error::Error for Diagnostics {}
