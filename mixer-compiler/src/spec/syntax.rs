//! Faults of the TOML itself, in the words of someone who fills in an airframe file.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

use super::value::place_of;
use crate::diagnostic::content::{self, Content};
use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic, quoted};

/// Where each key of a file is, in bytes, by its path like `unit[3].channels[1]`. Scalars are where
/// their value is, arrays, which may run over many lines, where their key is, and tables where
/// their header is.
pub(crate) type Places = BTreeMap<String, Range<usize>>;

/// What the parser says of a key that is there twice; the rest of the file is read all the same.
const DUPLICATE: &str = "duplicate key";

/// Faults of the TOML itself that are noted. What follows the first ones mostly follows from them,
/// and a file of another kind has one on every line.
const MOST: usize = 100;

/// Parses the text and notes its faults. `None` where they leave the values in doubt.
pub(crate) fn parse<'a>(source: &'a Source, faults: &mut Vec<Diagnostic>) -> Option<DeTable<'a>> {
    let (table, mut errors) = DeTable::parse_recoverable(&source.text);
    if !errors.is_empty() && has_no_table(&source.text) {
        match content::of(&source.text) {
            Content::Airframe | Content::Pair => {}
            other => {
                faults.push(Diagnostic::of_another_kind(other));
                return None;
            }
        }
    }
    let table = table.into_inner();
    let has = |key: &str| table.contains_key(key);
    if errors.is_empty() && has("pair") && !["name", "unit", "layout"].into_iter().any(has) {
        faults.push(Diagnostic::of_another_kind(Content::Pair));
        return None;
    }
    let sound = errors.iter().all(|error| error.message() == DUPLICATE);
    let long_values = match errors.is_empty() {
        true => Vec::new(),
        false => long_values(&table, &source.text),
    };

    errors.sort_by_key(start);
    // Lines are counted on from error to error: from the start for each it would take the square of
    // the text's length.
    let (mut line, mut counted) = (1, 0);
    let mut last_line = 0;
    let mut noted = 0;
    for error in &errors {
        let offset = source.boundary(start(error));
        line += newlines(&source.text, counted..offset);
        counted = offset;
        // The parser goes on within the line and within an array that is never closed, and trips
        // over the consequences of the first fault; a table that is there twice repeats its keys
        // line by line. Those are no further faults of the user's.
        let follows = line == last_line || (error.message() == DUPLICATE && line == last_line + 1);
        last_line = line;
        if follows {
            continue;
        }
        faults.push(diagnostic(source, error));
        noted += 1;
        if noted == MOST || long_values.iter().any(|lines| lines.contains(&offset)) {
            break;
        }
    }
    sound.then_some(table)
}

/// Whether no line of a text is the header of a table, of whatever name, or the name, which every airframe file has.
fn has_no_table(text: &str) -> bool {
    let in_name = |c: char| c.is_ascii_alphanumeric() || "_-.[] \"'".contains(c);
    let is_ours = |line: &str| {
        let table = line.strip_prefix('[').and_then(|line| line.strip_suffix(']'));
        table.is_some_and(|name| !name.is_empty() && name.chars().all(in_name))
            || line
                .strip_prefix("name")
                .is_some_and(|rest| rest.trim_start().starts_with('='))
    };
    let mut lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or(line).trim());
    !lines.any(is_ours)
}

fn start(error: &Error) -> usize {
    error.span().map_or(0, |span| span.start)
}

fn newlines(text: &str, range: Range<usize>) -> usize {
    let bytes = text.as_bytes().get(range).unwrap_or_default();
    bytes.iter().filter(|byte| **byte == b'\n').count()
}

/// Where values of several lines are after their first line, tables aside.
fn long_values(table: &DeTable<'_>, text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    for (_, value) in table {
        if let DeValue::Table(table) = value.get_ref() {
            found.extend(long_values(table, text));
            continue;
        }
        let span = value.span();
        let first_line = text.get(span.clone()).and_then(|value| value.find('\n'));
        found.extend(first_line.map(|length| span.start + length + 1..span.end));
        let elements = value
            .get_ref()
            .as_array()
            .into_iter()
            .flat_map(|array| array.iter());
        let tables = elements.filter_map(|element| element.get_ref().as_table());
        found.extend(tables.flat_map(|table| long_values(table, text)));
    }
    found
}

