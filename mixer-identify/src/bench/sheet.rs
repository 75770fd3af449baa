//! Text to a table: separator, header, units below it or in the cells, and how numbers are written.
//!
//! Each is decided once for the file. A separator serves if it makes rows of numbers; of those the one
//! whose header names most quantities. The header is one of the lines above the first row of numbers:
//! the one that names most quantities, the last of equals. What stands above it is passed over.

use crate::bench::number::{Cell, Style, is_blank, is_missing};
use crate::bench::text;
use crate::refusal::Refusal;

/// Most columns of a log; loggers of whole vehicles have some hundred.
const MOST_COLUMNS: usize = 2000;
/// Longest header line, bytes.
const LONGEST_HEADER: usize = 100_000;
/// Lines in which the header is looked for.
const TOP: usize = 200;
/// Rows of numbers at the top that speak for a separator.
const ROWS: usize = 20;
/// Separators, the first of equals. Blanks separate what nothing else does.
const SEPARATORS: [u8; 5] = [b',', b';', b'\t', b'|', b' '];

/// The name of a column, and what else tells its unit.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Heading {
    /// As in the header, with its unit.
    pub name: String,
    /// The cell of a line of units below the header.
    pub below: Option<String>,
    /// What stands behind most numbers of the column.
    pub in_cells: Option<String>,
}

impl Heading {
    /// A name alone.
    pub fn of(name: &str) -> Heading {
        Heading {
            name: name.to_owned(),
            ..Heading::default()
        }
    }
}

/// A file as rows of cells.
#[derive(Debug)]
pub struct Sheet {
    /// Line of the header, from 1; 0 where there is none.
    pub line: u64,
    /// The columns.
    pub headings: Vec<Heading>,
    /// Whether blanks separate the cells, so that none is empty.
    pub by_blanks: bool,
    /// Whether the first line has numbers where names should stand.
    pub without_names: bool,
    /// The rows below the header.
    pub rows: Vec<Row>,
    styles: Vec<Style>,
}

/// A row: its line, and its cells.
pub type Row = (u64, csv::StringRecord);

impl Sheet {
    /// The table of a file. `known` counts the cells of a line that name quantities, `is_unit` says
    /// whether a text is the unit of what a name names.
    ///
    /// # Errors
    /// What is no text, has no line, or a header beyond all measure.
    pub fn of(
        name: &str,
        bytes: &[u8],
        known: &dyn Fn(&[String]) -> usize,
        is_unit: &dyn Fn(&str, &str) -> bool,
    ) -> Result<Sheet, Refusal> {
        if let Some((what, needed)) = text::foreign(bytes) {
            return Err(Refusal::of(name, format!("this is {what}, no CSV file"), needed));
        }
        let mut text = text::normalised(bytes).map_err(|reason| {
            let needed = "a readable CSV file in UTF-8, UTF-16 or Latin-1";
            Refusal::of(name, format!("cannot be read: {reason}"), needed)
        })?;
        // Quotes behind a separator and a blank are quotes.
        text = text.replace(", \"", ",\"").replace("; \"", ";\"");
        let (declared, begin) = declared(&text);
        let mut best: Option<Top> = None;
        for separator in SEPARATORS {
            if declared.is_some_and(|declared| declared != separator) {
                continue;
            }
            let top = Top::of(&text, begin, separator, known);
            if best.as_ref().is_none_or(|best| top.serves() > best.serves()) {
                best = Some(top);
            }
        }
        let Some(Top {
            separator,
            header,
            unnamed,
            ..
        }) = best
        else {
            let reason = "the first line declares a separator that no table has";
            return Err(Refusal::of(
                name,
                reason,
                "cells between commas, semicolons or tabs",
            ));
        };
        let Some((line, end, names)) = header else {
            let needed = "a header line and rows of measurements";
            return Err(Refusal::of(name, "the file is empty", needed));
        };
        let length: usize = names.iter().map(|name| name.len() + 1).sum();
        if names.len() > MOST_COLUMNS || length > LONGEST_HEADER {
            return Err(Refusal::of(
                format!("{name}:{line}"),
                format!("a header line of {} columns and {length} bytes", names.len()),
                format!("at most {MOST_COLUMNS} columns and {LONGEST_HEADER} bytes"),
            ));
        }
        if separator == b' ' {
            text = text.split('\n').map(by_tabs).collect::<Vec<_>>().join("\n");
        }
        let mut sheet = Sheet {
            line: if unnamed { 0 } else { line },
            headings: names.iter().map(|name| Heading::of(name)).collect(),
            by_blanks: separator == b' ',
            without_names: unnamed,
            rows: Rows::of(&text, if unnamed { begin } else { end }, separator).collect(),
            styles: vec![Style::default(); names.len()],
        };
        sheet.take_units(is_unit);
        sheet.take_styles();
        Ok(sheet)
    }

