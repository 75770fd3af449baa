//! Writes the golden outputs of all airframes: `cargo run -p mixer-tests --bin bless`.
//!
//! Everything is compiled before anything is written; orphans are removed. Look at the difference before you commit
//! it.

use std::process::ExitCode;
use std::{fs, io};

use mixer_tests::{airframes, golden};

fn main() -> ExitCode {
    match bless() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn bless() -> Result<(), String> {
    let unwritable = |error: io::Error| format!("{}: {error}", golden::folder().display());
    let mut outputs = Vec::new();
    for name in airframes().map_err(|error| format!("airframes/: {error}"))? {
        outputs.extend(golden::outputs(&name)?);
    }
    fs::create_dir_all(golden::folder()).map_err(unwritable)?;
    for entry in fs::read_dir(golden::folder()).map_err(unwritable)? {
        let path = entry.map_err(unwritable)?.path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if !outputs.iter().any(|(file, _)| *file == name) {
            println!("removed {name}");
            fs::remove_file(&path).map_err(unwritable)?;
        }
    }
    for (name, content) in outputs {
        let path = golden::folder().join(&name);
        if fs::read_to_string(&path).ok().as_ref() != Some(&content) {
            println!("written {name}");
            fs::write(&path, content).map_err(unwritable)?;
        }
    }
    Ok(())
}
