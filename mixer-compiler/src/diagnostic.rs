//! Faults in an airframe file and warnings of it: what is wrong, where, by how much, and what would
//! mend it.

mod code;
pub mod content;
pub mod source;
mod wording;

use std::fmt;
use std::ops::Range;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use serde::Serialize;

pub use self::code::{Code, Severity};
use self::content::Content;
pub use self::source::utf16;
use self::source::{BYTE_ORDER_MARK, Place, Source};
pub(crate) use self::wording::{any_of, nearest, number, quoted};
pub use self::wording::{
    commented, cut_to, hanging, is_plain, printable, printable_lines, rounded, rounded_up, wrapped,
};

/// One fault.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
    /// The fault of a file of another kind, which has no place.
    pub(crate) fn of_another_kind(kind: Content) -> Self {
        let what = kind.description();
        let (message, help) = match kind {
            Content::Pair => (
                format!("no airframe: this is {what}"),
                "cargo mixer new --frame x8 --arm METRE --pair FILE -o AIRFRAME.toml makes one of it",
            ),
            _ => (
                format!("not TOML: this is {what}"),
                "an airframe file, as `cargo mixer new` writes one",
            ),
        };
        let fault = Self::new(Code::Syntax, "", 0..0, message);
        Self { span: None, ..fault }.help(help)
    }

    /// A fault of kind `code` in `key`, without label and help yet.
    pub(crate) fn new(
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
    pub(crate) fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// The same fault with advice.
    #[must_use]
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }
}

/// All faults of one airframe file, or all warnings, errors first, then by harm; alike ones in the order of their places.
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
    /// Where each fault is.
    places: Vec<Option<Place>>,
}

/// Faults that are shown. Nobody reads more at once, and a file that is no airframe at all may have
/// thousands.
const MOST_SHOWN: usize = 100;

/// Faults after which a file is not read on: it is no airframe, and reading should not take long.
pub(crate) const MOST_FAULTS: usize = 200;

/// Longest line that is shown, bytes. Of a longer one its place is named alone.
const LONGEST_LINE: usize = 4096;

/// One fault for machines: `cargo mixer check --json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
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

impl Source {
    /// A source from a path to show, of which what does not print is escaped, and the bytes of the
    /// file: UTF-8, or UTF-16 with its byte-order mark.
    ///
    /// # Errors
    /// Bytes that are neither, with the place of the first.
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Result<Self, Diagnostics> {
        let name = printable(&name.into());
        if let Some(text) = utf16(&bytes) {
            return Ok(Self { name, text });
        }
        let bytes = match String::from_utf8(bytes) {
            Ok(text) => return Ok(Self { name, text }),
            Err(error) => error,
        };
        let valid = bytes.utf8_error().valid_up_to();
        let source = Self {
            name,
            text: String::from_utf8_lossy(bytes.as_bytes()).into_owned(),
        };
        let byte = bytes.as_bytes().get(valid).copied().unwrap_or_default();
        let fault = Diagnostic::new(
            Code::Syntax,
            "",
            valid..valid + char::REPLACEMENT_CHARACTER.len_utf8(),
            format!("the file is not UTF-8: byte 0x{byte:02x} at offset {valid}"),
        );
        let fault = match content::foreign(bytes.as_bytes()) {
            Some(what) => Diagnostic::of_another_kind(Content::Foreign(what)),
            None => fault.help("save the file as UTF-8"),
        };
        Err(Diagnostics::new(source, vec![fault]))
    }
}

impl Diagnostics {
    /// The faults of `source`, errors first, then warnings by harm; alike ones by place, those without a place last.
    pub fn new(source: Source, mut faults: Vec<Diagnostic>) -> Self {
        // Stable: faults of one place stay in the order in which the stages found them.
        faults.sort_by_key(|fault| {
            let start = fault.span.as_ref().map_or(usize::MAX, |span| span.start);
            (fault.code.harm(), start)
        });
        faults.dedup();
        // Words of the file may be among them.
        for fault in &mut faults {
            fault.key = printable(&fault.key);
            fault.message = printable(&fault.message);
            fault.label = printable(&fault.label);
            fault.help = printable(&fault.help);
        }
        let place = |fault: &Diagnostic| Some(source.place(fault.span.as_ref()?.start));
        let places = faults.iter().map(place).collect();
        Self {
            source,
            faults,
            places,
        }
    }

    /// The file that the faults are in.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The faults, in their order.
    pub fn faults(&self) -> &[Diagnostic] {
        &self.faults
    }

    /// The faults with their places.
    fn placed(&self) -> impl Iterator<Item = (&Diagnostic, Option<Place>)> {
        self.faults.iter().zip(self.places.iter().copied())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.faults.is_empty()
    }

    /// Every diagnostic on one line, for logs that show no more: `x8.toml:4:7: warning[MIX303]:
    /// message; help`.
    pub fn lines(&self) -> Vec<String> {
        self.placed()
            .map(|(fault, place)| {
                let severity = match fault.code.severity() {
                    Severity::Error => "error",
                    Severity::Warning => "warning",
                };
                let help = match fault.help.as_str() {
                    "" => String::new(),
                    help => format!("; {help}"),
                };
                let place = self.written(place);
                format!("{place}: {severity}[{}]: {}{help}", fault.code, fault.message)
            })
            .collect()
    }

    /// The first of them without its code, for files that are no airframes: `x8.params: message; help`.
    pub fn refusal(&self) -> String {
        let first = self.placed().next();
        first.map_or_else(String::new, |(fault, _)| {
            format!("{}: {}; {}", self.source.name, fault.message, fault.help)
        })
    }

