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
    assert!(
        stdout(&output).contains("\nwarnings        1, told on stderr\n"),
        "{}",
        stdout(&output)
    );
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
    let path = folder.join("a\u{1b}[2Jb\u{202e}.toml");
    for text in [
        std::fs::read_to_string(root().join(HIGH_IDLE)).unwrap(),
        "name = 1".to_owned(),
        String::new(),
    ] {
        std::fs::write(&path, &text).unwrap();
        let output = run(&["check", path.to_str().unwrap()]);
        for shown in [stdout(&output), stderr(&output)] {
            assert!(!shown.contains(['\u{1b}', '\u{202e}']), "{shown:?}");
        }
        assert!(
            stderr(&output).contains("a\\u{1b}[2Jb\\u{202e}.toml"),
            "{}",
            stderr(&output)
        );
    }
    std::fs::remove_file(&path).unwrap();
    let output = run(&["check", path.to_str().unwrap()]);
    assert_status(&output, 1);
    assert!(!stderr(&output).contains(['\u{1b}', '\u{202e}']));
}

/// So are the headers and cells of a file, and the words of an airframe that is refused.
#[test]
fn control_characters_of_files_do_not_reach_the_terminal() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("control-in-files");
    std::fs::create_dir_all(&folder).unwrap();
    let acting = ['\u{1b}', '\u{9b}', '\u{202e}', '\u{2067}', '\u{2028}'];
    let words: String = acting.iter().collect();
    let files = [
        ("bench.csv", format!("esc {words},thrust {words} (N),\n1,2,3\n")),
        (
            "cells.csv",
            format!("upper,lower,thrust_n,torque_nm\n{words},0.5,1,0.1\n"),
        ),
        ("frame.param", format!("FRAME_CLASS,{words}\n{words},1\n")),
        (
            "a.toml",
            format!("name = \"{words}\"\n\"{words}\" = \"{words}\" # {words}\n"),
        ),
        ("b.toml", format!("# {words}\nname = {words}\n")),
    ];
    for (name, text) in files {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        let path = path.to_str().unwrap();
        let (output, page) = (folder.join("out.toml"), folder.join("page.html"));
        let commands = [
            vec!["check", path],
            vec!["check", path, "--json"],
            vec!["identify", path],
            vec!["import", path, "-o", output.to_str().unwrap()],
            vec!["mix", X8, path],
            vec!["report", X8, "--bench", path, "-o", page.to_str().unwrap()],
        ];
        for command in commands {
            let output = run(&command);
            assert_ne!(output.status.code(), Some(0), "{command:?}");
            for shown in [stdout(&output), stderr(&output)] {
                assert!(!shown.contains(acting), "{command:?}: {shown:?}");
            }
        }
    }
}
