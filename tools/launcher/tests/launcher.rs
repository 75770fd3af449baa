//! The launcher says what the whole program says, and hands on what it has not.
#![allow(missing_docs)]

use std::process::{Command, Output};

use cargo_mixer::arguments::Arguments;
use clap::Parser as _;

fn run(words: &[&str], cargo: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_launcher"));
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    command.current_dir(root).env("CARGO", cargo).args(words);
    command.output().expect("the launcher")
}

#[test]
fn usage_of_check_is_that_of_the_whole_program() {
    for more in [
        &["--help"][..],
        &[],
        &["--nope", "a.toml"],
        &["a.toml", "--json", "--verbose"],
    ] {
        let words = [&["check"], more].concat();
        let output = run(&words, "no-cargo");
        let said = [output.stdout, output.stderr].concat();
        let whole = Arguments::try_parse_from([&["cargo mixer"], &words[..]].concat());
        let whole = whole.expect_err("help or bad usage");
        assert_eq!(String::from_utf8_lossy(&said), whole.to_string());
        assert_eq!(output.status.code(), Some(whole.exit_code()), "{words:?}");
    }
}

#[test]
fn check_is_here() {
    let output = run(&["check", "airframes/isae-x8.toml"], "no-cargo");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("proven"), "{said}");
    let output = run(&["check", "none.toml"], "no-cargo");
    assert_eq!(output.status.code(), Some(1));
}

#[cfg(unix)]
#[test]
fn other_commands_are_handed_on() {
    use std::os::unix::fs::PermissionsExt as _;

    let cargo = concat!(env!("CARGO_TARGET_TMPDIR"), "/cargo");
    std::fs::write(cargo, "#!/bin/sh\nfor word; do echo \"$word\"; done\nexit 7\n").expect("a script");
    std::fs::set_permissions(cargo, std::fs::Permissions::from_mode(0o755)).expect("a program");
    let output = run(&["identify", "two words.csv", "--json"], cargo);
    let said = String::from_utf8_lossy(&output.stdout);
    let (before, after) = said
        .split_once("\n--\n")
        .expect("cargo's words and the command's");
    assert!(
        before.starts_with("run\n") && before.contains("/cargo-mixer/Cargo.toml"),
        "{before}"
    );
    assert_eq!(after, "identify\ntwo words.csv\n--json\n");
    assert_eq!(output.status.code(), Some(7));
    let output = run(&["--help"], "no-cargo");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cargo cannot be run"));
}
