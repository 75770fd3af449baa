//! Golden outputs of `airframes/`, held in `tests/golden/` as a user's are, but for most of the generated Rust.
//!
//! `cargo mixer golden airframes/*.toml -o tests/golden` writes them and nothing else does.

use std::collections::BTreeMap;
use std::path::PathBuf;

use mixer_compiler::{Compiled, Source};

use crate::{airframes, root};

/// The folder of the golden outputs.
pub fn folder() -> PathBuf {
    root().join("tests/golden")
}

/// Compiles `airframes/<name>.toml`.
///
/// # Errors
/// The file cannot be read or is refused.
pub fn compile(name: &str) -> Result<Compiled, String> {
    let path = format!("airframes/{name}.toml");
    mixer_compiler::compile(&Source::new(path, text(name)?)).map_err(|faults| faults.to_string())
}

/// The text of `airframes/<name>.toml`.
///
/// # Errors
/// The file cannot be read.
pub fn text(name: &str) -> Result<String, String> {
    let path = format!("airframes/{name}.toml");
    std::fs::read_to_string(root().join(&path)).map_err(|error| format!("{path}: {error}"))
}

/// The golden outputs of all airframes: file name and content.
///
/// # Errors
/// As [`compile`].
pub fn outputs() -> Result<BTreeMap<String, String>, String> {
    let mut outputs = BTreeMap::new();
    for name in airframes().map_err(|error| format!("airframes/: {error}"))? {
        outputs.extend(mixer_files::golden::outputs(&compile(&name)?));
    }
    Ok(outputs)
}
