//! Lays out the images' memory and prepares what they mix.
//!
//! `airframes/*.toml` decides which airframes there are. Written to OUT_DIR: `memory.x`, `golden.rs` (airframes and
//! vectors of the `golden` image), `size.rs` and `counts.rs` (the airframe that `--cfg airframe="<name>"` selects
//! for these images), and the requests of the `counts` image.

mod frames;
mod golden;
mod requests;

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Relative to this package's folder.
const AIRFRAMES: &str = "../../airframes";

fn main() {
    println!("cargo::rerun-if-changed=build");
    if let Err(message) = generate() {
        println!("cargo::error={message}");
    }
}

fn generate() -> Result<(), String> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    let write = |file: &str, text: &str| {
        fs::write(out.join(file), text).map_err(|e| format!("cannot write {file} to OUT_DIR: {e}"))
    };

    println!("cargo::rerun-if-changed=memory.x");
    let memory = fs::read_to_string("memory.x").map_err(|e| format!("cannot read memory.x: {e}"))?;
    write("memory.x", &memory)?;
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");

    let airframes = airframes()?;
    write("golden.rs", &golden::image(&airframes)?)?;
    write("size.rs", &size(&airframes))?;

    let mut measured: Vec<(String, PathBuf)> = airframes
        .iter()
        .map(|name| (name.clone(), path_of(name)))
        .collect();
    for (name, text) in frames::all() {
        let file = format!("{name}.toml");
        write(&file, &text)?;
        measured.push((name, out.join(file)));
    }
    for (name, path) in &measured {
        requests::write(name, path, &out)?;
    }
    write("counts.rs", &counts(&measured)?)?;

    let names: Vec<String> = measured.iter().map(|(name, _)| format!("{name:?}")).collect();
    println!(
        "cargo::rustc-check-cfg=cfg(airframe, values(none(), {}))",
        names.join(", ")
    );
    println!("cargo::rustc-check-cfg=cfg(panic_path)");
    Ok(())
}

/// Names of the files `airframes/<name>.toml`, sorted.
fn airframes() -> Result<Vec<String>, String> {
    println!("cargo::rerun-if-changed={AIRFRAMES}");
    let mut names = Vec::new();
    let unreadable = |e| format!("cannot list {AIRFRAMES}: {e}");
    for entry in fs::read_dir(AIRFRAMES).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            let stem = path.file_stem().and_then(|s| s.to_str());
            names.push(
                stem.ok_or(format!("{}: name is not UTF-8", path.display()))?
                    .to_owned(),
            );
        }
    }
    if names.is_empty() {
        return Err(format!("no airframe file in {AIRFRAMES}"));
    }
    names.sort();
    Ok(names)
}

/// Name of the module that `airframe!` generates.
fn module(airframe: &str) -> String {
    airframe.replace('-', "_")
}

fn size(airframes: &[String]) -> String {
    airframes
        .iter()
        .map(|airframe| {
            let module = module(airframe);
            format!(
                "#[cfg(airframe = \"{airframe}\")]\nmixer_macros::airframe!(\"{AIRFRAMES}/{airframe}.toml\");\n\
                 #[cfg(airframe = \"{airframe}\")]\nuse {module}::mix;\n"
            )
        })
        .collect()
}

/// The airframe of the `counts` image.
fn counts(measured: &[(String, PathBuf)]) -> Result<String, String> {
    let mut items = String::new();
    for (name, path) in measured {
        let path = fs::canonicalize(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let module = if path_of(name).exists() {
            module(name)
        } else {
            module(frames::NAME)
        };
        items.push_str(&format!(
            "#[cfg(airframe = \"{name}\")]\nmixer_macros::airframe!({path:?});\n\
             #[cfg(airframe = \"{name}\")]\nuse {module} as airframe;\n\
             #[cfg(airframe = \"{name}\")]\nstatic ATTAINABLE: &[u8] = include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{name}.attainable\"));\n\
             #[cfg(airframe = \"{name}\")]\nstatic SATURATED: &[u8] = include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{name}.saturated\"));\n"
        ));
    }
    Ok(items)
}

/// Relative to this package's folder.
fn path_of(airframe: &str) -> PathBuf {
    Path::new(AIRFRAMES).join(format!("{airframe}.toml"))
}
