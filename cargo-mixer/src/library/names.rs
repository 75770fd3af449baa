//! Names that are no names of a C library.

use std::collections::BTreeMap;

use super::Airframe;

/// Headers that a program includes by these names: `M.h` would be found in their stead.
const HEADERS: &[&str] = &[
    "assert",
    "complex",
    "ctype",
    "errno",
    "fenv",
    "float",
    "inttypes",
    "iso646",
    "limits",
    "locale",
    "math",
    "setjmp",
    "signal",
    "stdalign",
    "stdarg",
    "stdatomic",
    "stdbool",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "stdnoreturn",
    "string",
    "strings",
    "tgmath",
    "threads",
    "time",
    "uchar",
    "unistd",
    "wchar",
    "wctype",
];

/// Libraries of every toolchain, `libM.a`.
const LIBRARIES: &[&str] = &["c", "dl", "g", "gcc", "m", "nosys", "pthread", "rt", "util"];

/// Targets that CMake keeps for itself.
const TARGETS: &[&str] = &["all", "clean", "edit_cache", "help", "install", "package", "test"];

/// What the shared header and its macros are called.
const SHARED: &[&str] = &["coaxial_mixer", "mixer"];

/// Whether every airframe can have a library, and one of its own.
pub(super) fn check(airframes: &[Airframe]) -> Result<(), String> {
    let mut files = BTreeMap::new();
    for Airframe { module, file, .. } in airframes {
        let taken = [
            (HEADERS, "a header of the C library"),
            (LIBRARIES, "a library of the C compiler"),
            (TARGETS, "a target of CMake"),
            (SHARED, "what all airframes share, coaxial_mixer.h"),
        ];
        if let Some((_, what)) = taken.iter().find(|(names, _)| names.contains(&module.as_str())) {
            return Err(format!(
                "{file}: the airframe's name gives `{module}`, which is {what}; call it {module}-x8 or the like"
            ));
        }
        if let Some(other) = files.insert(module, file) {
            return Err(format!(
                "{other} and {file} are both `{module}`: give one of them another name"
            ));
        }
    }
    Ok(())
}
