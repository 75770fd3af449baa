//! The data of figures as CSV, in links that carry them.

use std::fmt::Write as _;

use maud::{Markup, html};
use mixer_compiler::diagnostic::printable;

use crate::report::bench::BenchPoints;
use crate::report::data::{self, Data};
use crate::report::effort::Effort;
use crate::report::figure::Figure;
use crate::report::study::Study;

/// Text of a link to the data of one figure.
const OF_THE_FIGURE: &str = "Data (CSV)";

/// The curves of a figure; `word` is the end of the file's name.
pub(super) fn curves(study: &Study<'_>, word: &str, figure: &Figure) -> Markup {
    html! { @if let Some(csv) = figure.csv() { (link(study, word, &csv, OF_THE_FIGURE)) } }
}

/// The file that `cargo mixer sweep` writes.
pub(super) fn sweep(study: &Study<'_>, of: Data) -> Markup {
    swept(study, of, OF_THE_FIGURE)
}

/// The same, of the figures above.
pub(super) fn sweep_of_all(study: &Study<'_>, of: Data) -> Markup {
    html! { p { (swept(study, of, "Data of these pictures (CSV)")) } }
}

fn swept(study: &Study<'_>, of: Data, text: &str) -> Markup {
    let word = if of.is_of_pair() {
        whose(study, of.word())
    } else {
        of.word().to_owned()
    };
    html! { @if let Ok(csv) = data::sweep(study, of) { (link(study, &word, &csv, text)) } }
}

/// What was measured of one effort at the bench points, and what the model has.
pub(super) fn bench(study: &Study<'_>, bench: &BenchPoints, effort: Effort) -> Markup {
    let word = whose(study, &format!("bench-{}", effort.word()));
    link(study, &word, &data::bench(bench, effort), OF_THE_FIGURE)
}

/// A word with the name of the pair, where it has one.
fn whose(study: &Study<'_>, word: &str) -> String {
    match study.name() {
        "" => word.to_owned(),
        name => format!("{word}-{}", printable(name)),
    }
}

fn link(study: &Study<'_>, word: &str, csv: &str, text: &str) -> Markup {
    let file = format!("{}-{word}.csv", printable(&study.compiled.airframe.name));
    let mut address = String::from("data:text/csv;charset=utf-8,");
    for byte in csv.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b',' | b'.' | b'-' | b'_' => {
                address.push(char::from(byte))
            }
            _ => {
                let _ = write!(address, "%{byte:02X}");
            }
        }
    }
    html! { a.data download=(file) href=(address) { (text) } }
}
