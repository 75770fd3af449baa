//! What the tests of the whole way share: golden outputs, building firmware, running it in QEMU,
//! looking into its image; frames and their physics, requests, the optimum of a request, other
//! allocators to measure the mixer against, motors in thin air, and the tables of the documents.

pub mod allocators;
pub mod bases;
pub mod cost;
pub mod counts;
pub mod digest;
pub mod documents;
pub mod firmware;
pub mod frames;
pub mod golden;
pub mod image;
pub mod interaction;
pub mod optimum;
pub mod physics;
pub mod request;
pub mod shortfall;
pub mod soak;
pub mod soundness;
pub mod thin_air;

use std::path::{Path, PathBuf};

/// The examples of the documents are run with the other documentation tests.
#[cfg(doctest)]
mod examples {
    #[doc = include_str!(concat!(env!("OUT_DIR"), "/README.md"))]
    pub struct Readme;

    #[doc = include_str!("../../docs/firmware.md")]
    pub struct Firmware;
}

/// The project's folder.
pub fn root() -> PathBuf {
    // This package lies directly in it.
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .map(Path::to_path_buf)
        .unwrap_or_default()
}

/// The folder of a package: what firmware users need lies on top, everything else in `tools/`.
pub fn folder(package: &str) -> PathBuf {
    let [top, tool] = [root(), root().join("tools")].map(|folder| folder.join(package));
    if top.exists() { top } else { tool }
}

/// Names of the files `airframes/<name>.toml`, sorted.
///
/// # Errors
///
/// If the folder cannot be read.
pub fn airframes() -> std::io::Result<Vec<String>> {
    toml_names("airframes")
}

/// Names of the files `<folder>/<name>.toml`, sorted.
///
/// # Errors
///
/// If the folder cannot be read.
pub fn toml_names(folder: &str) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(root().join(folder))? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            names.extend(path.file_stem().map(|stem| stem.to_string_lossy().into_owned()));
        }
    }
    names.sort();
    Ok(names)
}
