//! Golden outputs: what is held per airframe in `tests/golden/`, and how it is made.
//!
//! `<name>.rs` is the generated Rust, `<name>.report.txt` the report, `<name>.vectors.csv` setpoints with the bits
//! that the mixer gives. They are written by `cargo run -p mixer-tests --bin bless` only.

use std::path::PathBuf;

use cargo_mixer::golden::table;
use mixer_compiler::report::Report;
use mixer_compiler::{Compiled, Source};

use crate::{root, vectors};

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
    let text = std::fs::read_to_string(root().join(&path)).map_err(|error| format!("{path}: {error}"))?;
    mixer_compiler::compile(&Source::new(path, text)).map_err(|faults| faults.to_string())
}

/// The golden outputs of one airframe: file name and content.
///
/// # Errors
/// As [`compile`].
pub fn outputs(name: &str) -> Result<Vec<(String, String)>, String> {
    let compiled = compile(name)?;
    Ok(vec![
        (format!("{name}.report.txt"), Report(&compiled).to_string()),
        (format!("{name}.rs"), compiled.rust()),
        (
            format!("{name}.vectors.csv"),
            table::healthy(&compiled, &vectors::setpoints(&compiled)),
        ),
    ])
}
