//! Bytes of a bench file to text whose lines are those of an editor.
//!
//! Spreadsheets on old Macs end lines with a lone CR, Windows with CR LF; some tools begin with a
//! byte-order mark; "Unicode text" of spreadsheets is UTF-16. A line that is not UTF-8 is Latin-1, in
//! which every byte is a character. Blanks and signs that spreadsheets put into numbers become ASCII.

/// Beginnings of files that are no text, what they are, and the way out.
const FOREIGN: [(&[u8], &str, &str); 12] = [
    (b"PK\x03\x04", "a workbook (.xlsx, .ods) or a zip archive", SAVE),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook (.xls)", SAVE),
    (b"%PDF", "a PDF document", COPY),
    (b"{\\rtf", "a document of a word processor", COPY),
    (b"\x89PNG", "a picture", COPY),
    (b"\xff\xd8\xff", "a picture", COPY),
    (b"\x1f\x8b", "a compressed file (gzip)", "the unpacked file"),
    (b"\xfd7zXZ", "a compressed file (xz)", "the unpacked file"),
    (
        b"MATLAB",
        "a MATLAB file (.mat)",
        "the table as CSV, as by writetable",
    ),
    (
        b"\x89HDF",
        "an HDF5 or MATLAB file",
        "the table as CSV, as by writetable or to_csv",
    ),
    (b"ULog", "a flight log (ULog)", OF_FLIGHT),
    (b"\xa3\x95", "a flight log (DataFlash)", OF_FLIGHT),
];
const SAVE: &str = "the sheet with the measurements, saved as CSV (File, Save As)";
const COPY: &str = "the table copied into a CSV file";
const OF_FLIGHT: &str = "a run on a bench; logs of flights are read by cargo mixer review";

/// What a file is that is no table of text, and what would serve.
pub fn foreign(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    let known = FOREIGN.iter().find(|(begins, ..)| bytes.starts_with(begins));
    if let Some((_, what, needed)) = known {
        return Some((what, needed));
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(20_000)]);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let lines = || text.lines().map(str::trim);
    let is_table = |line: &str| {
        line.starts_with('[')
            && line.ends_with(']')
            && !line.contains([',', ';', '\t', '{'])
            && line.len() > 4
    };
    let of_airframe = |line: &str| matches!(line, "[pair]" | "[throttle]" | "[[unit]]" | "[layout]");
    let (from_the_table, csv) = ("the table in it as CSV", "a CSV file of measurements");
    match text.chars().next()? {
        '{' => Some(("JSON", from_the_table)),
        '[' if text[1..].trim_start().starts_with(['{', '[']) && !is_table(lines().next()?) => {
            Some(("JSON", from_the_table))
        }
        '<' => Some(("a page of HTML or XML", from_the_table)),
        _ if lines().any(of_airframe) => Some(("an airframe file (TOML)", csv)),
        _ => {
            let assigns = |line: &str| {
                line.split_once(" = ")
                    .is_some_and(|(key, _)| !key.contains([' ', ',']))
            };
            let first = lines().find(|line| !line.is_empty() && !line.starts_with('#'))?;
            let begins = is_table(first) || assigns(first);
            (begins && lines().any(is_table)).then_some(("a file of keys and values (TOML, INI)", csv))
        }
    }
}

/// The text with LF line ends, also behind the last line, and no byte-order mark.
///
/// # Errors
/// What cannot be read as text.
pub fn normalised(bytes: &[u8]) -> Result<String, &'static str> {
    let utf16 = utf16(bytes);
    let bytes = utf16.as_ref().map_or(bytes, String::as_bytes);
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut lines = Vec::with_capacity(bytes.len() + 1);
    let mut before = 0;
    for &byte in bytes {
        match (before, byte) {
            (b'\r', b'\n') => {}
            (_, b'\r') => lines.push(b'\n'),
            _ => lines.push(byte),
        }
        before = byte;
    }
    if lines.last().is_some_and(|byte| *byte != b'\n') {
        lines.push(b'\n');
    }
    if lines[..lines.len().min(1000)].contains(&0) {
        return Err("it holds zero bytes and is no text");
    }
    let mut text = String::with_capacity(lines.len());
    for line in lines.split_inclusive(|byte| *byte == b'\n') {
        match std::str::from_utf8(line) {
            Ok(line) if line.is_ascii() => text.push_str(line),
            Ok(line) => text.extend(line.chars().map(plain)),
            Err(_) => text.extend(line.iter().map(|&byte| plain(char::from(byte)))),
        }
    }
    Ok(text)
}

/// Blanks, apostrophes and the minus of typesetters, as spreadsheets put them into numbers.
fn plain(c: char) -> char {
    match c {
        '\u{a0}' | '\u{2007}' | '\u{2009}' | '\u{202f}' => ' ',
        '\u{2019}' => '\'',
        '\u{2212}' => '-',
        '\u{ff08}' => '(',
        '\u{ff09}' => ')',
        c => c,
    }
}

/// The text of UTF-16, with its mark or with a zero beside each of the first characters.
fn utf16(bytes: &[u8]) -> Option<String> {
    let zeros = |odd: usize| {
        let first = bytes.get(..16)?;
        Some(
            first
                .iter()
                .enumerate()
                .all(|(k, byte)| (k % 2 == odd) == (*byte == 0)),
        )
    };
    let from: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ if zeros(1)? => u16::from_le_bytes,
        _ if zeros(0)? => u16::from_be_bytes,
        _ => return None,
    };
    let units = bytes.chunks_exact(2).map(|pair| from([pair[0], pair[1]]));
    let text = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    Some(text.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end_becomes_a_line_feed() {
        let text = normalised(b"\xef\xbb\xbfa,b\r\n1,2\r3,4\n\r\n5").expect("text");
        assert_eq!(text, "a,b\n1,2\n3,4\n\n5\n");
    }

    #[test]
    fn encodings_give_one_text() {
        let text = "ESC (\u{b5}s);Thrust\r\n1500;8,5\r\n";
        let units = || text.encode_utf16();
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
        let marked = [&[0xff, 0xfe], little.as_slice()].concat();
        for bytes in [little, big, latin1, marked, text.into()] {
            assert_eq!(
                normalised(&bytes).expect("text"),
                "ESC (\u{b5}s);Thrust\n1500;8,5\n"
            );
        }
        assert_eq!(
            normalised("1\u{202f}234;\u{2212}5".as_bytes()),
            Ok("1 234;-5\n".into())
        );
    }

    #[test]
    fn files_of_other_kinds_are_named() {
        for (bytes, what) in [
            (&b"PK\x03\x04\x14"[..], "workbook"),
            (b"%PDF-1.7", "PDF"),
            (b" {\"a\": 1}", "JSON"),
            (b"[{\"a\": 1}]", "JSON"),
            (b"<!DOCTYPE html>", "HTML"),
            (
                b"# by hand\nname = \"x\"\n[throttle]\nmin = 0.1\n",
                "an airframe file",
            ),
            (b"[motor]\nkv = 400\n", "keys and values"),
        ] {
            assert!(
                foreign(bytes).is_some_and(|(told, _)| told.contains(what)),
                "{what}"
            );
        }
        for csv in [
            "upper,lower\n1,2\n",
            "[s],[N]\n",
            "# a = 1\nthrottle,thrust_n\n",
            "",
        ] {
            assert_eq!(foreign(csv.as_bytes()), None, "{csv}");
        }
    }
}
