//! Lays out the image's memory and turns the golden vectors of every airframe into const arrays.
//!
//! `airframes/*.toml` decides which airframes there are; each needs `tests/golden/<airframe>.vectors.csv`.
//! Written to OUT_DIR: `memory.x`, `golden.rs` (airframes and vectors of the `golden` image), `size.rs` (the
//! airframe that `--cfg airframe="<name>"` selects for the `size` image).

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Relative to this package's folder.
const AIRFRAMES: &str = "../../airframes";
/// Relative to this package's folder.
const GOLDEN: &str = "../../tests/golden";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
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
    let names: Vec<String> = airframes.iter().map(|a| format!("{a:?}")).collect();
    println!(
        "cargo::rustc-check-cfg=cfg(airframe, values(none(), {}))",
        names.join(", ")
    );
    println!("cargo::rustc-check-cfg=cfg(panic_path)");
    write("golden.rs", &golden(&airframes)?)?;
    write("size.rs", &size(&airframes))
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

fn golden(airframes: &[String]) -> Result<String, String> {
    let (mut items, mut calls) = (String::new(), String::new());
    for airframe in airframes {
        let module = module(airframe);
        let path = format!("{GOLDEN}/{airframe}.vectors.csv");
        println!("cargo::rerun-if-changed={path}");
        let vectors = vectors(Path::new(&path))?;
        let channels = vectors.channels;
        let (count, rows, table) = (vectors.rows.len(), vectors.rows.join(""), module.to_uppercase());
        write!(
            items,
            "mixer_macros::airframe!(\"{AIRFRAMES}/{airframe}.toml\");\n\
             static {table}: [Vector<{channels}>; {count}] = [\n{rows}];\n"
        )
        .map_err(|e| e.to_string())?;
        writeln!(calls, "    check!(check, \"{airframe}\", {module}, {table});")
            .map_err(|e| e.to_string())?;
    }
    Ok(format!(
        "{items}fn for_each_airframe(check: &mut Check) {{\n{calls}}}\n"
    ))
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

/// The rows of one CSV as Rust expressions.
struct Vectors {
    channels: usize,
    rows: Vec<String>,
}

/// Header: `roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v,throttle_0..,achieved_roll_nm,..,achieved_thrust_n,saturation`.
/// A float is the eight hexadecimal digits of its f32 bits after `0x`, saturation is decimal.
fn vectors(path: &Path) -> Result<Vectors, String> {
    let file = path.display();
    let text = fs::read_to_string(path).map_err(|e| {
        format!("cannot read the golden vectors {file}: {e}; bless them first, see the README")
    })?;
    let mut lines = text.lines().enumerate();
    let header = lines.next().map_or("", |(_, line)| line);
    let channels = header
        .split(',')
        .filter(|column| column.starts_with("throttle_"))
        .count();
    let expected = columns(channels).join(",");
    if channels == 0 || header != expected {
        return Err(format!(
            "{file}:1: the header is `{header}`, expected `{expected}`"
        ));
    }
    let mut rows = Vec::new();
    for (index, line) in lines {
        let fault = |what: String| format!("{file}:{}: {what}", index + 1);
        let cells: Vec<&str> = line.split(',').collect();
        let Some((saturation, floats)) = cells.split_last().filter(|_| cells.len() == channels + 10) else {
            return Err(fault(format!(
                "{} columns, expected {}",
                cells.len(),
                channels + 10
            )));
        };
        saturation
            .parse::<u16>()
            .map_err(|e| fault(format!("saturation `{saturation}`: {e}")))?;
        for cell in floats {
            let digits = cell.strip_prefix("0x").filter(|digits| digits.len() == 8);
            if !digits.is_some_and(|digits| u32::from_str_radix(digits, 16).is_ok()) {
                return Err(fault(format!("`{cell}` is not f32 bits such as 0x3f800000")));
            }
        }
        let (inputs, outputs) = floats.split_at(5);
        let (throttle, achieved) = outputs.split_at(channels);
        rows.push(format!(
            "    Vector {{ setpoint: [{}], voltage_v: {}, throttle: [{}], achieved: [{}], saturation: {saturation} }},\n",
            inputs[..4].join(", "),
            inputs[4],
            throttle.join(", "),
            achieved.join(", "),
        ));
    }
    if rows.is_empty() {
        return Err(format!("{file}: no vector"));
    }
    Ok(Vectors { channels, rows })
}

fn columns(channels: usize) -> Vec<String> {
    let axes = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"];
    let mut columns: Vec<String> = axes.iter().map(|axis| axis.to_string()).collect();
    columns.push("voltage_v".into());
    columns.extend((0..channels).map(|channel| format!("throttle_{channel}")));
    columns.extend(axes.iter().map(|axis| format!("achieved_{axis}")));
    columns.push("saturation".into());
    columns
}
