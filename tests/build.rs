//! Compiles every airframe of the project by way of the build script, for `two_ways.rs`.

use std::{fs, io};

const AIRFRAMES: &str = "../airframes";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={AIRFRAMES}");
    for entry in fs::read_dir(AIRFRAMES)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            mixer_compiler::build_script::compile(path);
        }
    }
    Ok(())
}
