//! The command line from outside: outputs, exit status, streaming.

mod compare;
mod golden;
mod mix;
mod new;
mod shell;
mod warnings;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

const X8: &str = "airframes/isae-x8.toml";
/// A file with many faults.
const FAULTY: &str = "mixer-compiler/tests/diagnostics/many-faults.toml";
const HEADER: &str = "roll_nm,pitch_nm,yaw_nm,thrust_n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
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

fn run(arguments: &[&str]) -> Output {
    run_with(arguments, b"")
}

fn stdout(output: &Output) -> &str {
    str::from_utf8(&output.stdout).unwrap()
}

fn stderr(output: &Output) -> &str {
    str::from_utf8(&output.stderr).unwrap()
}

#[track_caller]
fn assert_status(output: &Output, status: i32) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(status), "{text}");
    assert!(!text.contains("panicked"), "{text}");
    assert_eq!(text.is_empty(), status == 0, "{text}");
}

#[test]
fn check_prints_the_key_lines() {
    let output = run(&["check", "--verbose", X8]);
    assert_status(&output, 0);
    for line in [
        "isae-x8: ISAE-SUPAERO X8 after Chebbi et al. 2020, Table I\n",
        "\n4 coaxial units, 8 rotors; FRD, SI units\n",
        "\nM: wrench",
        "\nM+: least-norm efforts",
        "\nrank            4 of 4 served axes (roll, pitch, yaw, thrust)\n",
        "\nthrottle        0.1 to 1.0\n",
        "least idle 0.08875\n",
        "\nvoltage         12.8 to 16.8 V, reference 14.8 V;",
        "\nevaluator ",
        "\ntolerance       0.01 N, 0.0001 N m per unit",
        "\nresidual ",
        "\ntables ",
        "\ncost            Cortex-M4F, counted in QEMU",
        "\n  inverse       ",
        "\n  mix           about ",
        "\n  any request   at most ",
        "\non the bench    propellers off, ",
        "\n  +yaw           raises outputs 4, 6 by 0.009; 1, 3 by 0.006 (nose right)\n",
        "\nPX4             one unit is 22.3091 N m roll, 22.3091 N m pitch, 1.7320 N m yaw, 99.151 N thrust at 14.8 V\n",
        "\n                THR_MDL_FAC 0, MC_BAT_SCALE_EN 0, ",
        " MPC_THR_HOVER 0.0989 per kg of the vehicle\n",
        "\nArduPilot       one unit is 19.6924 N m roll, 19.6924 N m pitch, 1.0811 N m yaw, 123.774 N thrust at 16.8 V\n",
        "\n                MOT_THST_EXPO 0, MOT_SPIN_MIN 0.1, MOT_SPIN_MAX 1, ",
        " MOT_THST_HOVER 0.0792 per kg of the vehicle\n",
        "\ncompiled in ",
    ] {
        assert!(
            stdout(&output).contains(line),
            "no {line:?} in\n{}",
            stdout(&output)
        );
    }
}

/// The verdict: at most 30 lines, nothing that only an engineer of the compiler asks for.
#[test]
fn check_begins_with_a_verdict() {
    for entry in std::fs::read_dir(root().join("airframes")).unwrap() {
        let path = format!("airframes/{}", entry.unwrap().file_name().to_str().unwrap());
        let output = run(&["check", &path]);
        assert_status(&output, 0);
        let text = stdout(&output);
        assert!(text.lines().count() <= 30, "{text}");
        for word in [
            "\nthrust ",
            "\nidle ",
            "\nhover ",
            "\nvoltage ",
            "\nwarnings        none\n",
            "\nnext ",
        ] {
            assert!(text.contains(word), "{path}: no {word:?} in\n{text}");
        }
        assert!(!text.contains("M+"), "{text}");
    }
    let text = stdout(&run(&["check", X8])).to_owned();
    assert!(
        text.contains("\nthrust          2.3 to 99.2 N without torque at 14.8 V\n"),
        "{text}"
    );
    assert!(
        text.contains("\nhover           add [vehicle] mass_kg to see"),
        "{text}"
    );
    assert!(
        text.contains("\n+yaw            raises outputs 4, 6 by 0.009; 1, 3 by 0.006\n"),
        "{text}"
    );
}

