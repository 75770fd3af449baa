//! The text of an airframe file and the places in it.

use std::path::Path;

use super::wording::printable;

/// The text of an airframe file together with the path that its user knows it by.
#[derive(Clone, Debug, PartialEq, Eq)]
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

    /// The place of a byte offset. Offsets past the end or inside a character are moved back to the
    /// nearest character boundary.
    pub(crate) fn place(&self, offset: usize) -> Place {
        let before = &self.text[..self.boundary(offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            line: before.matches('\n').count() + 1,
            // A byte order mark is no character that a user could see or count.
            column: before[line_start..]
                .chars()
                .filter(|&c| c != BYTE_ORDER_MARK)
                .count()
                + 1,
        }
    }

    /// The places of ascending byte offsets, in one pass over the text; those of descending ones
    /// are found each by itself.
    pub(crate) fn places(&self, offsets: impl Iterator<Item = Option<usize>>) -> Vec<Option<Place>> {
        let mut counted = 0;
        let mut place = Place { line: 1, column: 1 };
        let mut next = |offset: usize| {
            let offset = self.boundary(offset);
            let Some(between) = self.text.get(counted..offset) else {
                return self.place(offset);
            };
            for c in between.chars() {
                match c {
                    '\n' => {
                        place = Place {
                            line: place.line + 1,
                            column: 1,
                        };
                    }
                    BYTE_ORDER_MARK => {}
                    _ => place.column += 1,
                }
            }
            counted = offset;
            place
        };
        offsets.map(|offset| offset.map(&mut next)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_from_one() {
        let source = Source::new("a.toml", "é = 1\r\nπρ = 2\n");
        assert_eq!(source.place(0), Place { line: 1, column: 1 });
        assert_eq!(source.place(3), Place { line: 1, column: 3 });
        assert_eq!(
            source.place(source.text.find('2').unwrap()),
            Place { line: 2, column: 6 }
        );
        // Inside the two bytes of `é`, and past the end.
        assert_eq!(source.place(1), Place { line: 1, column: 1 });
        assert_eq!(source.place(1000), Place { line: 3, column: 1 });
    }

    #[test]
    fn byte_order_mark_takes_no_column() {
        let source = Source::new("a.toml", "\u{feff}name = 1");
        assert_eq!(source.place(3), Place { line: 1, column: 1 });
    }
}
