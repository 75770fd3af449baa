//! An airframe of which a library is made.

use std::path::Path;

use mixer_compiler::Compiled;
use mixer_compiler::diagnostic::printable;

/// An airframe of which a library is made.
#[derive(Debug)]
pub(super) struct Airframe {
    /// The compiled file.
    pub(super) compiled: Compiled,
    /// Prefix of every name: the Rust module.
    pub(super) module: String,
    /// Name of the file without its folder.
    pub(super) file: String,
    /// SHA-256 of the file.
    pub(super) hash: String,
}

impl Airframe {
    pub(super) fn new(path: &Path, compiled: Compiled) -> Result<Self, String> {
        let bytes = crate::file::read_small(path)?;
        let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        Ok(Airframe {
            module: compiled.airframe.module_name(),
            file: printable(&file),
            hash: crate::file::sha256(&bytes),
            compiled,
        })
    }

    /// Prefix of its macros.
    pub(super) fn prefix(&self) -> String {
        self.module.to_uppercase()
    }
}
