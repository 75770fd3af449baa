//! Text to a table: separator, header, units below it or in the cells, and how numbers are written.
//!
//! Each is decided once for the file. A separator serves if it makes rows of numbers; of those the one
//! whose header names most quantities. The header is one of the lines above the first row of numbers:
//! the one that names most quantities, the last of equals; without such a row it is the first line. What
//! stands above it, as `sep=;`, is passed over.

use crate::bench::number::{Cell, Style, is_blank, is_missing};
use crate::bench::text;
use crate::refusal::Refusal;

/// Most columns of a log; loggers of whole vehicles have some hundred.
const MOST_COLUMNS: usize = 2000;
/// Rows in which the header is looked for.
const TOP: usize = 200;
/// Separators, the first of equals. Blanks separate what nothing else does.
const SEPARATORS: [char; 5] = [',', ';', '\t', '|', ' '];

/// The name of a column, and what else tells its unit.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Heading {
    /// As in the header, with its unit.
    pub name: String,
    /// The cell of a line of units below the header.
    pub below: Option<String>,
    /// What stands behind the first number of the column that has a unit.
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
    /// Line of the header, or of the first row where there is none, from 1.
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
        let text = text::normalised(name, bytes)?;
        // Quotes behind a separator and a blank are quotes.
        let text = text.replace(", \"", ",\"").replace("; \"", ";\"");
        let tops = SEPARATORS
            .iter()
            .rev()
            .filter_map(|&separator| Top::of(&text, separator, known));
        let Some(top) = tops.max_by_key(|top| top.serves) else {
            let needed = "a header line and rows of measurements";
            return Err(Refusal::of(name, "the file is empty", needed));
        };
        let count = top.names.len();
        if count > MOST_COLUMNS {
            return Err(Refusal::of(
                format!("{name}:{}", top.line),
                format!("a header line of {count} columns"),
                format!("at most {MOST_COLUMNS} columns"),
            ));
        }
        let mut sheet = Sheet {
            line: top.line,
            headings: top.names.iter().map(|name| Heading::of(name)).collect(),
            by_blanks: top.separator == ' ',
            without_names: top.without_names,
            rows: rows(&text, top.separator).skip(top.before).collect(),
            styles: vec![Style::default(); count],
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
        self.styles[index].decimal(&file)
    }

    /// The line below the header, where it holds units and no number.
    fn take_units(&mut self, is_unit: &dyn Fn(&str, &str) -> bool) {
        let Some((_, cells)) = self.rows.first() else {
            return;
        };
        let bare = |cell| str::trim_matches(cell, ['(', ')', '[', ']', ' ']);
        let units: Vec<&str> = cells.iter().map(bare).collect();
        let pairs = || self.headings.iter().zip(&units);
        let has_number = units.iter().any(|unit| Cell::of(unit).is_some());
        let fits = pairs().any(|(heading, unit)| !is_missing(unit) && is_unit(&heading.name, unit));
        if self.without_names || has_number || !fits {
            return;
        }
        let below: Vec<String> = units.into_iter().map(str::to_owned).collect();
        for (heading, unit) in self.headings.iter_mut().zip(below) {
            heading.below = Some(unit).filter(|unit| !is_missing(unit));
        }
        self.rows.remove(0);
    }

    /// Marks and units of the numbers in each column.
    fn take_styles(&mut self) {
        for (line, cells) in &self.rows {
            for ((cell, heading), style) in cells.iter().zip(&mut self.headings).zip(&mut self.styles) {
                if let Some(cell) = Cell::of(cell).filter(Cell::is_number) {
                    style.add(*line, &cell);
                    if heading.in_cells.is_none() && !cell.unit.is_empty() {
                        heading.in_cells = Some(cell.unit.to_owned());
                    }
                }
            }
        }
    }
}

/// What a separator makes of the rows at the top.
struct Top {
    separator: char,
    line: u64,
    names: Vec<String>,
    /// Whether the names are a row of numbers.
    without_names: bool,
    /// Rows before the first of measurements.
    before: usize,
    /// Whether there are rows of numbers, what the header names, and how many rows.
    serves: (bool, usize, usize),
}