/// With a mass, hover is a number in both lists of parameters.
#[test]
fn check_gives_the_hover_throttle_of_a_vehicle() {
    let text = std::fs::read_to_string(root().join(X8)).unwrap();
    let text = text.replacen("[throttle]", "[vehicle]\nmass_kg = 3.2\n\n[throttle]", 1);
    let path = std::env::temp_dir().join(format!("cargo-mixer-hover-{}.toml", std::process::id()));
    std::fs::write(&path, text).unwrap();
    let name = path.to_str().unwrap();
    let [output, json] = [
        run(&["check", "--verbose", name]),
        run(&["check", "--json", name]),
    ];
    std::fs::remove_file(&path).unwrap();
    assert_status(&output, 0);
    // 3.2 kg, 31.3813 N, of 99.1508 N at 14.8 V, PX4's unit, and (16.8 / 14.8)^1.75 of it at 16.8 V,
    // ArduPilot's.
    let printed = stdout(&output);
    let summary: Value = serde_json::from_slice(&json.stdout).unwrap();
    for (stack, name, value) in [
        ("px4", "MPC_THR_HOVER", 0.3165),
        ("ardupilot", "MOT_THST_HOVER", 0.2535),
    ] {
        assert!(printed.contains(&format!(", {name} {value}")), "{printed}");
        let list = summary[stack].as_array().unwrap();
        assert!(
            list.iter()
                .any(|parameter| parameter["name"] == name && parameter["value"] == value),
            "{list:?}"
        );
    }
}

#[test]
fn check_json_has_the_documented_keys() {
    let output = run(&["check", "--json", X8]);
    assert_status(&output, 0);
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["name"], "isae-x8");
    assert_eq!(summary["units"], 4);
    assert_eq!(summary["rotors"], 8);
    assert_eq!(summary["rank"], 4);
    assert_eq!(summary["min_idle"], 0.08875);
    assert!(summary["evaluator"].is_string());
    assert!(summary["table_bytes"].as_u64().unwrap() > 0);
    assert!(summary["compile_ms"].as_f64().unwrap() > 0.0);
    let thrust_n = summary["normalised"]["thrust_n"].as_f64().unwrap();
    assert!((thrust_n - 99.1508).abs() < 1e-3, "{thrust_n}");
    assert_eq!(summary["px4"][0]["name"], "THR_MDL_FAC");
    assert_eq!(summary["ardupilot"][1]["value"], 0.1);
    let cost = &summary["cost"];
    assert_eq!(cost["target"], "Cortex-M4F, counted in QEMU");
    assert_eq!(cost["desaturation"], "closed-form");
    assert_eq!(cost["table_bytes"], summary["table_bytes"]);
    let count = |key: &str| cost[key].as_u64().unwrap_or_else(|| panic!("{key}: {cost}"));
    assert_eq!(4 * count("inverse_instructions"), count("inverses_instructions"));
    assert_eq!(4 * count("inverse_cycles"), count("inverses_cycles"));
    assert!(count("delivered_instructions") > count("inverses_instructions"));
    assert!(count("bound_instructions") > count("delivered_instructions"));
    // Null as long as nothing is proven, but there.
    for (key, tolerance) in [("proven_thrust_n", 0.01), ("proven_torque_nm", 1e-4)] {
        let bound = summary.get(key).unwrap();
        assert!(
            bound.is_null() || bound.as_f64().unwrap() <= tolerance,
            "{key}: {bound}"
        );
    }
}

