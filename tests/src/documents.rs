//! Tables in the documents that commands write: each stands between two comments of its page,
//! `<!-- table: NAME -->` and `<!-- end -->`.
//!
//! `cargo tables` writes them all; `tests/documents.rs` holds the pages to them.

mod flown;
mod sizes;
mod tables;

use std::path::{Path, PathBuf};

use csv::StringRecord;

use crate::root;

/// A table of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// The page, from the project's folder.
    pub page: &'static str,
    /// The name in the comment before it.
    pub name: &'static str,
    /// Its lines in Markdown, each ended.
    pub text: String,
}

/// All tables, from the airframes, `tests/counts.csv` and `tests/measurements/`.
///
/// # Errors
/// A file that cannot be read or is not what its command writes.
pub fn tables() -> Result<Vec<Table>, String> {
    let of = |page, name, text| Table { page, name, text };
    let mut tables = tables::keys();
    tables.extend([
        of("README.md", "flown", flown::flown()?),
        of("CONTRIBUTING.md", "sizes", sizes::sizes()?),
        of("docs/evaluation.md", "isolated", tables::isolated()?),
        of("docs/evaluation.md", "accuracy", tables::accuracy()?),
        of("docs/evaluation.md", "static", tables::static_comparison()?),
        of("docs/evaluation.md", "allocators", tables::allocators()?),
        of("docs/allocation.md", "yaw-reserve", tables::yaw_reserve()?),
        of("docs/allocation.md", "steep", tables::steep()?),
        of("docs/air.md", "altitudes", tables::altitudes()),
        of("docs/air.md", "density", tables::density()),
        of("docs/air.md", "level-thrust", tables::level_thrust()?),
        of("docs/flights.md", "drawn", flown::drawn()?),
        of("docs/flights.md", "ardupilot", flown::in_ardupilot()?),
        of("docs/flights.md", "betaflight", flown::in_betaflight()?),
        of("docs/flights.md", "px4-conditions", flown::conditions("px4")?),
        of("docs/flights.md", "px4-manoeuvres", flown::manoeuvres("px4")?),
        of(
            "docs/flights.md",
            "ardupilot-conditions",
            flown::conditions("ardupilot")?,
        ),
        of(
            "docs/flights.md",
            "ardupilot-manoeuvres",
            flown::manoeuvres("ardupilot")?,
        ),
        of("docs/flights.md", "hover", tables::hover()?),
        of("docs/flights.md", "tracking", tables::tracking()?),
    ]);
    Ok(tables)
}

/// The page's text with the table in its place.
///
/// # Errors
/// If the page has no such place.
pub fn filled(page: &str, table: &Table) -> Result<String, String> {
    let start = format!("<!-- table: {} -->\n", table.name);
    let fault = || format!("{}: no `{}` .. `{END}`", table.page, start.trim_end());
    let (before, rest) = page.split_once(&start).ok_or_else(fault)?;
    let (_, after) = rest.split_once(END).ok_or_else(fault)?;
    Ok(format!("{before}{start}\n{}\n{END}{after}", table.text))
}

const END: &str = "<!-- end -->";

/// Header and rows of a file in `tests/measurements/`, whose comments begin with `#`.
fn measured(path: &Path) -> Result<(StringRecord, Vec<StringRecord>), String> {
    let fault = |error: csv::Error| format!("{}: {error}", path.display());
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.comment(Some(b'#')).from_path(path).map_err(fault)?;
    let header = reader.headers().map_err(fault)?.clone();
    let rows: Result<_, _> = reader.into_records().collect();
    Ok((header, rows.map_err(fault)?))
}

/// All pages in Markdown under the project's folder, sorted; none of build folders.
///
/// # Errors
/// If a folder cannot be read.
pub fn pages() -> std::io::Result<Vec<PathBuf>> {
    let mut pages = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let path = entry.path();
            // Links are left out: `cargo-mixer/airframes` leads back to `airframes/`.
            let kind = entry.file_type()?;
            if kind.is_dir() {
                if name != "target" && !name.to_string_lossy().starts_with('.') {
                    folders.push(path);
                }
            } else if kind.is_file() && path.extension().is_some_and(|extension| extension == "md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    Ok(pages)
}
