//! Bytes of a bench file to lines that the CSV reader counts rightly.
//!
//! Spreadsheets on old Macs end lines with a lone CR, Windows with CR LF; some tools begin with a
//! byte-order mark. [`normalised`] turns every line end into LF and drops the mark, so that line
//! numbers in messages are those of an editor. Header names are decoded by [`decode`]: UTF-8 if
//! valid, else Latin-1, in which every byte is a character. Numbers are ASCII in both.

/// The text with LF line ends, also behind the last line, and no byte-order mark.
///
/// # Errors
/// What cannot be read as text.
pub fn normalised(bytes: &[u8]) -> Result<Vec<u8>, &'static str> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("the file is UTF-16");
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut text = Vec::with_capacity(bytes.len() + 1);
    let mut before = 0;
    for &byte in bytes {
        match (before, byte) {
            (b'\r', b'\n') => {}
            (_, b'\r') => text.push(b'\n'),
            _ => text.push(byte),
        }
        before = byte;
    }
    if text.last().is_some_and(|byte| *byte != b'\n') {
        text.push(b'\n');
    }
    Ok(text)
}

/// UTF-8 if it is, else Latin-1.
pub fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// The separator of a header line: of `,` `;` and tab, outside quotes, the most frequent.
pub fn separator(header: &[u8]) -> u8 {
    let mut quoted = false;
    let mut counts = [(b',', 0), (b';', 0), (b'\t', 0)];
    for &byte in header {
        quoted ^= byte == b'"';
        for (mark, count) in &mut counts {
            *count += usize::from(!quoted && byte == *mark);
        }
    }
    // On a tie the first of the list: max_by_key would give the last.
    let most = counts.into_iter().rev().max_by_key(|&(_, count)| count);
    most.map_or(b',', |(mark, _)| mark)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end_becomes_a_line_feed() {
        let text = normalised(b"\xef\xbb\xbfa,b\r\n1,2\r3,4\n\r\n5").expect("text");
        assert_eq!(text, b"a,b\n1,2\n3,4\n\n5\n");
    }

    #[test]
    fn utf16_is_named() {
        assert!(normalised(b"\xff\xfea\0").unwrap_err().contains("UTF-16"));
    }

    #[test]
    fn separators_are_counted_outside_quotes() {
        assert_eq!(separator(b"a,b,c"), b',');
        assert_eq!(separator(b"a;b (1,2);c"), b';');
        assert_eq!(separator(b"\"a,b,c\";d"), b';');
        assert_eq!(separator(b"a\tb"), b'\t');
        assert_eq!(separator(b"alone"), b',');
    }

    #[test]
    fn latin1_is_the_fallback() {
        assert_eq!(decode(b"ESC (\xb5s)"), "ESC (µs)");
        assert_eq!(decode("ESC (µs)".as_bytes()), "ESC (µs)");
    }
}
