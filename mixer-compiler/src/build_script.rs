//! Compiling an airframe from a build script.
//!
//! In `build.rs`:
//!
//! ```no_run
//! mixer_compiler::build_script::compile("airframes/isae-x8.toml");
//! ```
//!
//! and in the crate: `include!(concat!(env!("OUT_DIR"), "/isae-x8.rs"));`. The generated module is the one that the
//! macro gives.

use std::path::{Path, PathBuf};
use std::{env, fs, io, process};

use crate::{Source, compile as compile_source};

/// Why no mixer was written.
#[derive(Debug)]
pub enum Error {
    /// The airframe file or the output cannot be read or written.
    File {
        /// The file.
        path: PathBuf,
        /// What happened.
        error: io::Error,
    },
    /// Not run by cargo: this environment variable is missing.
    Environment(&'static str),
    /// The airframe file is refused.
    Airframe(crate::diagnostic::Diagnostics),
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Error::File { path, error } => write!(f, "{}: {error}", path.display()),
            Error::Environment(name) => write!(f, "{name} is not set: call this from a build script"),
            Error::Airframe(diagnostics) => diagnostics.fmt(f),
        }
    }
}

impl std::error::Error for Error {}

/// Compiles the airframe at `path` (relative to the package) into `OUT_DIR/<file stem>.rs` and has cargo run the
/// build script again when the file changes. A fault is printed and ends the build script with status 1.
pub fn compile(path: impl AsRef<Path>) {
    if let Err(error) = try_compile(path.as_ref()) {
        eprintln!("{error}");
        process::exit(1);
    }
}

/// [`compile`] for build scripts that handle faults themselves. Returns the path of the generated file.
///
/// # Errors
/// See [`Error`]; nothing is written then.
pub fn try_compile(path: &Path) -> Result<PathBuf, Error> {
    println!("cargo::rerun-if-changed={}", path.display());
    let directory = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .ok_or(Error::Environment("OUT_DIR"))?;
    let file = |path: &Path, error| Error::File {
        path: path.to_owned(),
        error,
    };
    let bytes = fs::read(path).map_err(|error| file(path, error))?;
    let source = Source::from_bytes(path.display().to_string(), bytes).map_err(Error::Airframe)?;
    let compiled = compile_source(&source).map_err(Error::Airframe)?;
    let mut name = path.file_stem().unwrap_or(path.as_os_str()).to_owned();
    name.push(".rs");
    let output = directory.join(name);
    fs::write(&output, compiled.rust()).map_err(|error| file(&output, error))?;
    Ok(output)
}