impl Top {
    fn of(text: &str, separator: char, known: &dyn Fn(&[String]) -> usize) -> Option<Top> {
        let top: Vec<Row> = rows(text, separator).take(TOP).collect();
        let numbers = top.iter().filter(|(_, cells)| is_row_of_numbers(cells)).count();
        let first = top.iter().position(|(_, cells)| is_row_of_numbers(cells));
        let width = |at: usize| top[at].1.iter().filter(|cell| !cell.trim().is_empty()).count();
        let wide = first.map_or(0, width);
        // A title has few cells.
        let most = |&at: &usize| (2 * width(at) >= wide, known(&names(&top[at].1)));
        let header = (0..first.unwrap_or(top.len().min(1))).max_by_key(most);
        let (line, cells) = top.get(header.or(first)?)?;
        let names = names(cells);
        Some(Top {
            separator,
            line: *line,
            serves: (numbers > 0, known(&names), numbers),
            names,
            without_names: header.is_none(),
            before: header.map_or(0, |at| at + 1),
        })
    }
}

/// The cells of a line as names: without the mark of a comment before them.
pub fn names(cells: &csv::StringRecord) -> Vec<String> {
    let mut names: Vec<String> = cells.iter().map(|cell| cell.trim().to_owned()).collect();
    if let Some(first) = names.first_mut() {
        *first = first.trim_start_matches(['#', '%']).trim_start().to_owned();
    }
    names
}

/// Whether more than half of the cells that hold something are numbers, two at least.
fn is_row_of_numbers(cells: &csv::StringRecord) -> bool {
    let held = cells.iter().filter(|cell| !is_missing(cell)).count();
    let is_number = |cell: &&str| Cell::of(cell).is_some_and(|cell| cell.is_number());
    let numbers = cells.iter().filter(is_number).count();
    numbers >= 2 && 2 * numbers > held
}

/// Rows of cells with their lines; rows without any cell are passed over.
fn rows(text: &str, separator: char) -> Box<dyn Iterator<Item = Row> + '_> {
    if separator == ' ' {
        let rows = (1..).zip(text.lines().map(between_blanks));
        return Box::new(rows.filter(|(_, cells)| !cells.iter().all(is_blank)));
    }
    let mut builder = csv::ReaderBuilder::new();
    builder
        .delimiter(separator as u8)
        .flexible(true)
        .has_headers(false);
    let mut reader = builder.from_reader(text.as_bytes());
    let mut record = csv::StringRecord::new();
    let rows = std::iter::from_fn(move || {
        // The text is UTF-8 and rows may have any length: nothing is left to fail.
        matches!(reader.read_record(&mut record), Ok(true)).then(|| {
            // The reader stands behind the row's line end (where the row begins it does not know: it
            // skips blank lines silently). A quoted cell may span lines.
            let inner = record.as_slice().matches('\n').count();
            (reader.position().line() - 1 - inner as u64, record.clone())
        })
    });
    Box::new(rows.filter(|(_, cells)| !cells.iter().all(is_blank)))
}

/// Cells between tabs where there are any, else between blanks. A unit in brackets belongs to the name
/// before it, a comment's mark to the one behind it.
fn between_blanks(line: &str) -> csv::StringRecord {
    let mut cells: Vec<String> = Vec::new();
    let by_tabs = line.split('\t').filter(|_| line.contains('\t')).map(str::trim);
    let by_blanks = line.split_whitespace().filter(|_| !line.contains('\t'));
    for word in by_tabs.chain(by_blanks) {
        let open = |cell: &str| cell.matches(['(', '[']).count() > cell.matches([')', ']']).count();
        match cells.last_mut() {
            Some(last) if word.starts_with(['(', '[']) || open(last) || *last == "#" => {
                *last = format!("{last} {word}");
            }
            _ => cells.push(word.to_owned()),
        }
    }
    cells.into()
}
