//! The object: what it must and must not name, and the archive around it.

use object::{BinaryFormat, Object, ObjectSymbol};

/// Symbols of an object that others see or must have.
#[derive(Debug, Default)]
pub(crate) struct Symbols {
    pub(crate) undefined: Vec<String>,
    global: Vec<String>,
}

impl Symbols {
    /// Of an ELF file.
    pub(crate) fn of(bytes: &[u8]) -> Result<Self, String> {
        let file = object::File::parse(bytes).map_err(|error| error.to_string())?;
        if file.format() != BinaryFormat::Elf {
            return Err("is no ELF file; libraries are made for bare metal and Linux".to_owned());
        }
        let mut symbols = Symbols::default();
        for symbol in file.symbols() {
            let name = symbol.name().map_err(|error| error.to_string())?.to_owned();
            if symbol.is_undefined() && !name.is_empty() {
                symbols.undefined.push(name);
            } else if symbol.is_global() && !symbol.is_undefined() {
                symbols.global.push(name);
            }
        }
        Ok(symbols)
    }

    /// Whether the object has `functions` as its only global symbols and needs nothing but what
    /// `is_linked` with it.
    pub(crate) fn check(&self, functions: &[String], is_linked: impl Fn(&str) -> bool) -> Result<(), String> {
        let needed = self.undefined.iter().map(String::as_str);
        let needed: Vec<&str> = needed.filter(|name| !is_linked(name)).collect();
        if !needed.is_empty() {
            return Err(format!("needs {}", needed.join(", ")));
        }
        let is_one = |name: &String| functions.contains(name);
        if self.global.len() != functions.len() || !self.global.iter().all(is_one) {
            let [global, functions] = [&self.global, functions].map(|names| names.join(", "));
            return Err(format!("defines {global}, not {functions} alone"));
        }
        Ok(())
    }
}

/// An object of a library.
pub(crate) struct Member {
    /// Its name in the archive.
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
    /// The functions that it defines.
    pub(crate) functions: Vec<String>,
}

/// A static library as GNU's and LLVM's linkers read it, its index of the members' functions
/// included. Without times, owners or folders: the same objects give the same bytes.
pub(crate) fn archive(members: &[Member]) -> Result<Vec<u8>, String> {
    // Names that do not fit a member's header stand in a member of their own, by their places in
    // it.
    let (mut long_names, mut names) = (String::new(), Vec::new());
    for Member { name, .. } in members {
        if name.len() < NAME {
            names.push(format!("{name}/"));
        } else {
            names.push(format!("/{}", long_names.len()));
            long_names += &format!("{name}/\n");
        }
    }
    let (mut rest, mut places) = (Vec::new(), Vec::new());
    if !long_names.is_empty() {
        append(&mut rest, "//", long_names.as_bytes());
    }
    for (Member { bytes, functions, .. }, name) in members.iter().zip(&names) {
        places.extend(functions.iter().map(|_| rest.len()));
        append(&mut rest, name, bytes);
    }
    let functions = members.iter().flat_map(|member| &member.functions);
    let functions: Vec<u8> = functions.flat_map(|name| name.bytes().chain([0])).collect();
    let index_bytes = 4 + 4 * places.len() + functions.len();
    let first = MAGIC.len() + HEADER + index_bytes.next_multiple_of(2);
    let mut index = Vec::new();
    for number in std::iter::once(places.len()).chain(places.iter().map(|place| first + place)) {
        let number = u32::try_from(number).map_err(|_| "the library is over 4 GB")?;
        index.extend(number.to_be_bytes());
    }
    index.extend(functions);
    let mut archive = MAGIC.to_vec();
    append(&mut archive, "/", &index);
    archive.extend(rest);
    Ok(archive)
}

const MAGIC: &[u8] = b"!<arch>\n";
/// Length of a member's header.
const HEADER: usize = 60;
/// Length of the name in it, the `/` at its end included.
const NAME: usize = 16;

/// A member with its header and padding.
fn append(archive: &mut Vec<u8>, name: &str, bytes: &[u8]) {
    let size = bytes.len();
    archive.extend(format!("{name:<16}{:<12}{:<6}{:<6}{:<8}{size:<10}`\n", 0, 0, 0, 644).bytes());
    archive.extend(bytes);
    if size % 2 == 1 {
        archive.push(b'\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(name: &str, bytes: &[u8], functions: &[&str]) -> Member {
        Member {
            name: name.to_owned(),
            bytes: bytes.to_vec(),
            functions: functions.iter().map(|&name| name.to_owned()).collect(),
        }
    }

    #[test]
    fn archives_have_an_index_and_long_names() {
        let members = [
            member("a.o", &[1, 2, 3], &["a_mix", "b"]),
            member("a_name_beyond_fifteen.o", &[4, 5], &["c"]),
        ];
        let bytes = archive(&members).unwrap();
        assert!(bytes.starts_with(b"!<arch>\n/               0 "));
        // Magic; index of 26 bytes; names of 25; the members.
        let first = 8 + (60 + 26) + (60 + 26);
        let places = [0, 0, 0, 3, 0, 0, 0, first, 0, 0, 0, first, 0, 0, 0, first + 64];
        assert_eq!(bytes[68..84], places);
        assert_eq!(&bytes[84..94], b"a_mix\0b\0c\0");
        assert!(bytes[usize::from(first)..].starts_with(b"a.o/ "));
        assert!(bytes[usize::from(first) + 64..].starts_with(b"/0 "));
        assert_eq!(bytes.len(), usize::from(first) + 64 + 62);
    }

    #[test]
    fn objects_of_others_are_refused() {
        let this_test = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let symbols = Symbols::of(&this_test).unwrap();
        assert!(
            symbols
                .check(&["x_mix".to_owned()], |_| false)
                .unwrap_err()
                .starts_with("needs ")
        );
        assert!(Symbols::of(b"no object").is_err());
    }
}
