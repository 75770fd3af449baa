//! Bytes of a bench file to text whose lines are those of an editor.
//!
//! Spreadsheets on old Macs end lines with a lone CR, Windows with CR LF; some tools begin with a
//! byte-order mark; "Unicode text" of spreadsheets is UTF-16. A line that is not UTF-8 is Latin-1, in
//! which every byte is a character. Blanks and signs that spreadsheets put into numbers become ASCII.

use mixer_compiler::diagnostic::content::foreign;
use mixer_compiler::diagnostic::utf16;

use crate::refusal::Refusal;

/// The text of the file `name` with LF line ends, also behind the last line, and no byte-order mark.
///
/// # Errors
/// What is no text.
pub fn normalised(name: &str, bytes: &[u8]) -> Result<String, Refusal> {
    let foreign = foreign(bytes);
    let utf16 = utf16(bytes);
    let bytes = utf16.as_ref().map_or(bytes, String::as_bytes);
    let what = match foreign {
        Some(what) => what,
        None if name.ends_with(".toml") => "a TOML file",
        // Other binary files hold zero bytes.
        None if bytes[..bytes.len().min(1000)].contains(&0) => "no text",
        None => {
            let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            let mut text = String::with_capacity(bytes.len() + 1);
            for line in bytes.split_inclusive(|byte| *byte == b'\n') {
                match std::str::from_utf8(line) {
                    Ok(line) => text.extend(line.chars().map(plain)),
                    Err(_) => text.extend(line.iter().map(|&byte| plain(char::from(byte)))),
                }
            }
            if !text.is_empty() && !text.ends_with(['\n', '\r']) {
                text.push('\n');
            }
            return Ok(text.replace("\r\n", "\n").replace('\r', "\n"));
        }
    };
    Err(Refusal::of(
        name,
        format!("this is {what}, no CSV file"),
        "the table with the measurements, saved as CSV (in a spreadsheet: File, Save As)",
    ))
}

/// Blanks, apostrophes, brackets and the minus of typesetters.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> Result<String, String> {
        normalised("b.csv", bytes).map_err(|refusal| refusal.reason)
    }

    #[test]
    fn every_line_end_becomes_a_line_feed() {
        let text = text(b"\xef\xbb\xbfa,b\r\n1,2\r3,4\n\r\n5");
        assert_eq!(text, Ok("a,b\n1,2\n3,4\n\n5\n".into()));
    }

    #[test]
    fn encodings_give_one_text() {
        let wanted = "ESC (\u{b5}s);Thrust\n1500;8,5\n";
        let units = || "\u{feff}ESC (\u{b5}s);Thrust\r\n1500;8,5".encode_utf16();
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        let latin1 = b"ESC (\xb5s);Thrust\r\n1500;8,5".to_vec();
        for bytes in [little, big, latin1, "ESC (\u{b5}s);Thrust\r\n1500;8,5".into()] {
            assert_eq!(text(&bytes).as_deref(), Ok(wanted));
        }
        assert_eq!(text("1\u{202f}234;\u{2212}5".as_bytes()), Ok("1 234;-5\n".into()));
    }

    #[test]
    fn files_of_other_kinds_are_named() {
        for (bytes, what) in [
            (&b"PK\x03\x04\x14\x00xl/workbook.xml"[..], "workbook"),
            (b"PK\x03\x04\x14\x00word/document.xml", "text document"),
            (b"PK\x03\x04\x14", "packed file"),
            (b"%PDF-1.7", "PDF"),
            (b" {\"a\": 1}", "JSON"),
            (b"[{\"a\": 1}]", "JSON"),
            (b"<!DOCTYPE html>", "HTML"),
            (b"ULog\x01\x00", "a flight log"),
            (b"ab\x01\x00", "no text"),
        ] {
            assert!(text(bytes).is_err_and(|told| told.contains(what)), "{what}");
        }
        for csv in [
            "upper,lower\n1,2\n",
            "[s],[N]\n",
            "# a = 1\nthrottle,thrust_n\n",
            "",
        ] {
            assert_eq!(text(csv.as_bytes()), Ok(csv.to_owned()));
        }
    }
}
