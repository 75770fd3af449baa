//! Completions and manual pages.

use super::*;

#[test]
fn shells_complete_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = run(&["completions", shell]);
        assert_status(&output, 0);
        for word in ["identify", "golden", "deny-warnings", "cargo-mixer"] {
            assert!(stdout(&output).contains(word), "{shell}: no {word}");
        }
    }
    assert_status(&run(&["completions", "tcsh"]), 2);
}

#[test]
fn manual_pages_are_there() {
    let all = run(&["man"]);
    assert_status(&all, 0);
    assert!(
        stdout(&all).contains(".TH cargo-mixer 1") && stdout(&all).contains("golden"),
        "{}",
        stdout(&all)
    );
    let check = run(&["man", "check"]);
    assert_status(&check, 0);
    assert!(stdout(&check).contains("deny\\-warnings"), "{}", stdout(&check));
    assert_status(&run(&["man", "none"]), 2);
}
