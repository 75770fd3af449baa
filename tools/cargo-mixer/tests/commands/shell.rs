//! Completions, and output that is lost.
#![cfg(target_os = "linux")]

use std::process::Command;

use crate::{X8, folder, root, stderr, stdout};

/// As a subcommand of cargo, too, whose own completion still serves the other commands.
#[test]
fn bash_completes_cargo_mixer() {
    let script = format!(
        r#"own() {{ COMPREPLY=(own); }}
complete -F own cargo
eval "$({} completions bash)"
try() {{ COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=(); _cargo_with_mixer cargo "${{!#}}" "${{COMP_WORDS[$#-2]}}"; echo "${{COMPREPLY[@]}}"; }}
try cargo mixer ident
try cargo mixer check --deny
try cargo bu"#,
        env!("CARGO_BIN_EXE_cargo-mixer")
    );
    let output = Command::new("bash").args(["-c", &script]).output().unwrap();
    assert_eq!(stdout(&output), "identify\n--deny-warnings\nown\n", "{output:?}");
}

/// What cannot be written is no success; a reader that has seen enough is no fault.
#[test]
fn lost_output_is_an_error() {
    let setpoints = folder("lost").join("setpoints.csv");
    std::fs::write(&setpoints, "roll_nm,pitch_nm,yaw_nm,thrust_n\n0,0,0,30\n").unwrap();
    let mix = format!("mix {X8} {}", setpoints.display());
    let expand = format!("expand {X8}");
    for command in [&mix, &expand, "schema", "--help"] {
        let command = format!("{} {command}", env!("CARGO_BIN_EXE_cargo-mixer"));
        let told = |script: String| {
            let output = Command::new("sh")
                .args(["-c", &script])
                .current_dir(root())
                .output()
                .unwrap();
            (output.status.code(), stderr(&output).to_owned())
        };
        let (status, message) = told(format!("{command} >/dev/full"));
        assert_eq!(status, Some(1), "{command}");
        assert!(
            message.ends_with("stdout: No space left on device (os error 28)\n"),
            "{message}"
        );
        // Its status is said on stderr: that of the pipe is the reader's.
        let (_, message) = told(format!("({command}; echo $? >&2) | head -c 1 >/dev/null"));
        assert_eq!(message, "0\n", "{command}");
    }
}
