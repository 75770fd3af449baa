//! Airframe files as a command reads them, and what it says of those that it cannot use.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;
use std::process::ExitCode;

use mixer_compiler::diagnostic::Diagnostics;
use mixer_compiler::{Compiled, Source};
use serde_json::{Value, json};

use crate::terminal::{BAD_INPUT, print_error, show, warn};

/// Largest airframe or parameter file, MB. They have kilobytes; read, they take forty times their
/// size.
pub const LARGEST_SMALL_MB: u64 = 1;

/// Why an airframe file gave no mixer.
#[derive(Debug)]
pub enum Refusal {
    /// It cannot be read: a message that names it.
    Unreadable(String),
    /// It has faults.
    Faulty(Diagnostics),
}

impl Refusal {
    /// Reports to stderr.
    pub fn report(&self) -> ExitCode {
        match self {
            Refusal::Unreadable(message) => print_error(message),
            Refusal::Faulty(diagnostics) => {
                show(diagnostics);
                ExitCode::from(BAD_INPUT)
            }
        }
    }
}

/// A fault without a code or a column, as `--json` lists those of airframe files.
pub fn fault(file: &str, line: Option<u64>, message: &str, help: &str) -> Value {
    json!({ "code": "", "file": file, "key": "", "message": message, "label": "", "help": help, "line": line, "column": null })
}

/// What `--json` prints of faults.
pub fn errors(faults: impl IntoIterator<Item = Value>) -> Value {
    json!({ "errors": faults.into_iter().collect::<Vec<_>>(), "warnings": [] })
}

/// Reads and compiles an airframe file; its warnings go to stderr.
pub fn compile(path: &Path) -> Result<Compiled, ExitCode> {
    let compile = |source: Source| mixer_compiler::compile(&source).map_err(Refusal::Faulty);
    let compiled = read(path).and_then(compile).map_err(|refusal| refusal.report())?;
    warn(&mixer_compiler::lint(&compiled));
    Ok(compiled)
}

/// Reads an airframe file.
pub fn read(path: &Path) -> Result<Source, Refusal> {
    let name = path.display().to_string();
    let bytes = read_small(path).map_err(Refusal::Unreadable)?;
    Source::from_bytes(name, bytes).map_err(Refusal::Faulty)
}

/// The bytes of an airframe or parameter file.
///
/// # Errors
/// A file that cannot be read, or is above 1 MB; the message names it.
pub fn read_small(path: &Path) -> Result<Vec<u8>, String> {
    up_to(path, LARGEST_SMALL_MB).map_err(|error| format!("{}: {error}", path.display()))
}

/// The bytes of a file of at most so many MB: a device without an end would fill the memory.
///
/// # Errors
/// A file that cannot be read, or is larger.
pub fn up_to(path: &Path, most_mb: u64) -> io::Result<Vec<u8>> {
    let most = most_mb << 20;
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let message = format!("it is above {most_mb} MB; name a smaller file");
        return Err(io::Error::other(message));
    }
    Ok(bytes)
}
