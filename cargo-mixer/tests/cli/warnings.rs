//! Warnings on the command line: text, JSON, exit status.

use super::*;

const HIGH_IDLE: &str = "mixer-compiler/tests/warnings/idle-high.toml";

/// Status 0 and the warning on stderr.
#[test]
fn warnings_leave_the_status() {
    let output = run(&["check", HIGH_IDLE]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stderr(&output).starts_with("warning[MIX303]: at idle one unit gives 8.834 N"),
        "{}",
        stderr(&output)
    );
    let line = format!("\n{HIGH_IDLE}:5:7: warning[MIX303]: ");
    assert!(stdout(&output).contains(&line), "{}", stdout(&output));
    let output = run(&["expand", HIGH_IDLE]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("warning[MIX303]"), "{}", stderr(&output));
}

#[test]
fn warnings_can_be_denied() {
    let output = run(&["check", "--deny-warnings", HIGH_IDLE]);
    assert_status(&output, 1);
    let message = format!("error: {HIGH_IDLE}: 1 warning, and --deny-warnings is given\n");
    assert!(stderr(&output).ends_with(&message), "{}", stderr(&output));
    assert_status(&run(&["check", "--deny-warnings", X8]), 0);
}

#[test]
fn json_lists_warnings() {
    let summary = |arguments: &[&str]| -> Value { serde_json::from_slice(&run(arguments).stdout).unwrap() };
    let warned = summary(&["check", "--json", HIGH_IDLE]);
    let warnings = warned["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0]["code"], "MIX303");
    assert_eq!(warnings[0]["line"], 5);
    assert_eq!(warnings[0]["column"], 7);
    assert!(warnings[0]["message"].as_str().unwrap().starts_with("at idle"));
    assert_eq!(
        summary(&["check", "--json", X8])["warnings"],
        Value::Array(Vec::new())
    );
    let refused = summary(&["check", "--json", FAULTY]);
    assert!(!refused["errors"].as_array().unwrap().is_empty());
    assert_eq!(refused["warnings"], Value::Array(Vec::new()));
}

/// A file name is the user's, the terminal, too.
#[cfg(unix)]
#[test]
fn control_characters_of_names_do_not_reach_the_terminal() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("control");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("a\u{1b}[2Jb.toml");
    for text in [
        std::fs::read_to_string(root().join(HIGH_IDLE)).unwrap(),
        "name = 1".to_owned(),
        String::new(),
    ] {
        std::fs::write(&path, &text).unwrap();
        let output = run(&["check", path.to_str().unwrap()]);
        for shown in [stdout(&output), stderr(&output)] {
            assert!(!shown.contains('\u{1b}'), "{shown:?}");
        }
        assert!(
            stderr(&output).contains("a\\u{1b}[2Jb.toml"),
            "{}",
            stderr(&output)
        );
    }
    std::fs::remove_file(&path).unwrap();
    let output = run(&["check", path.to_str().unwrap()]);
    assert_status(&output, 1);
    assert!(!stderr(&output).contains('\u{1b}'));
}
