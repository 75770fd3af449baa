//! What a mix costs on the target: instructions, counted one by one by the `counts` image of
//! `tests/firmware`, and bytes of code, tables and stack.
//!
//! `tests/counts.csv` holds a [`Row`] per [`Subject`], `tests/worst.csv` the most expensive requests
//! that a search found for each ([`worst`]). Both are written by `cargo counts --bless` only;
//! the first begins with the compiler that built the firmware: another one gives other counts.

mod image;
mod subject;
pub mod worst;

use std::fmt;
use std::path::PathBuf;

pub use image::Images;
pub use subject::{Subject, all, compared};

use crate::root;

/// What one subject costs. Instructions of all requests of a set (`_sum`), of its middle
/// one (`_median`) and of its most expensive (`_worst`), bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Whose cost.
    pub subject: Subject,
    /// Name and value, in the order of [`COLUMNS`].
    pub values: [u64; COLUMNS.len()],
}

/// Names of a [`Row`]'s values. `attainable` and `saturated` are sets of as many `requests` each,
/// drawn by `mixer_setpoints::Requests`; `worst_found` is the most that any request took, of these
/// sets and of those that a search has found.
pub const COLUMNS: [&str; 10] = [
    "code_b",
    "tables_b",
    "stack_b",
    "requests",
    "attainable_sum",
    "attainable_median",
    "attainable_worst",
    "saturated_sum",
    "saturated_worst",
    "worst_found",
];

impl Row {
    /// The value of a column.
    pub fn get(&self, column: &str) -> u64 {
        let index = COLUMNS.iter().position(|name| *name == column);
        index.map_or(0, |index| self.values[index])
    }

    /// Mean over the set `attainable` or `saturated`.
    pub fn mean(&self, set: &str) -> f64 {
        self.get(&format!("{set}_sum")) as f64 / self.get("requests") as f64
    }

    fn parse(line: &str) -> Option<Row> {
        let cells: Vec<&str> = line.split(',').collect();
        let [mixer, airframe, values @ ..] = &cells[..] else {
            return None;
        };
        let values: Vec<u64> = values
            .iter()
            .map(|cell| cell.parse().ok())
            .collect::<Option<_>>()?;
        Some(Row {
            subject: Subject::new(mixer, airframe),
            values: values.try_into().ok()?,
        })
    }
}

/// One line of CSV.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = self.values.map(|value| value.to_string()).join(",");
        write!(f, "{},{},{values}", self.subject.mixer, self.subject.airframe)
    }
}

/// The file of the counts.
pub fn file() -> PathBuf {
    root().join("tests/counts.csv")
}

/// The text of the file: the compiler, the header, the rows.
pub fn text(compiler: &str, rows: &[Row]) -> String {
    let rows: String = rows.iter().map(|row| format!("{row}\n")).collect();
    format!("# {compiler}\nmixer,airframe,{}\n{rows}", COLUMNS.join(","))
}

/// The compiler and the rows of the file.
///
/// # Errors
/// If it cannot be read or is not what [`text`] writes.
pub fn held() -> Result<(String, Vec<Row>), String> {
    let path = file();
    let fault = |what: &str| format!("{}: {what}", path.display());
    let text = std::fs::read_to_string(&path).map_err(|e| fault(&e.to_string()))?;
    let mut lines = text.lines();
    let compiler = lines.next().and_then(|line| line.strip_prefix("# "));
    let header = format!("mixer,airframe,{}", COLUMNS.join(","));
    if lines.next() != Some(&header) {
        return Err(fault("not the expected header"));
    }
    let rows: Option<Vec<Row>> = lines.map(Row::parse).collect();
    match (compiler, rows) {
        (Some(compiler), Some(rows)) => Ok((compiler.to_owned(), rows)),
        _ => Err(fault("not counts")),
    }
}

/// The page of the counts.
pub fn page() -> PathBuf {
    root().join("docs/costs.md")
}

/// Whether the page has the row: every mixer of the paper's X8, and what other frames and airmodes cost.
fn is_shown(row: &&Row) -> bool {
    let Subject { mixer, airframe, .. } = &row.subject;
    match airframe.as_str() {
        "isae-x8" => true,
        "px4-y6" | "px4-x12" => matches!(mixer.as_str(), "coaxial" | "one-rotor-out" | "dynamic"),
        "roll-pitch-yaw" | "x8-16in-quartic" | "x8-22-16in" | "y4" | "hexa-stacked" => mixer == "coaxial",
        _ => false,
    }
}

/// The text of that page.
pub fn document(compiler: &str, rows: &[Row]) -> String {
    let mut text = format!(
        "# Costs\n\nWhat a mix costs on a Cortex-M4F: instructions, counted in QEMU with firmware of {compiler}, and bytes of an image that \
         holds this mixer only. `tests/counts.csv` has all rows, by `cargo counts`; this page is written by `cargo counts --page`.\n\n\
         * attainable: 2,000 wrenches that random throttles give, at random voltages\n\
         * saturated: 2,000 requests up to four times the authority, one axis alone, on and beyond the border\n\
         * worst found: the largest count of these and of a search of {} billion instructions on the target. For a guaranteed bound see \
         `cargo mixer check`\n\n\
         `coaxial` is this mixer, `c-interface` its library for C, `dynamic` its `mix_dynamic`, `one-rotor-out` and `two-rotors-out` its `mix_with_health` with \
         random rotors out (\"attainable\" is with all rotors). `conventional` (the paper's), `sequential` (after PX4) and `wls` (the \
         crate `wls-alloc`) take rotors as isolated. `roll-pitch-yaw` is the paper's X8 with that airmode.\n\n\
         | mixer | airframe | attainable, mean | saturated, mean | worst found | code | tables | stack |\n\
         |---|---|---:|---:|---:|---:|---:|---:|\n",
        worst::BUDGET / 1_000_000_000
    );
    for row in rows.iter().filter(is_shown) {
        text.push_str(&format!(
            "| {} | {} | {:.0} | {:.0} | {} | {} | {} | {} |\n",
            row.subject.mixer,
            row.subject.airframe,
            row.mean("attainable"),
            row.mean("saturated"),
            row.get("worst_found"),
            row.get("code_b"),
            row.get("tables_b"),
            row.get("stack_b"),
        ));
    }
    text
}
