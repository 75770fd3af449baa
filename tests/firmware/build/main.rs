//! Lays out the images' memory and prepares what they mix.
//!
//! `airframes/*.toml` decides which airframes there are. Written to OUT_DIR: `memory.x`,
//! `golden.rs` (airframes and vectors of the `golden` image), `subject.rs` (the airframe that
//! `--cfg airframe="<name>"` selects for the `counts` and the `size` image), and the requests of
//! the `counts` image.

#[path = "../../src/frames/counted.rs"]
#[allow(unreachable_pub, reason = "the tests' library shows them")]
mod frames;
mod golden;
mod isolated;
#[path = "../../src/frames/pairs.rs"]
#[allow(dead_code, unreachable_pub, reason = "as above")]
mod pairs;
#[path = "../../src/frames/places.rs"]
#[allow(dead_code, unreachable_pub, reason = "as above")]
mod places;
mod requests;
#[path = "../../src/frames/zoo.rs"]
#[allow(dead_code, unreachable_pub, reason = "as above")]
mod zoo;

use std::path::{Path, PathBuf};
use std::{env, fs};

use mixer_compiler::{Compiled, Source};

/// Relative to this package's folder.
const AIRFRAMES: &str = "../../airframes";

/// An airframe that can be selected.
struct Measured {
    name: String,
    path: PathBuf,
    compiled: Compiled,
}

impl Measured {
    fn read(name: &str, path: PathBuf) -> Result<Measured, String> {
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let source = Source::new(path.display().to_string(), text);
        Ok(Measured {
            name: name.to_owned(),
            compiled: mixer_compiler::compile(&source).map_err(|faults| faults.to_string())?,
            path,
        })
    }
}

fn main() {
    println!("cargo::rerun-if-changed=build");
    if let Err(message) = generate() {
        println!("cargo::error={message}");
    }
}

fn generate() -> Result<(), String> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    // What is as it was keeps its time: an airframe written anew would have cargo run this script
    // again for every image.
    let write = |file: &str, text: &str| {
        let path = out.join(file);
        if fs::read_to_string(&path).is_ok_and(|held| held == text) {
            return Ok(());
        }
        fs::write(path, text).map_err(|e| format!("cannot write {file} to OUT_DIR: {e}"))
    };

    println!("cargo::rerun-if-changed=memory.x");
    let memory = fs::read_to_string("memory.x").map_err(|e| format!("cannot read memory.x: {e}"))?;
    write("memory.x", &memory)?;
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");

    let airframes = airframes()?;
    write("golden.rs", &golden::image(&airframes)?)?;
    let mut measured = Vec::new();
    for name in &airframes {
        measured.push(Measured::read(name, path_of(name))?);
    }
    let y6 = |name: &String| {
        let text = fs::read_to_string(path_of(name)).ok()?;
        frames::y6(name, &text)
    };
    let others = airframes.iter().filter_map(y6).chain(of_zoo(&airframes)?);
    for (name, text) in frames::all().into_iter().chain(others) {
        let file = format!("{name}.toml");
        write(&file, &text)?;
        measured.push(Measured::read(&name, out.join(file))?);
    }
    for measured in &measured {
        requests::write(measured, &out)?;
    }
    write("subject.rs", &subject(&measured)?)?;
    write("requests.rs", &requests_of(&measured))?;

    let names: Vec<String> = measured
        .iter()
        .map(|measured| format!("{:?}", measured.name))
        .collect();
    println!(
        "cargo::rustc-check-cfg=cfg(airframe, values(none(), {}))",
        names.join(", ")
    );
    println!(
        "cargo::rustc-check-cfg=cfg(baseline, values(none(), \"c-interface\", \"conventional\", \"dynamic\", \"sequential\", \"wls\"))"
    );
    println!("cargo::rustc-check-cfg=cfg(rotors_out, values(\"1\", \"2\"))");
    println!("cargo::rustc-check-cfg=cfg(million)");
    println!("cargo::rustc-check-cfg=cfg(panic_path)");
    Ok(())
}

/// The frames of the zoo whose bits are compared.
fn of_zoo(airframes: &[String]) -> Result<Vec<(String, String)>, String> {
    let (seed, indices) = zoo::ON_TARGET;
    let read = |name: &String| {
        let path = path_of(name);
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Source::new(name.as_str(), text))
    };
    let files: Vec<Source> = airframes.iter().map(read).collect::<Result<_, String>>()?;
    let with_one = files.iter().filter(|file| pairs::Pair::is_alone(file));
    let pairs: Result<Vec<_>, String> = with_one.map(pairs::Pair::of_airframe).collect();
    let zoo = zoo::Zoo::new(seed, pairs?);
    let named = indices.map(|index| (format!("zoo-{index}"), zoo.specimen(index).text));
    Ok(named.into())
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

/// The airframe of the `counts` and the `size` image, and the tables of its isolated rotors.
fn subject(measured: &[Measured]) -> Result<String, String> {
    let mut items = String::new();
    for Measured { name, path, compiled } in measured {
        let path = fs::canonicalize(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let module = module(&compiled.airframe.name);
        let isolated = isolated::tables(compiled);
        items.push_str(&format!(
            "#[cfg(airframe = \"{name}\")]\nmod selected {{\n\
             mixer_macros::airframe!({path:?});\npub(crate) use self::{module} as airframe;\n{isolated}}}\n\
             #[cfg(airframe = \"{name}\")]\npub(crate) use selected::*;\n"
        ));
    }
    Ok(items)
}

/// The requests of the `counts` image.
fn requests_of(measured: &[Measured]) -> String {
    let mut items = String::new();
    for Measured { name, .. } in measured {
        for (constant, set) in [("ATTAINABLE", "attainable"), ("SATURATED", "saturated")] {
            items.push_str(&format!(
                "#[cfg(airframe = \"{name}\")]\nstatic {constant}: &[u8] = \
                 include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{name}.{set}\"));\n"
            ));
        }
    }
    items
}

/// Relative to this package's folder.
fn path_of(airframe: &str) -> PathBuf {
    Path::new(AIRFRAMES).join(format!("{airframe}.toml"))
}
