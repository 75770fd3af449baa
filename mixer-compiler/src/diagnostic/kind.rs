//! Files that were meant for something else, by their content.

/// The beginning of a zip archive, which documents of offices are, too.
const ARCHIVE: &[u8] = b"PK\x03\x04";

/// Names in such an archive, and what it is.
const DOCUMENTS: [(&[u8], &str); 4] = [
    (b"xl/", "a workbook (.xlsx, .ods)"),
    (b"opendocument.spreadsheet", "a workbook (.xlsx, .ods)"),
    (b"word/", "a text document (.docx, .odt)"),
    (b"opendocument.text", "a text document (.docx, .odt)"),
];

/// Beginnings of files, and what these are.
const BEGINNINGS: [(&[u8], &str); 9] = [
    (ARCHIVE, "a packed file (unpack it first)"),
    (b"\xd0\xcf\x11\xe0", "a workbook (.xls)"),
    (b"%PDF", "a PDF document"),
    (b"{", "JSON"),
    (b"[{", "JSON"),
    (b"<", "a page of HTML or XML"),
    (b"ULog", "a flight log, which cargo mixer review reads"),
    (b"\xa3\x95", "a flight log, which cargo mixer review reads"),
    (b"\xfd7zXZ", "a packed file (unpack it first)"),
];

/// Words of parameter files that say which rotors there are.
pub const PARAMETERS: [&str; 3] = ["CA_ROTOR", "FRAME_CLASS", "mmix"];

/// The kind of a file that is neither a table of text nor TOML, by its beginning; `None` where that does not tell.
#[must_use]
pub fn foreign(bytes: &[u8]) -> Option<&'static str> {
    let bytes = bytes.trim_ascii_start();
    let holds = |name: &[u8]| bytes.windows(name.len()).any(|part| part == name);
    let document = DOCUMENTS
        .iter()
        .find(|(name, _)| bytes.starts_with(ARCHIVE) && holds(name));
    let known = document.or_else(|| BEGINNINGS.iter().find(|(begin, _)| bytes.starts_with(begin)));
    known.map(|(_, what)| *what)
}

/// The kind of a text that is no airframe file.
pub(crate) fn of_text(text: &str) -> &'static str {
    let first = text
        .lines()
        .find(|line| !line.trim().is_empty())
        .unwrap_or_default();
    match foreign(text.as_bytes()) {
        Some(what) => what,
        None if PARAMETERS.iter().any(|word| text.contains(word)) => {
            "a parameter file, which cargo mixer import reads"
        }
        None if first.contains([',', ';', '\t']) => {
            "a table: cargo mixer identify reads the bench file of a pair, cargo mixer predict the run of one rotor"
        }
        None => "a text of another kind",
    }
}
