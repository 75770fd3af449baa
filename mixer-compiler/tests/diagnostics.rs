//! Bad airframe files and what their users are told.
//!
//! `diagnostics/NAME.toml` is a bad file, `NAME.txt` what the compiler says of it: the whole text
//! of its `Display`. `MIXER_BLESS=1 cargo test -p mixer-compiler --test diagnostics` writes the
//! texts anew; read the difference before committing it.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use mixer_compiler::Source;
use mixer_compiler::diagnostic::{Code, Diagnostics, Severity};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics")
}

/// The names of all files with this extension.
fn names(extension: &str) -> BTreeSet<String> {
    let files = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect()
}

/// What the compiler says of a bad file; `None` if it has nothing against it.
fn refuse(name: &str) -> Option<Diagnostics> {
    let text = fs::read_to_string(folder().join(format!("{name}.toml"))).unwrap();
    mixer_compiler::compile(&Source::new(format!("{name}.toml"), text)).err()
}

#[test]
fn bad_files_are_refused_in_the_words_agreed() {
    let bless = std::env::var_os("MIXER_BLESS").is_some_and(|value| value == "1");
    let mut complaints = String::new();
    let bad = names("toml");
    assert!(bad.len() >= 28, "only {} bad files", bad.len());
    for name in &bad {
        let Some(faults) = refuse(name) else {
            writeln!(complaints, "{name}.toml is accepted").unwrap();
            continue;
        };
        let told = format!("{faults}\n");
        let golden = folder().join(format!("{name}.txt"));
        if bless {
            fs::write(&golden, &told).unwrap();
            continue;
        }
        match fs::read_to_string(&golden) {
            Ok(agreed) if agreed == told => {}
            Ok(agreed) => {
                writeln!(
                    complaints,
                    "{name}.txt: agreed\n{agreed}\n{name}.toml: told\n{told}"
                )
                .unwrap();
            }
            Err(error) => writeln!(complaints, "{name}.txt: {error}; told\n{told}").unwrap(),
        }
    }
    for orphan in names("txt").difference(&bad) {
        writeln!(complaints, "{orphan}.txt has no {orphan}.toml").unwrap();
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}

/// Every fault says where, how much and what to do; the machine-readable form agrees with the
/// rendering.
#[test]
fn faults_are_complete() {
    let mut complaints = String::new();
    for name in names("toml") {
        let Some(faults) = refuse(&name) else { continue };
        if faults.faults().is_empty() {
            writeln!(complaints, "{name}: refused without a fault").unwrap();
        }
        for (fault, record) in faults.faults().iter().zip(faults.records()) {
            // The whole file is another one; its first line would be no help, and may have no end.
            let of_the_file = faults.faults().len() == 1 && fault.message.starts_with("not TOML: this is");
            let (Some(line), Some(column)) = (record.line, record.column) else {
                if of_the_file && !fault.help.is_empty() {
                    continue;
                }
                writeln!(complaints, "{name}: no place: {}", fault.message).unwrap();
                continue;
            };
            let told = Diagnostics::new(faults.source().clone(), vec![fault.clone()]).to_string();
            if !told.contains(&format!("--> {name}.toml:{line}:{column}\n")) {
                writeln!(complaints, "{name}: not shown at {line}:{column}: {told}").unwrap();
            }
            if fault.help.is_empty() {
                writeln!(complaints, "{name}: no help: {}", fault.message).unwrap();
            }
            if fault.code != Code::Syntax && fault.key.is_empty() {
                writeln!(complaints, "{name}: no key: {}", fault.message).unwrap();
            }
            for text in [&fault.message, &fault.label, &fault.help] {
                if text.contains('\n') || text.ends_with('.') {
                    writeln!(complaints, "{name}: {text:?} is not one line without a full stop").unwrap();
                }
            }
        }
        let lines: Vec<_> = faults
            .records_of(Severity::Error)
            .iter()
            .map(|record| (record.line, record.column))
            .collect();
        if !lines.is_sorted() {
            writeln!(
                complaints,
                "{name}: errors are not in the order of places: {lines:?}"
            )
            .unwrap();
        }
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}

/// Every code is shown by a bad file, but for two: no airframe is known whose map is locally
/// invertible everywhere and yet not provably injective, and faults of the compiler are planted in
/// its unit tests.
#[test]
fn every_code_has_a_bad_file() {
    let shown: BTreeSet<Code> = names("toml")
        .iter()
        .filter_map(|name| refuse(name))
        .flat_map(|faults| faults.faults().iter().map(|fault| fault.code).collect::<Vec<_>>())
        .collect();
    let unseen: Vec<_> = Code::ALL
        .iter()
        .filter(|code| code.severity() == Severity::Error)
        .filter(|code| ![Code::NotInjective, Code::Probe].contains(code) && !shown.contains(code))
        .collect();
    assert!(unseen.is_empty(), "no bad file gives {unseen:?}");
}

#[test]
fn text_for_compile_error_starts_with_place_and_fault() {
    let faults = refuse("throttle-reversed").unwrap();
    let text = faults.compile_error();
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "throttle-reversed.toml:4:7: `throttle.min` = 0.9 is not 0.01 or more below `throttle.max` = 0.5"
        )
    );
    assert!(text.ends_with(&faults.to_string()));
    let many = refuse("many-faults").unwrap();
    let first = many.compile_error().lines().next().unwrap().to_string();
    assert!(
        first.ends_with(&format!("(first of {} faults)", many.faults().len())),
        "{first}"
    );
}

#[test]
fn records_serialise_for_machines() {
    let json = serde_json::to_value(refuse("throttle-reversed").unwrap().records()).unwrap();
    assert_eq!(json[0]["code"], "MIX101");
    assert_eq!(json[0]["file"], "throttle-reversed.toml");
    assert_eq!(json[0]["key"], "throttle.min");
    assert_eq!(
        (json[0]["line"].as_u64(), json[0]["column"].as_u64()),
        (Some(4), Some(7))
    );
}

/// Colours change nothing of the text.
#[test]
fn colours_are_only_colours() {
    for name in ["many-faults", "wide-characters", "control-characters"] {
        let faults = refuse(name).unwrap();
        let (mut plain, mut escape) = (String::new(), false);
        for c in faults.coloured().chars() {
            match c {
                '\u{1b}' => escape = true,
                'm' if escape => escape = false,
                _ if escape => {}
                _ => plain.push(c),
            }
        }
        assert_eq!(plain, faults.to_string(), "{name}");
        assert_ne!(faults.coloured(), faults.to_string(), "{name}");
    }
}

/// A file that is no airframe at all does not flood the terminal; the records still hold
/// everything.
#[test]
fn faults_by_the_hundred_are_counted() {
    let text: String = (0..150).map(|k| format!("key{k} = {k}\n")).collect();
    let faults = mixer_compiler::compile(&Source::new("a.toml", text)).unwrap_err();
    // The unknown keys, and four that are missing.
    assert_eq!(faults.records().len(), 154);
    assert!(faults.to_string().ends_with("\n\n54 more faults are not shown"));
    let text: String = (0..9000).map(|k| format!("key{k} = {k}\n")).collect();
    let faults = mixer_compiler::compile(&Source::new("a.toml", text)).unwrap_err();
    assert_eq!(faults.records().len(), 204);
    assert!(
        faults
            .to_string()
            .ends_with("\n\nmore faults are not shown, and the rest of the file is not read")
    );
}
