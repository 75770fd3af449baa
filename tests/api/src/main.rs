//! The public API of the packages for firmware, held to the listings beside this program, so that a change of it is
//! seen in review. `cargo api` compares, `cargo api --bless` writes them anew.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

const PACKAGES: [&str; 3] = ["mixer-rt", "mixer-compiler", "mixer-macros"];

fn main() -> ExitCode {
    let bless = env::args().skip(1).any(|argument| argument == "--bless");
    let mut exit = ExitCode::SUCCESS;
    for package in PACKAGES {
        if let Err(told) = look_at(package, bless) {
            eprintln!("{package}: {told}");
            exit = ExitCode::FAILURE;
        }
    }
    exit
}

fn look_at(package: &str, bless: bool) -> Result<(), String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("{package}.txt"));
    let listing = listing(package)?;
    if bless {
        return fs::write(&path, listing).map_err(|error| format!("{}: {error}", path.display()));
    }
    let held = fs::read_to_string(&path).unwrap_or_default();
    let (old, new): (Vec<&str>, Vec<&str>) = (held.lines().collect(), listing.lines().collect());
    let gone = old
        .iter()
        .filter(|line| !new.contains(line))
        .map(|line| format!("- {line}\n"));
    let come = new
        .iter()
        .filter(|line| !old.contains(line))
        .map(|line| format!("+ {line}\n"));
    let told: String = gone.chain(come).collect();
    match told.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "the public API is another; `cargo api --bless` writes its listing\n{told}"
        )),
    }
}

/// The items of a package with its default features, one a line, without what the compiler derives.
fn listing(package: &str) -> Result<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target: PathBuf = env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| root.join("target"), PathBuf::from)
        .join("api");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // rustdoc's JSON is unstable. This is how cargo-semver-checks has it of a stable compiler.
    let status = Command::new(cargo)
        .current_dir(&root)
        .env("RUSTC_BOOTSTRAP", "1")
        .args([
            "rustdoc",
            "--quiet",
            "--locked",
            "--lib",
            "--package",
            package,
            "--target-dir",
        ])
        .arg(&target)
        .args([
            "--",
            "-Zunstable-options",
            "--output-format=json",
            "--cap-lints=allow",
        ])
        .status()
        .map_err(|error| format!("cargo rustdoc: {error}"))?;
    if !status.success() {
        return Err(format!("cargo rustdoc: {status}"));
    }
    let json = target
        .join("doc")
        .join(format!("{}.json", package.replace('-', "_")));
    let api = public_api::Builder::from_rustdoc_json(json)
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build()
        .map_err(|error| format!("{error}; this program reads the JSON of rustdoc 1.95"))?;
    Ok(api.items().map(|item| format!("{item}\n")).collect())
}
