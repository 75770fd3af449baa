//! Airframe files that are accepted and yet hardly meant, and what their users are told.
//!
//! `warnings/NAME.toml` is such a file, `NAME.txt` the warnings that the compiler has of it.
//! `MIXER_BLESS=1 cargo test -p mixer-compiler --test warnings` writes the texts anew; read the
//! difference before committing it.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use mixer_compiler::Source;
use mixer_compiler::diagnostic::{Code, Diagnostics, Severity};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/warnings")
}

/// The names of all files of `folder` with this extension.
fn names(folder: &Path, extension: &str) -> BTreeSet<String> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect()
}

/// The warnings of a file that compiles.
#[track_caller]
fn warnings(folder: &Path, name: &str) -> Diagnostics {
    let text = fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
    match mixer_compiler::compile(&Source::new(format!("{name}.toml"), text)) {
        Ok(compiled) => mixer_compiler::lint(&compiled),
        Err(faults) => panic!("{name} is refused\n{faults}"),
    }
}

#[test]
fn mistakes_are_warned_of_in_the_words_agreed() {
    let bless = std::env::var_os("MIXER_BLESS").is_some_and(|value| value == "1");
    let mut complaints = String::new();
    let files = names(&folder(), "toml");
    for name in &files {
        let told = format!("{}\n", warnings(&folder(), name));
        let golden = folder().join(format!("{name}.txt"));
        if bless {
            fs::write(&golden, &told).unwrap();
        }
        let agreed = fs::read_to_string(&golden).unwrap_or_default();
        if agreed != told {
            writeln!(complaints, "{name}.txt: agreed\n{agreed}\ntold\n{told}").unwrap();
        }
    }
    for orphan in names(&folder(), "txt").difference(&files) {
        writeln!(complaints, "{orphan}.txt has no {orphan}.toml").unwrap();
    }
    assert!(complaints.is_empty(), "\n{complaints}");
}

/// Every warning says where, how much and what to do, and every code of a warning has a file.
#[test]
fn warnings_are_complete() {
    let mut shown = BTreeSet::new();
    for name in names(&folder(), "toml") {
        let warnings = warnings(&folder(), &name);
        assert!(!warnings.is_empty(), "{name}: no warning");
        for (warning, record) in warnings.faults().iter().zip(warnings.records()) {
            shown.insert(warning.code);
            assert_eq!(warning.code.severity(), Severity::Warning, "{name}");
            assert!(
                record.line.is_some() && record.column.is_some(),
                "{name}: {record:?}"
            );
            assert!(
                !record.key.is_empty() && !record.help.is_empty(),
                "{name}: {record:?}"
            );
            assert!(
                record.message.contains(|c: char| c.is_ascii_digit()),
                "{name}: {record:?}"
            );
            for text in [&record.message, &record.label, &record.help] {
                assert!(!text.contains('\n') && !text.ends_with('.'), "{name}: {text:?}");
            }
        }
    }
    let unseen: Vec<_> = Code::ALL
        .iter()
        .filter(|code| code.severity() == Severity::Warning && !shown.contains(code))
        .collect();
    assert!(unseen.is_empty(), "no file gives {unseen:?}");
}

/// One mistake, one warning: what follows from it is not told a second time.
#[test]
fn a_mistake_has_one_code() {
    for name in names(&folder(), "toml") {
        let codes: BTreeSet<Code> = warnings(&folder(), &name)
            .faults()
            .iter()
            .map(|warning| warning.code)
            .collect();
        assert_eq!(codes.len(), 1, "{name}: {codes:?}");
    }
}

#[test]
fn the_project_s_airframes_have_none() {
    let airframes = Path::new(env!("CARGO_MANIFEST_DIR")).join("airframes");
    for name in names(&airframes, "toml") {
        let warnings = warnings(&airframes, &name);
        assert!(warnings.is_empty(), "{warnings}");
    }
}

#[test]
fn lines_are_for_logs() {
    let lines = warnings(&folder(), "idle-high").lines();
    assert_eq!(lines.len(), 1);
    assert!(
        lines[0].starts_with("idle-high.toml:5:7: warning[MIX303]: at idle one unit gives "),
        "{lines:?}"
    );
}

/// Numbers in another unit, and a throttle that was made linear, are told of a single rotor as of a pair, by its name.
#[test]
fn a_mistake_is_told_of_every_kind() {
    type Mistake = (&'static str, &'static str, f64);
    const MISTAKES: [Mistake; 11] = [
        ("gram-force", "thrust_n", 101.972),
        ("kilogram-force", "thrust_n", 0.101_972),
        ("pound-force", "thrust_n", 0.224_809),
        ("millinewtons", "thrust_n", 1000.0),
        ("torque times 10", "torque_nm", 10.0),
        ("newton centimetres", "torque_nm", 100.0),
        ("newton millimetres", "torque_nm", 1000.0),
        ("a tenth of the torque", "torque_nm", 0.1),
        ("kilogram-force metres", "torque_nm", 0.101_972),
        ("gram-force centimetres", "torque_nm", 10_197.2),
        ("a linear throttle", "thrust_n", f64::NAN),
    ];
    // Rules of every kind; others are of pairs, or of the frame.
    const OF_KINDS: [Code; 4] = [
        Code::PairUnits,
        Code::HighIdle,
        Code::PairShape,
        Code::WideTolerance,
    ];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("airframes/y4.toml");
    let text = fs::read_to_string(path).unwrap();
    for (name, key, factor) in MISTAKES {
        let told = |word: &str, of: &str, linear: &[usize]| -> BTreeSet<Code> {
            let mut file: toml::Table = text.parse().unwrap();
            let terms = file[word][0][key].as_array_mut().unwrap();
            let full: f64 = terms.iter().map(|term| term.as_float().unwrap()).sum();
            for (k, term) in terms.iter_mut().enumerate() {
                let value = match factor.is_nan() {
                    true if linear.contains(&k) => full / linear.len() as f64,
                    true => 0.0,
                    false => factor * term.as_float().unwrap(),
                };
                *term = toml::Value::Float(value);
            }
            let source = Source::new("y4.toml", toml::to_string(&file).unwrap());
            let found = match mixer_compiler::compile(&source) {
                Ok(compiled) => mixer_compiler::lint(&compiled),
                Err(refused) => refused,
            };
            let is_told = |fault: &&mixer_compiler::Diagnostic| {
                OF_KINDS.contains(&fault.code) && fault.message.starts_with(&format!("{word} \"{of}\": "))
            };
            found
                .faults()
                .iter()
                .filter(is_told)
                .map(|fault| fault.code)
                .collect()
        };
        // The terms of u and of l, and that of x.
        let (pair, rotor) = (told("pair", "rear", &[7, 8]), told("rotor", "front", &[0]));
        assert!(!rotor.is_empty(), "{name}: of a single rotor nothing is told");
        assert_eq!(pair, rotor, "{name}");
    }
}