/// Quotes that word processors and chats put in place of `"` and `'`.
const TYPOGRAPHIC: [char; 8] = [
    '\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}', '\u{201a}', '\u{ab}', '\u{bb}',
];

fn diagnostic(source: &Source, error: &Error) -> Diagnostic {
    let said = error.message();
    let said = said.strip_suffix(", expected nothing").unwrap_or(said);
    let span = error.span().unwrap_or(0..0);
    let text = source.text.as_str();
    let written = text.get(span.clone()).unwrap_or("");
    let rest = text
        .get(span.start..)
        .and_then(|rest| rest.lines().next())
        .unwrap_or("");
    let before = text
        .get(..span.start)
        .and_then(|before| before.split('\n').next_back())
        .unwrap_or("")
        .trim_end();
    let after_word = before.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');

    let is_digit = |c: char| c.is_ascii_digit();
    let is_open = rest.is_empty() && said.contains("string");
    let typographic = match is_open {
        true => before.chars().find(|c| TYPOGRAPHIC.contains(c)),
        false => rest.chars().next().filter(|c| TYPOGRAPHIC.contains(c)),
    };
    let (message, help) = if said == DUPLICATE {
        let help = match written {
            "unit" => "head every unit `[[unit]]`, with two brackets on either side",
            "pair" => {
                "keep one of the two, or head each of several `[[pair]]`, with two brackets on either side"
            }
            _ => "keep one of the two",
        };
        (&*format!("{} is there twice", quoted(written)), help)
    } else if let Some(quote) = typographic {
        (
            &*format!("the typographic quote {quote}"),
            "quotes are straight: \"; word processors and chats replace them by their own",
        )
    } else if written.contains(char::is_control) && !written.contains(char::is_whitespace) {
        (
            "an invisible control character",
            "remove it; a tab in a string is written `\\t`",
        )
    } else if rest.starts_with(',') && before.ends_with(is_digit) {
        (
            "a comma after a number",
            "decimals are written with a point: 0.1, not 0,1",
        )
    } else if rest.starts_with(':') && after_word {
        (
            "a key with `:`",
            "a key and its value are joined by `=`, as in `min = 0.10`",
        )
    } else if before.ends_with('=') && written.starts_with(|c: char| c.is_ascii_alphabetic()) {
        (
            "text without quotes",
            &*format!("quote it: \"{}\"", written.trim()),
        )
    } else if written.contains(' ') && written.starts_with(|c: char| is_digit(c) || "+-".contains(c)) {
        let help = "part the elements of an array with commas, and keys with line breaks";
        ("two values in a row", help)
    } else if before.ends_with('.') || rest.starts_with('.') {
        (said, "a decimal point has digits on both sides: 0.5, 1.0")
    } else if is_open {
        (
            "a string that does not end",
            "close it with the quote that opens it",
        )
    } else if said.contains("array") {
        let help = "close the array, which may start on an earlier line, with `]`; commas part its elements";
        (said, help)
    } else {
        (
            said,
            "a line is `key = value`, `[table]` or `# comment`; see https://toml.io",
        )
    };
    Diagnostic::new(Code::Syntax, "", span, format!("not TOML: {message}")).help(help)
}

/// Where each key is, by its path: see [`place_of`].
pub(crate) fn places(table: &DeTable<'_>) -> Places {
    let mut places = Places::new();
    for (key, value) in table {
        let place = place_of(key.span(), value);
        note(key.get_ref().to_string(), place, value, &mut places);
    }
    places
}

/// Place of a key like `unit[3].channels`, or of the nearest table or array around it that the file
/// has; else of the name.
pub(crate) fn place_in(places: &Places, mut key: &str) -> Option<Range<usize>> {
    loop {
        if let Some(place) = places.get(key) {
            return Some(place.clone());
        }
        match key.rfind(['.', '[']) {
            Some(parent) => key = &key[..parent],
            None => return places.get("name").cloned(),
        }
    }
}

fn note(path: String, place: Range<usize>, value: &Spanned<DeValue<'_>>, places: &mut Places) {
    match value.get_ref() {
        DeValue::Table(table) => {
            for (key, value) in table {
                let place = place_of(key.span(), value);
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
