//! The command line from outside: what it prints, writes and returns.
//!
//! `cases` has what is said and its status; code here is for what is not a sentence.

mod bench_to_flight;
#[cfg(target_os = "linux")]
mod cases;
mod drift;
mod flights;
mod identify;
mod library;
#[path = "../maps/mod.rs"]
mod maps;
mod maps_compile;
mod maps_warn;
mod measured;
mod mistakes;
mod mix;
mod predict;
mod report;
mod review;
mod schema;
mod shell;
mod stacks;
mod wrench;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const X8: &str = "airframes/isae-x8.toml";
const HEADER: &str = "roll_nm,pitch_nm,yaw_nm,thrust_n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder of a test's own, empty.
fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// `cargo-mixer`, run in the project's folder.
fn cargo_mixer(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
    command.args(arguments).current_dir(root());
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// Runs to the end with `input` on stdin.
fn run_with(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = cargo_mixer(arguments).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // A command that does not read its input closes it.
    let _ = stdin.write_all(input);
    drop(stdin);
    child.wait_with_output().unwrap()
}

fn stdout(output: &Output) -> &str {
    str::from_utf8(&output.stdout).unwrap()
}

fn stderr(output: &Output) -> &str {
    str::from_utf8(&output.stderr).unwrap()
}

/// Runs a command of `sh` in a folder; `cargo mixer` in it is the program, as cargo calls it.
fn in_shell(command: &str, place: &Path) -> Output {
    let script = format!(
        "cargo() {{ '{}' \"$@\"; }}\n{command}\n",
        env!("CARGO_BIN_EXE_cargo-mixer")
    );
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &script])
        .current_dir(place)
        .stdin(Stdio::null());
    shell.env("LC_ALL", "C").env_remove("RUSTC");
    shell.output().unwrap()
}

/// Runs without any input.
fn run(arguments: &[&str]) -> Output {
    run_with(arguments, b"")
}

/// The JSON that a command prints; it succeeds.
#[track_caller]
fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", stderr(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The folder of real bench files, none of which is part of the project. Tests that need it are ignored, and run
/// where it is: `tests/run`.
fn bench_data() -> PathBuf {
    maps::bench_data()
}

/// Runs with `input` on stdin; it succeeds and says nothing but notes on stderr.
#[track_caller]
fn printed(arguments: &[&str], input: &[u8]) -> String {
    let output = run_with(arguments, input);
    assert!(
        output.status.success() && stderr(&output).lines().all(|line| line.starts_with("note: ")),
        "{}",
        stderr(&output)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_closed_stderr_changes_no_status() {
    for (arguments, status) in [
        (["check", "mixer-compiler/tests/diagnostics/many-faults.toml"], 1),
        (["mix", X8], 1),
        (["check", "nowhere.toml"], 1),
    ] {
        let mut child = cargo_mixer(&arguments).spawn().unwrap();
        drop(child.stderr.take());
        let mut stdin = child.stdin.take().unwrap();
        let _ = stdin.write_all(format!("{HEADER}\nx,0,0,31\n").as_bytes());
        drop(stdin);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}");
    }
}

/// The README's quick start runs as it stands, in its order.
#[test]
fn the_quick_start_runs() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let (_, section) = readme.split_once("## Quick start").unwrap();
    let (_, block) = section.split_once("```sh\n").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    let folder = folder("quick-start");
    let mut count = 0;
    for line in block.lines() {
        let command = line.split('#').next().unwrap();
        let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
        // The whole tests, of which this is one.
        if words[..] == ["tests/run", "--install"] {
            continue;
        }
        assert_eq!(words[..2], ["cargo", "mixer"], "{line}");
        if let Some(place) = words.iter().position(|word| word == "-o") {
            words[place + 1] = folder.join(&words[place + 1]).display().to_string();
        }
        let words: Vec<&str> = words[2..].iter().map(String::as_str).collect();
        let output = run(&words);
        assert_eq!(output.status.code(), Some(0), "{line}\n{}", stderr(&output));
        count += 1;
    }
    assert!(count >= 5, "{count} commands");
    // What `new` writes is a file of its own; the others are tables and a page.
    for file in ["my-x8.toml", "pair.toml", "predicted.toml", "report.html"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
}
