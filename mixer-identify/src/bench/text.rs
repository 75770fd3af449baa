//! Bytes of a bench file to lines that the CSV reader counts rightly.
//!
//! Spreadsheets on old Macs end lines with a lone CR, Windows with CR LF; some tools begin with a
//! byte-order mark. [`Normalised`] turns every line end into LF and drops the mark while streaming,
//! so that line numbers in messages are those of an editor. Header names are decoded by [`decode`]:
//! UTF-8 if valid, else Latin-1, in which every byte is a character. Numbers are ASCII in both.

use std::io::{self, BufRead, Read};

/// A reader with LF line ends, also behind the last line, and no byte-order mark.
pub struct Normalised<R> {
    inner: R,
    at_start: bool,
    after_cr: bool,
    /// Whether the text so far ends in a line end (or is empty).
    line_ended: bool,
}

impl<R: BufRead> Normalised<R> {
    /// Wraps a reader at its beginning.
    pub fn new(inner: R) -> Self {
        Self {
            inner,
            at_start: true,
            after_cr: false,
            line_ended: true,
        }
    }
}

impl<R: BufRead> Read for Normalised<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if out.is_empty() {
            return Ok(0);
        }
        if std::mem::take(&mut self.at_start) {
            let head = self.inner.fill_buf()?;
            if head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]) {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "the file is UTF-16"));
            }
            let mark = if head.starts_with(&[0xef, 0xbb, 0xbf]) {
                3
            } else {
                0
            };
            self.inner.consume(mark);
        }
        loop {
            let source = self.inner.fill_buf()?;
            if source.is_empty() {
                // The last line gets its end, so that rows can be counted by their ends.
                if std::mem::replace(&mut self.line_ended, true) {
                    return Ok(0);
                }
                out[0] = b'\n';
                return Ok(1);
            }
            let taken = source.len().min(out.len());
            let mut written = 0;
            for &byte in &source[..taken] {
                let line_feed_of_pair = byte == b'\n' && self.after_cr;
                self.after_cr = byte == b'\r';
                if !line_feed_of_pair {
                    out[written] = if byte == b'\r' { b'\n' } else { byte };
                    written += 1;
                }
            }
            self.inner.consume(taken);
            if written > 0 {
                self.line_ended = out[written - 1] == b'\n';
                return Ok(written);
            }
        }
    }
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
    counts
        .into_iter()
        .rev()
        .max_by_key(|&(_, count)| count)
        .map_or(b',', |(mark, _)| mark)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normalised(bytes: &[u8], capacity: usize) -> String {
        let mut text = String::new();
        let reader = io::BufReader::with_capacity(capacity, bytes);
        Normalised::new(reader)
            .read_to_string(&mut text)
            .expect("valid text");
        text
    }

    #[test]
    fn every_line_end_becomes_a_line_feed() {
        // A buffer of four bytes cuts the pair CR LF in two.
        for capacity in [4, 5, 6, 7, 64] {
            assert_eq!(
                normalised(b"\xef\xbb\xbfa,b\r\n1,2\r3,4\n\r\n5", capacity),
                "a,b\n1,2\n3,4\n\n5\n"
            );
        }
    }

    #[test]
    fn utf16_is_named() {
        let error = Normalised::new(&b"\xff\xfea\0"[..])
            .read(&mut [0; 8])
            .unwrap_err();
        assert!(error.to_string().contains("UTF-16"));
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