#[test]
fn cargo_passes_the_subcommand_s_own_name() {
    for arguments in [&["check", "--json", X8][..], &["expand", X8]] {
        let direct = run(arguments);
        let by_cargo = run(&[&["mixer"], arguments].concat());
        assert_status(&direct, 0);
        assert_status(&by_cargo, 0);
        let but_time = |output: &Output| {
            let lines = stdout(output).lines().filter(|line| !line.contains("compile_ms"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(but_time(&direct), but_time(&by_cargo));
    }
    // Only the first word is cargo's.
    assert_status(&run(&["mixer", "mixer", "check", X8]), 2);
}

#[test]
fn check_places_the_faults_of_a_file() {
    let output = run(&["check", FAULTY]);
    assert_status(&output, 1);
    assert_eq!(stdout(&output), "");
    assert!(
        stderr(&output).starts_with("error[MIX100]: "),
        "{}",
        stderr(&output)
    );
    for place in ["1:8", "4:7", "35:11"] {
        let place = format!(" --> {FAULTY}:{place}\n");
        assert!(
            stderr(&output).contains(&place),
            "no {place:?} in\n{}",
            stderr(&output)
        );
    }

    let json = run(&["check", "--json", FAULTY]);
    assert_status(&json, 1);
    assert_eq!(stderr(&json), stderr(&output));
    let value: Value = serde_json::from_slice(&json.stdout).unwrap();
    let errors = value["errors"].as_array().unwrap();
    assert_eq!(errors.len(), stderr(&output).matches("error[").count());
    let first = &errors[0];
    assert_eq!(first["code"], "MIX100");
    assert_eq!(first["file"], FAULTY);
    assert_eq!(
        (first["line"].as_u64(), first["column"].as_u64()),
        (Some(1), Some(8))
    );
    assert_eq!(first["key"], "name");
    assert!(first["message"].as_str().unwrap().contains("`X`"));
}

#[test]
fn every_command_refuses_a_file_it_cannot_use() {
    for command in ["check", "mix", "expand"] {
        for (file, message) in [
            ("nowhere.toml", "error: nowhere.toml: "),
            ("airframes", "error: airframes: "),
            (FAULTY, "error[MIX100]: "),
        ] {
            let output = run(&[command, file]);
            assert_status(&output, 1);
            assert_eq!(stdout(&output), "", "{command} {file}");
            assert!(
                stderr(&output).starts_with(message),
                "{command}: {}",
                stderr(&output)
            );
        }
    }
    let json = run(&["check", "--json", "nowhere.toml"]);
    assert_status(&json, 1);
    let value: Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(value["errors"][0]["file"], "nowhere.toml");
    assert!(value["errors"][0]["line"].is_null());
}

#[test]
fn bad_usage() {
    let cases: [&[&str]; 8] = [
        &[],
        &["mixer"],
        &["chekc", X8],
        &["check"],
        &["check", X8, X8],
        &["check", "--jsno", X8],
        &["mix"],
        &["expand", "--json", X8],
    ];
    for arguments in cases {
        let output = run(arguments);
        assert_status(&output, 2);
        assert_eq!(stdout(&output), "", "{arguments:?}");
        assert!(
            stderr(&output).contains("Usage: cargo mixer"),
            "{}",
            stderr(&output)
        );
    }
}

#[test]
fn help_names_every_command() {
    let output = run(&["--help"]);
    assert_status(&output, 0);
    for word in ["check", "mix", "expand", "Exit status"] {
        assert!(stdout(&output).contains(word), "{}", stdout(&output));
    }
    let output = run(&["mix", "--help"]);
    assert_status(&output, 0);
    assert!(stdout(&output).contains("roll_nm,pitch_nm,yaw_nm,thrust_n and"));
}

/// The same text as the build script's file, which `tests/two_ways.rs` compares with the library's.
#[test]
fn expand_prints_what_the_library_generates() {
    let mut modules = Vec::new();
    for entry in std::fs::read_dir(root().join("airframes")).unwrap() {
        let path = format!("airframes/{}", entry.unwrap().file_name().to_str().unwrap());
        let output = run(&["expand", &path]);
        assert_status(&output, 0);
        let text = std::fs::read_to_string(root().join(&path)).unwrap();
        let compiled = mixer_compiler::compile(&mixer_compiler::Source::new(path, text)).unwrap();
        assert_eq!(stdout(&output), compiled.rust());

        let file = syn::parse_file(stdout(&output)).unwrap();
        let [syn::Item::Mod(module)] = &file.items[..] else {
            panic!("not one module:\n{}", stdout(&output));
        };
        modules.push(module.ident.to_string());
        let text = stdout(&output);
        let (first, rest) = text.split_once('\n').unwrap();
        assert!(first.starts_with("// @generated"), "{first}");
        assert_eq!(prettyplease::unparse(&file), rest);
    }
    assert!(modules.contains(&"isae_x8".to_owned()), "{modules:?}");
}

#[test]
fn a_closed_stderr_changes_no_status() {
    for (arguments, status) in [
        (["check", FAULTY], 1),
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

/// A file without an end is refused, within bounded memory.
#[cfg(target_os = "linux")]
#[test]
fn a_device_without_an_end_is_refused() {
    for arguments in [
        &["check", "/dev/zero"][..],
        &["import", "/dev/zero", "-o", "never.toml"],
        &[
            "new",
            "--frame",
            "single",
            "--pair",
            "/dev/zero",
            "-o",
            "never.toml",
        ],
    ] {
        let output = run(arguments);
        assert_status(&output, 1);
        assert!(
            stderr(&output).contains("/dev/zero: it is above 1 MB"),
            "{}",
            stderr(&output)
        );
    }
}

/// The README's quick start runs as it stands, in its order.
#[test]
fn the_quick_start_runs() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let (_, section) = readme.split_once("## Quick start").unwrap();
    let (_, block) = section.split_once("```sh\n").unwrap();
    let (block, _) = block.split_once("```").unwrap();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("quick-start");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let mut count = 0;
    for line in block.lines() {
        let command = line.split('#').next().unwrap();
        let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
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
