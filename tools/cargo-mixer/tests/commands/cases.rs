//! Commands and what they say: every `tests/cases/FOLDER/NAME.txt` is a session in a shell.
//!
//! ```text
//! # What the case is about.
//! $ cargo mixer check warned/idle-high.toml
//!   a line of stdout
//! ! a line of stderr
//! status 1
//! ```
//!
//! `$` begins a command of `sh`, `>` continues it: here-documents make files, `sed` changes them.
//! What stands below is checked, and written by `MIXER_BLESS=1 cargo test -p cargo-mixer --test
//! commands`; read the difference before committing it. A status of 0 is not said. A case begins in an
//! empty folder with links to `airframes`, `examples`, to the compiler's `bad` and `warned` files, to the `golden`
//! outputs and to `files` beside the cases. Times, the project's version and the case's folder are
//! masked. No case may panic, nor send a control character to a terminal.

use std::fmt::Write as _;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use crate::{in_shell, root};

/// A test for each folder.
macro_rules! folders {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            hold(stringify!($name));
        })*

        #[test]
        fn every_folder_is_tested() {
            let mut folders = names(&root().join("tools/cargo-mixer/tests/cases"));
            folders.retain(|name| name != "files");
            assert_eq!(folders, [$(stringify!($name)),*]);
        }
    };
}

folders! { check compare expand golden identify import library mix new params plan predict report review usage wrench }

/// The names of what is in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Runs the cases of a folder, and compares or writes what they say.
#[track_caller]
fn hold(folder: &str) {
    let bless = std::env::var_os("MIXER_BLESS").is_some_and(|value| value == "1");
    let cases = root().join("tools/cargo-mixer/tests/cases").join(folder);
    let mut complaints = String::new();
    for name in names(&cases) {
        let file = cases.join(&name);
        let agreed = fs::read_to_string(&file).unwrap();
        let place = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join("cases")
            .join(folder)
            .join(&name);
        let told = session(&agreed, &place);
        let acting =
            |c: char| (c.is_control() && c != '\n' && c != '\t') || ('\u{2028}'..'\u{206f}').contains(&c);
        if told.contains("panicked at") || told.contains("\nended by a signal") || told.contains(acting) {
            let _ = writeln!(
                complaints,
                "{folder}/{name} panics or prints control characters:\n{told:?}"
            );
        } else if bless {
            fs::write(&file, told).unwrap();
        } else if agreed != told {
            let _ = writeln!(
                complaints,
                "{folder}/{name} differs:\n{}",
                difference(&agreed, &told)
            );
        }
    }
    assert!(
        complaints.is_empty(),
        "\n{complaints}MIXER_BLESS=1 writes them anew"
    );
}

/// The case's remarks and commands, each command with what it says now.
fn session(case: &str, place: &Path) -> String {
    let _ = fs::remove_dir_all(place);
    fs::create_dir_all(place).unwrap();
    for (name, folder) in [
        ("airframes", "airframes"),
        ("examples", "examples"),
        ("bad", "mixer-compiler/tests/diagnostics"),
        ("warned", "mixer-compiler/tests/warnings"),
        ("golden", "tests/golden"),
        ("files", "tools/cargo-mixer/tests/cases/files"),
    ] {
        symlink(root().join(folder), place.join(name)).unwrap();
    }
    let mut told = String::new();
    let mut lines = case.lines().peekable();
    while let Some(line) = lines.next() {
        assert!(
            !line.starts_with('>'),
            "{}: no command above {line}",
            place.display()
        );
        if line.starts_with('#') {
            told += &format!("{line}\n");
        }
        let Some(first) = line.strip_prefix("$ ") else {
            continue;
        };
        told += &format!("{line}\n");
        let mut command = first.to_owned();
        while let Some(line) = lines.next_if(|line| line.starts_with('>')) {
            told += &format!("{line}\n");
            command += &format!("\n{}", line.strip_prefix("> ").unwrap_or(""));
        }
        told += &masked(&answer(&command, place), place);
        if lines.clone().any(|line| line.starts_with('$')) {
            told.push('\n');
        }
    }
    told
}

/// What a command says: its output, its errors, its status.
fn answer(command: &str, place: &Path) -> String {
    let output = in_shell(command, place);
    let mut told = String::new();
    for (mark, bytes) in [("  ", &output.stdout), ("! ", &output.stderr)] {
        let text = String::from_utf8(bytes.clone()).unwrap();
        for line in text.lines() {
            told += &format!("{}\n", format!("{mark}{line}").trim_end());
        }
        if !text.is_empty() && !text.ends_with('\n') {
            told += "(without a line's end)\n";
        }
    }
    match output.status.code() {
        Some(0) => {}
        Some(status) => told += &format!("status {status}\n"),
        None => told += "ended by a signal\n",
    }
    told
}

/// Without what another machine, another day or another version says.
fn masked(text: &str, place: &Path) -> String {
    let text = text.replace(place.to_str().unwrap(), "FOLDER");
    let text = text.replace(concat!(" ", env!("CARGO_PKG_VERSION")), " VERSION");
    ["compiled in     ", "\"compile_ms\": "]
        .iter()
        .fold(text, |text, before| {
            let mut parts = text.split(before);
            let mut masked = parts.next().unwrap_or_default().to_owned();
            for part in parts {
                let rest = part.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
                masked += &format!("{before}TIME{rest}");
            }
            masked
        })
}

/// The lines between the first that differs and the last.
fn difference(agreed: &str, told: &str) -> String {
    let [agreed, told] = [agreed, told].map(|text| text.lines().collect::<Vec<_>>());
    let same = agreed.iter().zip(&told).take_while(|(a, b)| a == b).count();
    let ends = agreed[same..].iter().rev().zip(told[same..].iter().rev());
    let end = ends.take_while(|(a, b)| a == b).count();
    let lines = |mark: char, lines: &[&str]| -> String {
        lines[same..lines.len() - end]
            .iter()
            .map(|line| format!("{mark}{line}\n"))
            .collect()
    };
    lines('-', &agreed) + &lines('+', &told)
}