    /// The decimal mark of a column.
    ///
    /// # Errors
    /// Line and text of a number that has two meanings.
    pub fn decimal(&self, index: usize) -> Result<char, (u64, String)> {
        let mut file = Style::default();
        self.styles.iter().for_each(|style| file.join(style));
        self.styles
            .get(index)
            .map_or(Ok('.'), |style| style.decimal(&file))
    }

    /// The line below the header, where it holds units and no number.
    fn take_units(&mut self, is_unit: &dyn Fn(&str, &str) -> bool) {
        let Some((_, cells)) = self.rows.first() else {
            return;
        };
        let bare = |cell: &str| cell.trim_matches(['(', ')', '[', ']', ' ']).to_owned();
        let units: Vec<String> = cells.iter().map(bare).collect();
        let names = self.headings.iter().map(|heading| heading.name.as_str());
        let fits = |(name, unit): (&str, &String)| !is_missing(unit) && is_unit(name, unit);
        let has_number = units.iter().any(|unit| Cell::of(unit).is_some());
        if self.without_names || has_number || !names.zip(&units).any(fits) {
            return;
        }
        for (heading, unit) in self.headings.iter_mut().zip(units) {
            heading.below = Some(unit).filter(|unit| !is_missing(unit));
        }
        self.rows.remove(0);
    }

    /// Marks and units of the numbers in each column.
    fn take_styles(&mut self) {
        let count = self.headings.len();
        let mut units: Vec<(String, usize, usize)> = vec![Default::default(); count];
        let mut styles = vec![Style::default(); count];
        for (line, cells) in &self.rows {
            for ((cell, unit), style) in cells.iter().zip(&mut units).zip(&mut styles) {
                let Some(cell) = Cell::of(cell).filter(Cell::is_number) else {
                    continue;
                };
                let (first, same, all): &mut (String, usize, usize) = unit;
                if *all == 0 {
                    cell.unit.clone_into(first);
                }
                *all += 1;
                *same += usize::from(first == cell.unit);
                style.add(*line, cell.number);
            }
        }
        for (heading, (unit, same, all)) in self.headings.iter_mut().zip(units) {
            heading.in_cells = (2 * same > all && !unit.is_empty()).then_some(unit);
        }
        self.styles = styles;
    }
}

/// A line `sep=;` at the beginning, which spreadsheets write and obey, and where the table begins.
fn declared(text: &str) -> (Option<u8>, (usize, u64)) {
    let (mut byte, mut lines) = (0, 0);
    for line in text.split_inclusive('\n') {
        byte += line.len();
        lines += 1;
        let told = line.trim_matches(['\n', '"', '\u{feff}']);
        match told.get(..4).filter(|begin| begin.eq_ignore_ascii_case("sep=")) {
            Some(_) => return (told.as_bytes().get(4).copied(), (byte, lines)),
            None if !line.trim().is_empty() => break,
            None => {}
        }
    }
    (None, (0, 0))
}

/// What a separator makes of the lines at the top.
struct Top {
    separator: u8,
    /// Line, where it ends (byte, lines), cells.
    header: Option<(u64, (usize, u64), Vec<String>)>,
    /// Whether the header is a row of numbers.
    unnamed: bool,
    known: usize,
    rows: usize,
}

