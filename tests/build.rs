//! Compiles every airframe of the project by way of the build script, for `two_ways.rs` and for the
//! README's examples.

use std::path::Path;
use std::{env, fs, io};

const AIRFRAMES: &str = "../airframes";
const README: &str = "../README.md";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={AIRFRAMES}");
    for entry in fs::read_dir(AIRFRAMES)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            mixer_compiler::build_script::compile(path);
        }
    }
    readme()
}

/// The README with paths as seen from this package, whose documentation tests run its examples.
fn readme() -> io::Result<()> {
    println!("cargo::rerun-if-changed={README}");
    let text = fs::read_to_string(README)?;
    let text = text.replace("airframe!(\"airframes/", "airframe!(\"../airframes/");
    let folder = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("OUT_DIR is not set"))?;
    fs::write(Path::new(&folder).join("README.md"), text)
}
