//! Compiles airframes by way of the build script, for `two_ways.rs`, and makes the README's examples.

use std::path::Path;
use std::{env, fs, io};

const AIRFRAMES: [&str; 3] = ["hexa-stacked", "isae-x8", "x8-22-16in"];
const README: &str = "../README.md";

fn main() -> io::Result<()> {
    for name in AIRFRAMES {
        mixer_compiler::build_script::compile(format!("../airframes/{name}.toml"));
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
