//! Names that can be a Rust module, a Rust type and a file at once.

use std::path::Path;

use toml::Spanned;

use crate::diagnostic::source::Source;
use crate::diagnostic::{Code, Diagnostic, quoted};

/// Longest name, in characters.
const LONGEST: usize = 64;

/// Words that a Rust module or type cannot be called (keywords of all editions, the primitive types
/// and the crates that generated code refers to), and names that Windows keeps for devices.
const RESERVED: &[&str] = &[
    "abstract", "alloc", "as", "async", "aux", "await", "become", "bool", "box", "break", "char", "con",
    "const", "continue", "core", "crate", "do", "dyn", "else", "enum", "extern", "f32", "f64", "false",
    "final", "fn", "for", "gen", "i128", "i16", "i32", "i64", "i8", "if", "impl", "in", "isize", "let",
    "loop", "macro", "match", "mixer_rt", "mod", "move", "mut", "nul", "override", "priv", "prn", "pub",
    "ref", "return", "self", "static", "std", "str", "struct", "super", "trait", "true", "try", "type",
    "typeof", "u128", "u16", "u32", "u64", "u8", "unsafe", "unsized", "use", "usize", "virtual", "where",
    "while", "yield",
];

/// Constants of the generated module, which its type cannot be called.
#[rustfmt::skip]
const CONSTANTS: &[&str] = &[
    "ATTAINABLE", "CHANNELS", "INVERSE", "LEVEL", "PAIR", "SCALE", "TABLES", "UNITS", "VOLTAGE",
];

/// `isae-x8` as a Rust module: `isae_x8`.
pub(super) fn module(name: &str) -> String {
    name.replace('-', "_")
}

/// `isae-x8` as a Rust type: `IsaeX8`. Between digits the separator stays, so that `x-1-1` and
/// `x-11` differ.
pub(super) fn type_(name: &str) -> String {
    let mut type_name = String::with_capacity(name.len());
    for part in name.split(['-', '_']) {
        let mut letters = part.chars();
        if let Some(first) = letters.next() {
            if first.is_ascii_digit() && type_name.ends_with(|last: char| last.is_ascii_digit()) {
                type_name.push('_');
            }
            type_name.push(first.to_ascii_uppercase());
            type_name.extend(letters);
        }
    }
    type_name
}

/// As [`Airframe::names_if_refused`](super::Airframe::names_if_refused).
pub(super) fn if_refused(source: &Source) -> [String; 2] {
    let legal = |name: &str| check(&Spanned::new(0..0, name.to_string()), &mut Vec::new());
    let keys = source.text.parse::<toml::Table>().ok();
    let stated = keys.as_ref().and_then(|keys| legal(keys.get("name")?.as_str()?));
    let name = stated.unwrap_or_else(|| {
        let stem = Path::new(&source.name).file_stem().unwrap_or_default();
        of_file(&stem.to_string_lossy())
    });
    [module(&name), type_(&name)]
}

/// The name of an airframe whose file has this name, without folder and ending: the nearest legal one.
pub fn of_file(stem: &str) -> String {
    let name = mended(stem);
    let legal = check(&Spanned::new(0..0, name.clone()), &mut Vec::new());
    legal.unwrap_or_else(|| format!("{name}-x8"))
}

/// Lower-case letters and digits in parts joined by single `-` or `_`, from a letter on.
pub(super) fn check(name: &Spanned<String>, faults: &mut Vec<Diagnostic>) -> Option<String> {
    let text = name.get_ref();
    let fault = |message: String| Diagnostic::new(Code::Name, "name", name.span(), message);
    if RESERVED.contains(&module(text).as_str()) || CONSTANTS.contains(&type_(text).as_str()) {
        faults.push(
            fault(format!("the name {} is reserved", quoted(text)))
                .label("cannot be a module and a file")
                .help(format!("lengthen it, as in `{text}-x8`")),
        );
        return None;
    }
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    let reason = if text.is_empty() {
        "the name is empty".to_string()
    } else if text.chars().count() > LONGEST {
        format!(
            "the name has {} characters, more than {LONGEST}",
            text.chars().count()
        )
    } else if let Some(other) = text.chars().find(|&c| !legal(c) && !matches!(c, '-' | '_')) {
        format!("the name has the character {}", quoted(&other.to_string()))
    } else if !text.starts_with(|c: char| c.is_ascii_lowercase()) {
        "the name does not start with a letter".to_string()
    } else if text.split(['-', '_']).any(str::is_empty) {
        "the name has a `-` or `_` that does not join two parts".to_string()
    } else {
        return Some(text.clone());
    };
    faults.push(
        fault(reason)
            .label("becomes a Rust module, a type and a file")
            .help(format!(
                "lower-case letters, digits and single `-` or `_`: name = \"{}\"",
                mended(text)
            )),
    );
    None
}

/// The nearest legal name.
fn mended(text: &str) -> String {
    let lower = text.to_lowercase();
    let parts = lower.split(|c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit()));
    let mut name = parts
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join("-");
    if !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        name = if name.is_empty() {
            "my-x8".to_string()
        } else {
            format!("x-{name}")
        };
    }
    name.truncate(LONGEST);
    name.trim_end_matches('-').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legal(name: &str) -> bool {
        check(&Spanned::new(0..0, name.to_string()), &mut Vec::new()).is_some()
    }

    #[test]
    fn names_become_modules_and_types() {
        assert_eq!(
            (module("isae-x8").as_str(), type_("isae-x8").as_str()),
            ("isae_x8", "IsaeX8")
        );
        assert_eq!((module("y6_b").as_str(), type_("y6_b").as_str()), ("y6_b", "Y6B"));
        assert_ne!(type_("x-1-1"), type_("x-11"));
    }

    #[test]
    fn refused_files_are_named_after_their_airframe_or_themselves() {
        let names = |text: &str| if_refused(&Source::new("frames/My Y6.toml", text));
        assert_eq!(names("name = \"big-x8\"\nthrottle = 7"), ["big_x8", "BigX8"]);
        for unreadable in ["", "name = 8", "name = \"type\"", "name = \"big-x8\"\nthrottle ="] {
            assert_eq!(names(unreadable), ["my_y6", "MyY6"], "{unreadable}");
        }
        assert_eq!(if_refused(&Source::new("type.toml", "")), ["type_x8", "TypeX8"]);
    }

    #[test]
    fn names_are_checked_and_mended() {
        for name in ["x", "isae-x8", "a_b-c9"] {
            assert!(legal(name), "{name}");
        }
        let long = "x".repeat(65);
        for name in [
            "",
            "8x",
            "-x",
            "x-",
            "a--b",
            "X8",
            "x8 pro",
            "é",
            "type",
            "self",
            "u8",
            "mixer-rt",
            "con",
            "u-n-i-t-s",
            "p-a-i-r",
            &long,
        ] {
            assert!(!legal(name), "{name}");
        }
        for name in ["", "8x", "-x", "x-", "a--b", "X8", "x8 pro", "é", "飛", &long] {
            assert!(legal(&mended(name)), "{name} -> {}", mended(name));
        }
    }
}
