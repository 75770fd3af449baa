//! An airframe of which a library is made.

use std::path::Path;

use mixer_compiler::diagnostic::Diagnostics;
use mixer_compiler::{Compiled, Source};
use sha2::{Digest as _, Sha256};

/// An airframe of which a library is made.
#[derive(Debug)]
pub struct Airframe {
    pub(crate) compiled: Compiled,
    /// Prefix of every name: the Rust module.
    pub(crate) module: String,
    /// Name of the file without its folder.
    pub(crate) file: String,
    /// SHA-256 of the file in hexadecimal.
    pub(crate) hash: String,
}

impl Airframe {
    /// Compiles the text of an airframe file.
    ///
    /// # Errors
    /// All faults of the file.
    pub fn new(source: &Source) -> Result<Self, Diagnostics> {
        let compiled = mixer_compiler::compile(source)?;
        let path = Path::new(&source.name);
        let file = path.file_name().unwrap_or(path.as_os_str());
        let digest = Sha256::digest(&source.text);
        Ok(Airframe {
            module: compiled.airframe.module_name(),
            file: file.to_string_lossy().into_owned(),
            hash: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            compiled,
        })
    }

    /// What the compiler warns of.
    pub fn warnings(&self) -> Diagnostics {
        mixer_compiler::lint(&self.compiled)
    }

    /// Prefix of its macros.
    pub(crate) fn prefix(&self) -> String {
        self.module.to_uppercase()
    }
}
