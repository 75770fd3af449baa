//! Faults of the TOML itself, in the words of someone who fills in an airframe file.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Source;

/// What the parser says of a key that is there twice; the rest of the file is read all the same.
const DUPLICATE: &str = "duplicate key";

/// Parses the text and notes its faults. `None` where they leave the values in doubt.
pub(super) fn parse<'a>(source: &'a Source, faults: &mut Vec<Diagnostic>) -> Option<DeTable<'a>> {
    let (table, mut errors) = DeTable::parse_recoverable(&source.text);
    let table = table.into_inner();
    let sound = errors.iter().all(|error| error.message() == DUPLICATE);

    errors.sort_by_key(start);
    let mut last_line = 0;
    for error in &errors {
        let line = source.place(start(error)).line;
        // The parser goes on within the line and within an array that is never closed, and trips over the
        // consequences of the first fault. Those are no faults of the user's.
        if line == last_line {
            continue;
        }
        last_line = line;
        faults.push(diagnostic(source, error));
        if within_lines(&table, &source.text, start(error)) {
            break;
        }
    }
    sound.then_some(table)
}

fn start(error: &Error) -> usize {
    error.span().map_or(0, |span| span.start)
}

/// Whether `offset` is in a value of several lines, after its first.
fn within_lines(table: &DeTable<'_>, text: &str, offset: usize) -> bool {
    let breaks_before = |span: Range<usize>| {
        span.contains(&offset)
            && text
                .get(span.start..offset)
                .is_some_and(|before| before.contains('\n'))
    };
    table.iter().any(|(_, value)| {
        match value.get_ref() {
        DeValue::Table(table) => within_lines(table, text, offset),
        DeValue::Array(elements) => breaks_before(value.span()) || elements.iter().any(|element| {
            matches!(element.get_ref(), DeValue::Table(table) if within_lines(table, text, offset))
        }),
        _ => breaks_before(value.span()),
    }
    })
}

fn diagnostic(source: &Source, error: &Error) -> Diagnostic {
    let message = error.message();
    let message = message.strip_suffix(", expected nothing").unwrap_or(message);
    let span = error.span().unwrap_or(0..0);
    let written = source.text.get(span.clone()).unwrap_or("");
    let rest = source
        .text
        .get(span.start..)
        .unwrap_or("")
        .lines()
        .next()
        .unwrap_or("");
    let before = source
        .text
        .get(..span.start)
        .and_then(|text| text.lines().next_back())
        .unwrap_or("")
        .trim_end();
    let help = if message == DUPLICATE {
        "keep one of the two; units are headed `[[unit]]`, with two brackets on either side".to_string()
    } else if rest.starts_with(',') && before.ends_with(|c: char| c.is_ascii_digit()) {
        "decimals are written with a point: 5.2".to_string()
    } else if rest.starts_with(':')
        || (before.ends_with(|c: char| c.is_alphanumeric()) && rest.starts_with(' '))
    {
        "a key and its value are joined by `=`, as in `min = 0.10`".to_string()
    } else if written.starts_with(|c: char| c.is_ascii_alphabetic()) {
        format!("text needs quotes: \"{}\"", written.trim())
    } else if before.ends_with('.') || rest.starts_with('.') {
        "a decimal point has digits on both sides: 0.5, 1.0".to_string()
    } else if message.contains("array") || message.contains("table") || message.contains("string") {
        "check that every bracket and quote is closed and that a comma parts the elements".to_string()
    } else {
        "a line is `key = value`, `[table]` or `# comment`; see https://toml.io".to_string()
    };
    Diagnostic::new(Code::Syntax, "", span, format!("not TOML: {message}")).help(help)
}

/// Where each key is, by its path: see [`super::fields::place_of`].
pub(super) fn places(table: &DeTable<'_>) -> super::Places {
    let mut places = super::Places::new();
    for (key, value) in table {
        let place = super::fields::place_of(key.span(), value);
        note(key.get_ref().to_string(), place, value, &mut places);
    }
    places
}

fn note(path: String, place: Range<usize>, value: &Spanned<DeValue<'_>>, places: &mut super::Places) {
    match value.get_ref() {
        DeValue::Table(table) => {
            for (key, value) in table {
                let place = super::fields::place_of(key.span(), value);
                note(format!("{path}.{}", key.get_ref()), place, value, places);
            }
        }
        DeValue::Array(elements) => {
            for (index, element) in elements.iter().enumerate() {
                note(format!("{path}[{index}]"), element.span(), element, places);
            }
        }
        _ => {}
    }
    places.insert(path, place);
}
