//! The text of an airframe file and the places in it.

use std::path::Path;

use super::wording::printable;

/// The text of an airframe file together with the path that its user knows it by.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Source {
    /// Path as shown to the user, with whatever base the caller finds helpful.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// A place in a text, as editors and compilers count it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters (not bytes), from 1.
    pub column: usize,
}

impl Source {
    /// A source from a path to show, of which what does not print is escaped, and a text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            name: printable(&name.into()),
            text: text.into(),
        }
    }

    /// The name of the file without its folder: what is emitted depends on no place.
    pub fn file_name(&self) -> String {
        let path = Path::new(&self.name);
        let name = path.file_name().unwrap_or(path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// The place of a byte offset. One past the end or inside a character is moved back to the nearest character boundary.
    pub(crate) fn place(&self, offset: usize) -> Place {
        let before = &self.text[..self.boundary(offset)];
        let line = before.rsplit('\n').next().unwrap_or_default();
        Place {
            line: 1 + before.matches('\n').count(),
            // The mark is no character that a user could see or count.
            column: 1 + line.chars().filter(|c| *c != BYTE_ORDER_MARK).count(),
        }
    }

    /// The nearest character boundary at or before `offset`.
    pub(crate) fn boundary(&self, offset: usize) -> usize {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }
}

/// Some editors put it before the first character of a file.
pub(crate) const BYTE_ORDER_MARK: char = '\u{feff}';

/// The text of UTF-16 with its byte-order mark, as Windows saves "Unicode text" and what `>` of its older shells
/// writes; `None` of bytes that do not begin with the mark.
#[must_use]
pub fn utf16(bytes: &[u8]) -> Option<String> {
    let from: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let units = bytes.chunks_exact(2).map(|pair| from([pair[0], pair[1]]));
    let text = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    Some(text.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines and columns of ascending offsets.
    fn places(text: &str, offsets: &[usize]) -> Vec<(usize, usize)> {
        let source = Source::new("a.toml", text);
        let places = offsets.iter().map(|offset| source.place(*offset));
        places.map(|place| (place.line, place.column)).collect()
    }

    #[test]
    fn places_count_characters_from_one() {
        let text = "é = 1\r\nπρ = 2\n";
        // Inside the two bytes of `é`, and past the end.
        let offsets = [0, 1, 3, text.find('2').unwrap(), 1000];
        assert_eq!(places(text, &offsets), [(1, 1), (1, 1), (1, 3), (2, 6), (3, 1)]);
    }

    #[test]
    fn byte_order_mark_takes_no_column() {
        assert_eq!(places("\u{feff}name = 1", &[3]), [(1, 1)]);
    }

    #[test]
    fn utf_16_is_read_by_its_mark() {
        let units = || "\u{feff}name = \"π\"".encode_utf16();
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        for bytes in [little, big, "\u{feff}name = \"π\"".into()] {
            let source = Source::from_bytes("a.toml", bytes).unwrap();
            assert_eq!(source.text, "\u{feff}name = \"π\"");
        }
    }
}
