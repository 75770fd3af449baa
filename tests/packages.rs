//! The packages that are published hold what their user needs, and nothing that reads files
//! outside.
#![allow(missing_docs)]

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use mixer_tests::{folder, root};

/// In the order of publication: each uses only those before it.
const PUBLISHED: [&str; 8] = [
    "mixer-rt",
    "mixer-compiler",
    "mixer-macros",
    "isolated-rotors",
    "mixer-identify",
    "mixer-facts",
    "mixer-files",
    "cargo-mixer",
];

/// Most crates of a firmware user's build, its own and this project's included.
const MOST_CRATES: usize = 31;

fn manifest(package: &str) -> toml::Table {
    let path = folder(package).join("Cargo.toml");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse()
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn packages_hold_readme_and_licences() {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    for package in PUBLISHED {
        let output = Command::new(&cargo)
            .current_dir(root())
            .args([
                "package",
                "--list",
                "--allow-dirty",
                "--offline",
                "--package",
                package,
            ])
            .output()
            .unwrap_or_else(|error| panic!("cargo package: {error}"));
        assert!(
            output.status.success(),
            "{package}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        let list = String::from_utf8_lossy(&output.stdout).into_owned();
        for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "Cargo.toml"] {
            assert!(
                list.lines().any(|line| line == file),
                "{package} has no {file}:\n{list}"
            );
        }
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let [own, project] = [folder(package), root()].map(|folder| fs::read(folder.join(licence)));
            assert_eq!(own.ok(), project.ok(), "{package}/{licence}");
        }
    }
}

#[test]
fn a_release_packs_what_is_published() {
    let script = fs::read_to_string(root().join("tests/release")).expect("a script");
    let line = script
        .lines()
        .find(|line| line.contains("cargo package"))
        .expect("a line");
    let (_, packages) = line.split_once(" -p ").expect("packages");
    assert_eq!(packages.split(" -p ").collect::<Vec<_>>(), PUBLISHED);
}

/// What whoever publishes has to fill in. A release refuses to be made without (`release.yml`).
#[test]
fn what_is_missing_for_a_release_is_said() {
    let manifest = manifest(".");
    let repository = manifest["workspace"]["package"]["repository"].as_str();
    match repository.expect("a text") {
        "" => println!(
            "MISSING for a release: [workspace.package] repository of Cargo.toml; until then links of packed READMEs lead nowhere"
        ),
        address => assert!(address.starts_with("https://"), "{address}"),
    }
}

/// The packages of ARCHITECTURE.md and what each uses.
#[test]
fn the_architecture_is_that_of_the_manifests() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("a page");
    let (_, table) = page.split_once("uses, of the others |").expect("a table");
    let (table, _) = table.split_once("\n\n").expect("its end");
    let names =
        |cell: &str| -> BTreeSet<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(2)
        .map(|line| line.split('|').collect())
        .collect();
    let listed = |row: &[&str]| names(row[1]).pop_first().expect("a package");
    let packages: BTreeSet<String> = rows.iter().map(|row| listed(row)).collect();
    let tools = fs::read_dir(root().join("tools")).expect("tools").flatten();
    let tools = tools.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let all = tools.chain(PUBLISHED.map(str::to_owned)).collect();
    assert_eq!(packages, all);
    for row in &rows {
        let package = listed(row);
        let manifest = manifest(&package);
        let dependencies = manifest.get("dependencies").and_then(toml::Value::as_table);
        let uses = dependencies.into_iter().flat_map(toml::Table::keys);
        let uses = uses.filter(|name| {
            packages.contains(*name) && !["mixer-rt", "mixer-compiler"].contains(&name.as_str())
        });
        assert_eq!(names(row[row.len() - 2]), uses.cloned().collect(), "{package}");
    }
}

/// Who cites the software names the version at hand.
#[test]
fn the_citation_has_the_version() {
    let version = &manifest(".")["workspace"]["package"]["version"];
    let citation = fs::read_to_string(root().join("CITATION.cff")).expect("a file");
    let line = format!("version: {}", version.as_str().expect("a version"));
    assert!(citation.lines().any(|text| text == line), "no line `{line}`");
}

#[test]
fn packages_use_those_published_before() {
    for (index, package) in PUBLISHED.iter().enumerate() {
        let manifest = manifest(package);
        let dependencies = manifest["dependencies"].as_table().expect("a table");
        for name in PUBLISHED {
            if dependencies.contains_key(name) {
                assert!(
                    PUBLISHED[..index].contains(&name),
                    "{package} needs {name}, which is published later"
                );
            }
        }
        for key in ["description", "documentation", "repository"] {
            assert!(manifest["package"].get(key).is_some(), "{package} has no {key}");
        }
        // A README of another folder would have links that lead nowhere once it is packed.
        assert_eq!(
            manifest["package"]["readme"].as_str(),
            Some("README.md"),
            "{package}"
        );
    }
}

/// Firmware is built of the runtime and of the compiler, by the macro or by a build script: the
/// solvers and tools of the command line are no part of that.
#[test]
fn firmware_builds_nothing_of_the_command_line() {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    for package in ["quickstart", "build-script"] {
        let output = Command::new(&cargo)
            .current_dir(root())
            .args(["tree", "--locked", "--offline", "--edges", "normal,build"])
            .args(["--prefix", "none", "--package", package])
            .output()
            .unwrap_or_else(|error| panic!("cargo tree: {error}"));
        assert!(
            output.status.success(),
            "{package}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        let tree = String::from_utf8_lossy(&output.stdout).into_owned();
        let names: BTreeSet<&str> = tree.lines().filter_map(|line| line.split(' ').next()).collect();
        assert!(
            names.contains(&"mixer-rt") && names.contains(&"mixer-compiler"),
            "{tree}"
        );
        for absent in [
            "mixer-identify",
            "mixer-facts",
            "mixer-files",
            "cargo-mixer",
            "mixer-python",
            "faer",
            "csv",
            "clap",
        ] {
            assert!(!names.contains(&absent), "{package} builds {absent}:\n{tree}");
        }
        assert!(
            names.len() <= MOST_CRATES,
            "{package}: {}: {names:?}",
            names.len()
        );
    }
}

/// Source files name no file above their package: it is not there once the package is unpacked.
#[test]
fn sources_stay_in_their_package() {
    for package in PUBLISHED {
        let mut folders = vec![folder(package).join("src")];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("src").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = fs::read_to_string(&path).expect("text");
                    let above = ["include_str!(\"../../../..", "join(\"..\")", "join(\"../"];
                    for needle in above {
                        assert!(!text.contains(needle), "{}: {needle}", path.display());
                    }
                }
            }
        }
    }
}