    /// `x8.toml:4:7`, or the file alone.
    fn written(&self, place: Option<Place>) -> String {
        match place {
            Some(Place { line, column }) => format!("{}:{line}:{column}", self.source.name),
            None => self.source.name.clone(),
        }
    }

    /// The faults for machines, in the same order.
    pub fn records(&self) -> Vec<Record> {
        self.placed()
            .map(|(fault, place)| self.record(fault, place))
            .collect()
    }

    /// Those of one severity for machines, in the same order.
    pub fn records_of(&self, severity: Severity) -> Vec<Record> {
        self.placed()
            .filter(|(fault, _)| fault.code.severity() == severity)
            .map(|(fault, place)| self.record(fault, place))
            .collect()
    }

    fn record(&self, fault: &Diagnostic, place: Option<Place>) -> Record {
        Record {
            code: fault.code.to_string(),
            file: self.source.name.clone(),
            line: place.map(|place| place.line),
            column: place.map(|place| place.column),
            key: fault.key.clone(),
            message: fault.message.clone(),
            label: fault.label.clone(),
            help: fault.help.clone(),
        }
    }

    /// The text for `compile_error!`. Editors show its first line alone, so that line says where
    /// and what; all faults follow as in `Display`.
    pub fn compile_error(&self) -> String {
        let mut errors = self
            .placed()
            .filter(|(fault, _)| fault.code.severity() == Severity::Error);
        let Some((first, place)) = errors.next() else {
            return format!("{}: refused", self.source.name);
        };
        let place = self.written(place);
        let others = match errors.count() {
            0 => String::new(),
            others => format!(" (first of {} faults)", others + 1),
        };
        format!("{place}: {}{others}\n\n{self}", first.message)
    }

    /// What `Display` shows, in the colours of a terminal.
    pub fn coloured(&self) -> String {
        self.shown(&Renderer::styled().decor_style(DecorStyle::Ascii))
    }

    fn shown(&self, renderer: &Renderer) -> String {
        let shown: Vec<String> = self
            .placed()
            .take(MOST_SHOWN)
            .map(|(fault, place)| self.render(fault, place, renderer))
            .collect();
        let mut text = shown.join("\n\n");
        match self.faults.len().checked_sub(MOST_SHOWN) {
            None | Some(0) => {}
            Some(others) if self.faults.len() < MOST_FAULTS => {
                text.push_str(&format!("\n\n{others} more faults are not shown"));
            }
            Some(_) => text.push_str("\n\nmore faults are not shown, and the rest of the file is not read"),
        }
        text
    }

    fn render(&self, fault: &Diagnostic, place: Option<Place>, renderer: &Renderer) -> String {
        let level = match fault.code.severity() {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level
            .primary_title(fault.message.as_str())
            .id(fault.code.to_string());
        let origin = || Origin::path(self.source.name.as_str());
        let mut group = match (&fault.span, place) {
            (Some(span), Some(place)) => match self.snippet(span, place, &fault.label) {
                Some(snippet) => title.element(snippet),
                None => title.element(origin().line(place.line).char_column(place.column)),
            },
            _ => title.element(origin()),
        };
        if !fault.help.is_empty() {
            group = group.element(Level::HELP.message(fault.help.as_str()));
        }
        renderer.render(&[group])
    }

    /// The line of a fault; `None` where it is too long to be read.
    fn snippet<'a>(
        &'a self,
        span: &Range<usize>,
        place: Place,
        label: &'a str,
    ) -> Option<Snippet<'a, annotate_snippets::Annotation<'a>>> {
        let text = self.source.text.as_str();
        let start = self.source.boundary(span.start);
        let (before, after) = text.split_at(start);
        // The line alone: the renderer goes through all that it is given.
        let mut line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let mut line_end = after.find('\n').map_or(text.len(), |length| start + length);
        if text.get(start..line_end)?.ends_with('\r') {
            line_end -= 1;
        }
        if line_end - line_start > LONGEST_LINE {
            return None;
        }
        // The mark would be printed and counted as a character.
        if before.get(line_start..)?.starts_with(BYTE_ORDER_MARK) {
            line_start += BYTE_ORDER_MARK.len_utf8();
        }
        // One line is enough to find the place, and a caret across lines would push the label away
        // from it.
        let rest = text.get(start..line_end)?;
        let visible = rest.find('\r').unwrap_or(rest.len());
        let mut end = self.source.boundary(span.end).clamp(start, start + visible);
        // A caret needs a character to stand under, where the line has one.
        if let (true, Some(next)) = (start == end && visible > 0, rest.chars().next()) {
            end += next.len_utf8();
        }
        let caret =
            AnnotationKind::Primary.span(start.saturating_sub(line_start)..end.saturating_sub(line_start));
        let snippet = Snippet::source(visible_line(text.get(line_start..line_end)?))
            .line_start(place.line)
            .path(self.source.name.as_str());
        Some(snippet.annotation(if label.is_empty() {
            caret
        } else {
            caret.label(label)
        }))
    }
}

/// A line with other characters of as many bytes in the place of those that would act on a terminal
/// and that the renderer leaves in; others it replaces itself.
fn visible_line(line: &str) -> String {
    line.chars()
        .map(|c| match c.len_utf8() {
            2 if !is_plain(c) => '\u{b7}',
            3 if !is_plain(c) => char::REPLACEMENT_CHARACTER,
            _ => c,
        })
        .collect()
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.shown(&Renderer::plain().decor_style(DecorStyle::Ascii)))
    }
}

impl std::error::Error for Diagnostics {}