impl Top {
    fn of(text: &str, begin: (usize, u64), separator: u8, known: &dyn Fn(&[String]) -> usize) -> Top {
        let by_blanks = separator == b' ';
        let table: String = match by_blanks {
            true => text
                .split('\n')
                .take(TOP)
                .map(by_tabs)
                .collect::<Vec<_>>()
                .join("\n"),
            false => String::new(),
        };
        let mut rows = Rows::of(if by_blanks { &table } else { text }, begin, separator);
        let mut above = Vec::new();
        let (mut numbers, mut first) = (0, None);
        for _ in 0..TOP {
            let Some((line, cells)) = rows.next() else { break };
            let cells: Vec<String> = cells.iter().map(|cell| cell.trim().to_owned()).collect();
            if !is_row_of_numbers(&cells) {
                if first.is_none() {
                    above.push((line, rows.place(), without_mark(cells)));
                }
                continue;
            }
            numbers += 1;
            first.get_or_insert_with(|| (line, rows.place(), cells));
            if numbers == ROWS {
                break;
            }
        }
        // A title has few cells.
        let width = |cells: &[String]| cells.iter().filter(|cell| !cell.is_empty()).count();
        let wide = first.as_ref().map_or(0, |(.., cells)| width(cells));
        if above.iter().any(|(.., cells)| 2 * width(cells) >= wide) {
            above.retain(|(.., cells)| 2 * width(cells) >= wide);
        }
        // Without numbers below nothing says where the titles end: the first line, then.
        if first.is_none() {
            above.reverse();
        }
        let header = above.into_iter().max_by_key(|(.., cells)| known(cells));
        let unnamed = header.is_none();
        let header = header.or(first);
        Top {
            separator,
            known: header.as_ref().map_or(0, |(.., cells)| known(cells)),
            header,
            unnamed,
            rows: numbers,
        }
    }

    fn serves(&self) -> (bool, usize, usize) {
        (self.rows > 0, self.known, self.rows)
    }
}

/// A comment's mark before names is none of them.
fn without_mark(mut cells: Vec<String>) -> Vec<String> {
    if let Some(first) = cells.first_mut() {
        let name = first.trim_start_matches(['#', '%']).trim_start().to_owned();
        match name.is_empty() && !first.is_empty() {
            true => drop(cells.remove(0)),
            false => *first = name,
        }
    }
    cells
}

/// Whether more than half of the cells that hold something are numbers, two at least.
fn is_row_of_numbers(cells: &[String]) -> bool {
    let held = cells.iter().filter(|cell| !is_missing(cell)).count();
    let is_number = |cell: &&String| Cell::of(cell).is_some_and(|cell| cell.is_number());
    let numbers = cells.iter().filter(is_number).count();
    numbers >= 2 && 2 * numbers > held
}

/// Cells between blanks as cells between tabs. Two blanks or more separate where there are any and a
/// cell is no number; a unit in brackets belongs to the name before it.
fn by_tabs(line: &str) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    let wide: Vec<&str> = line
        .split("  ")
        .flat_map(|part| part.split('\t'))
        .map(str::trim)
        .collect();
    let wide: Vec<&str> = wide.into_iter().filter(|cell| !cell.is_empty()).collect();
    if wide.len() < 2
        || words
            .iter()
            .all(|word| Cell::of(word).is_some_and(|cell| cell.is_number()))
    {
        let mut joined = String::new();
        for word in words {
            let inside = joined.matches(['(', '[']).count() > joined.matches([')', ']']).count();
            joined += match joined.is_empty() {
                true => "",
                false if inside || word.starts_with(['(', '[']) => " ",
                false => "\t",
            };
            joined += word;
        }
        return joined;
    }
    wide.join("\t")
}

/// Rows of cells with their lines; rows without any cell are passed over.
struct Rows<'a> {
    reader: csv::Reader<&'a [u8]>,
    record: csv::StringRecord,
    begin: (usize, u64),
}

impl<'a> Rows<'a> {
    fn of(text: &'a str, begin: (usize, u64), separator: u8) -> Rows<'a> {
        let mut builder = csv::ReaderBuilder::new();
        builder.delimiter(if separator == b' ' { b'\t' } else { separator });
        builder.flexible(true).has_headers(false);
        Rows {
            reader: builder.from_reader(&text.as_bytes()[begin.0.min(text.len())..]),
            record: csv::StringRecord::new(),
            begin,
        }
    }

    /// Where the reader stands: byte, and lines before.
    fn place(&self) -> (usize, u64) {
        let place = self.reader.position();
        (
            self.begin.0 + place.byte() as usize,
            self.begin.1 + place.line() - 1,
        )
    }
}

impl Iterator for Rows<'_> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        // The text is UTF-8 and rows may have any length: nothing is left to fail.
        while matches!(self.reader.read_record(&mut self.record), Ok(true)) {
            // The reader stands behind the row's line end (where the row begins it does not know: it
            // skips blank lines silently). A quoted cell may span lines.
            let inner = self.record.as_slice().matches('\n').count();
            let line = self.place().1 - inner as u64;
            if !self.record.iter().all(is_blank) {
                return Some((line, self.record.clone()));
            }
        }
        None
    }
}
