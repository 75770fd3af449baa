//! How large each part is: characters of Rust without white space, comments and tests.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::tables::markdown;
use crate::root;

/// Packages whose modules are features of their own.
const BY_MODULE: [&str; 3] = ["mixer-compiler", "tools/mixer-files", "tools/mixer-identify"];
const WHOLE: [&str; 8] = [
    "mixer-rt",
    "tools/cargo-mixer",
    "tools/isolated-rotors",
    "tools/launcher",
    "tools/mixer-facts",
    "tools/python",
    "tools/simulation",
    "tools/web",
];

/// Characters of a file; its tests stand at its end.
fn characters(text: &str) -> usize {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines
        .map(|line| line.chars().filter(|c| !c.is_whitespace()).count())
        .sum()
}

/// Adds up the files below a folder, each under what `part` makes of its path from there.
fn add(
    folder: &Path,
    part: &dyn Fn(&Path) -> String,
    sizes: &mut BTreeMap<String, usize>,
    below: &Path,
) -> std::io::Result<()> {
    for entry in fs::read_dir(folder.join(below))? {
        let path = below.join(entry?.file_name());
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if folder.join(&path).is_dir() {
            if name != "tests" {
                add(folder, part, sizes, &path)?;
            }
        } else if name.ends_with(".rs") && !name.ends_with("tests.rs") {
            *sizes.entry(part(&path)).or_default() += characters(&fs::read_to_string(folder.join(&path))?);
        }
    }
    Ok(())
}

/// The table: the largest part first, in thousands of characters.
pub(super) fn sizes() -> Result<String, String> {
    let mut sizes = BTreeMap::new();
    for package in BY_MODULE.iter().chain(&WHOLE) {
        let name = package.trim_start_matches("tools/");
        let part = |path: &Path| -> String {
            let module = path.iter().next().unwrap_or_default().to_string_lossy();
            match module.trim_end_matches(".rs") {
                module if BY_MODULE.contains(package) && module != "lib" => format!("{name}: `{module}`"),
                _ => name.to_owned(),
            }
        };
        let folder = root().join(package).join("src");
        add(&folder, &part, &mut sizes, Path::new(""))
            .map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let all: usize = sizes.values().sum();
    let mut sizes: Vec<(String, usize)> = sizes.into_iter().collect();
    sizes.sort_by_key(|(_, size)| std::cmp::Reverse(*size));
    // What is below a thousand is in the sum.
    let rows = sizes.into_iter().chain([("in all".to_owned(), all)]);
    let rows = rows.filter(|(_, size)| *size >= 2000);
    let rows: Vec<Vec<String>> = rows
        .map(|(part, size)| vec![part, (size as f64 / 1000.0).round().to_string()])
        .collect();
    Ok(markdown(&["part", "thousand characters"], &rows))
}
