//! Compiling an airframe from a build script.
//!
//! In `build.rs`:
//!
//! ```no_run
//! mixer_compiler::build_script::compile("airframes/isae-x8.toml");
//! ```
//!
//! and in the crate: `include!(concat!(env!("OUT_DIR"), "/isae-x8.rs"));`. The generated module is
//! the one that the macro gives.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::{env, fs, io, process};

use crate::{Source, compile as compile_source, lint};

/// Why no mixer was written.
#[derive(Debug)]
#[non_exhaustive]
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
    /// Two airframe files of one stem would have one output.
    SameOutput {
        /// The name of the output.
        name: PathBuf,
        /// The files.
        airframes: [PathBuf; 2],
    },
    /// The airframe file is refused.
    Airframe(crate::Diagnostics),
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Error::File { path, error } => write!(f, "{}: {error}", path.display()),
            Error::Environment(name) => write!(f, "{name} is not set: call this from a build script"),
            Error::SameOutput {
                name,
                airframes: [first, second],
            } => write!(
                f,
                "{} and {} would both become {}: rename one of the files",
                first.display(),
                second.display(),
                name.display()
            ),
            Error::Airframe(diagnostics) => diagnostics.fmt(f),
        }
    }
}

impl std::error::Error for Error {}

/// Compiles the airframe at `path` (relative to the package) into `OUT_DIR/<file stem>.rs` and has
/// cargo run the build script again when the file changes. A fault is printed and ends the build
/// script with status 1; a warning is one of cargo's.
pub fn compile(path: impl AsRef<Path>) {
    if let Err(error) = try_compile(path.as_ref()) {
        eprintln!("{error}");
        process::exit(1);
    }
}

/// [`compile`] for build scripts that handle faults themselves. Returns the path of the generated
/// file.
///
/// # Errors
/// See [`Error`]; nothing is written then.
pub fn try_compile(path: &Path) -> Result<PathBuf, Error> {
    // By output, the airframe that it was made of by this build script.
    static MADE: Mutex<BTreeMap<PathBuf, PathBuf>> = Mutex::new(BTreeMap::new());
    let directory = env::var_os("OUT_DIR")
        .map(PathBuf::from)
        .ok_or(Error::Environment("OUT_DIR"))?;
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    compile_into(&directory, path, &mut made, &mut io::stdout().lock())
}

/// Compiles into a folder and tells cargo through `cargo`.
fn compile_into(
    directory: &Path,
    path: &Path,
    made: &mut BTreeMap<PathBuf, PathBuf>,
    cargo: &mut dyn Write,
) -> Result<PathBuf, Error> {
    let file = |path: &Path, error| Error::File {
        path: path.to_owned(),
        error,
    };
    let told = |result: io::Result<()>| result.map_err(|error| file(Path::new("stdout"), error));
    told(writeln!(cargo, "cargo::rerun-if-changed={}", path.display()))?;
    let mut name = path.file_stem().unwrap_or(path.as_os_str()).to_owned();
    name.push(".rs");
    let output = directory.join(&name);
    if let Some(first) = made.get(&output)
        && fs::canonicalize(first).ok() != fs::canonicalize(path).ok()
    {
        return Err(Error::SameOutput {
            name: name.into(),
            airframes: [first.clone(), path.to_owned()],
        });
    }
    let bytes = fs::read(path).map_err(|error| file(path, error))?;
    let source = Source::from_bytes(path.display().to_string(), bytes).map_err(Error::Airframe)?;
    let compiled = compile_source(&source).map_err(Error::Airframe)?;
    for line in lint(&compiled).lines() {
        told(writeln!(cargo, "cargo::warning={line}"))?;
    }
    fs::write(&output, compiled.rust()).map_err(|error| file(&output, error))?;
    made.insert(output.clone(), path.to_owned());
    Ok(output)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of this test's own, empty.
    fn folder(test: &str) -> PathBuf {
        let path = env::temp_dir().join(format!("mixer-compiler-{test}-{}", process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        path
    }

    #[test]
    fn files_of_one_stem_do_not_overwrite_each_other() {
        let folder = folder("stems");
        let airframe = Path::new(env!("CARGO_MANIFEST_DIR")).join("airframes/single-pair.toml");
        let [first, second] = ["a", "b"].map(|part| folder.join(part).join("pair.toml"));
        for copy in [&first, &second] {
            fs::create_dir(copy.parent().unwrap()).unwrap();
            fs::copy(&airframe, copy).unwrap();
        }
        let (mut made, mut cargo) = (BTreeMap::new(), Vec::new());
        let mut compile = |path: &Path| compile_into(&folder, path, &mut made, &mut cargo);
        let output = compile(&first).unwrap();
        let text = fs::read_to_string(&output).unwrap();
        let refused = compile(&second).unwrap_err().to_string();
        assert!(
            refused.ends_with("would both become pair.rs: rename one of the files"),
            "{refused}"
        );
        assert_eq!(fs::read_to_string(&output).unwrap(), text);
        // The same file again is no other, however it is written.
        assert_eq!(compile(&first).unwrap(), output);
        assert_eq!(compile(&folder.join("b/../a/pair.toml")).unwrap(), output);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn warnings_are_those_of_cargo() {
        let folder = folder("warnings");
        let airframe = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/warnings/idle-high.toml");
        let mut cargo = Vec::new();
        compile_into(&folder, &airframe, &mut BTreeMap::new(), &mut cargo).unwrap();
        let told = String::from_utf8(cargo).unwrap();
        let name = airframe.display();
        assert!(
            told.starts_with(&format!(
                "cargo::rerun-if-changed={name}\ncargo::warning={name}:5:7: warning[MIX303]: at idle"
            )),
            "{told}"
        );
        assert_eq!(told.lines().count(), 2, "{told}");
        fs::remove_dir_all(folder).unwrap();
    }
}
