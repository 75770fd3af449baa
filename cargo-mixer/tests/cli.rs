//! The command line from outside: outputs, exit status, streaming.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

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
    let output = run(&["check", X8]);
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
        "\n  saturated     counted with 4 units, desaturation in closed form: mean ",
        "\ncompiled in ",
    ] {
        assert!(
            stdout(&output).contains(line),
            "no {line:?} in\n{}",
            stdout(&output)
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
    let cost = &summary["cost"];
    assert_eq!(cost["target"], "Cortex-M4F, counted in QEMU");
    assert_eq!(cost["desaturation"], "closed-form");
    assert_eq!(cost["table_bytes"], summary["table_bytes"]);
    let count = |key: &str| cost[key].as_u64().unwrap_or_else(|| panic!("{key}: {cost}"));
    assert_eq!(4 * count("inverse_instructions"), count("inverses_instructions"));
    assert_eq!(4 * count("inverse_cycles"), count("inverses_cycles"));
    assert!(count("delivered_instructions") > count("inverses_instructions"));
    assert!(cost["counted"][0]["worst"][1].as_u64().unwrap() > count("delivered_instructions"));
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
        assert_eq!(prettyplease::unparse(&file), stdout(&output));
    }
    assert!(modules.contains(&"isae_x8".to_owned()), "{modules:?}");
}

/// One row of `mix`: throttles, achieved wrench, saturation.
fn row(line: &str) -> (Vec<f32>, [f32; 4], u16) {
    let fields: Vec<&str> = line.split(',').collect();
    let (saturation, numbers) = fields.split_last().unwrap();
    let numbers: Vec<f32> = numbers.iter().map(|number| number.parse().unwrap()).collect();
    let (throttles, achieved) = numbers.split_at(numbers.len() - 4);
    (
        throttles.to_vec(),
        achieved.try_into().unwrap(),
        saturation.parse().unwrap(),
    )
}

#[test]
fn mix_prints_the_bits_of_the_tables() {
    let text = std::fs::read_to_string(root().join(X8)).unwrap();
    let compiled = mixer_compiler::compile(&mixer_compiler::Source::new(X8, text)).unwrap();
    let setpoints: Vec<([f32; 4], f32)> = (0..200u8)
        .map(|i| {
            let x = f32::from(i) / 200.0;
            ([x - 0.3, 1.7 * x * x - 0.4, 0.7 - x, 90.0 * x], 12.5 + 5.0 * x)
        })
        .collect();
    let rows = setpoints
        .iter()
        .map(|([roll, pitch, yaw, thrust], voltage)| format!("{voltage},{thrust},{roll},{pitch},{yaw}\n"));
    let input = format!(
        "voltage_v,thrust_n,roll_nm,pitch_nm,yaw_nm\n{}",
        rows.collect::<String>()
    );
    let output = run_with(&["mix", X8], input.as_bytes());
    assert_status(&output, 0);
    let mut lines = stdout(&output).lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header.len(), 8 + 4 + 1);
    assert_eq!((header[0], header[7]), ("throttle_0", "throttle_7"));
    assert_eq!(
        header[8..],
        [
            "achieved_roll_nm",
            "achieved_pitch_nm",
            "achieved_yaw_nm",
            "achieved_thrust_n",
            "saturation"
        ]
    );
    let rows: Vec<_> = lines.map(row).collect();
    assert_eq!(rows.len(), setpoints.len());
    let (mut saturated, mut clamped) = (0, 0);
    for ((wrench, voltage), (throttles, achieved, saturation)) in setpoints.iter().zip(&rows) {
        let wrench = mixer_rt::Wrench::from_array(*wrench);
        let expected = compiled.tables.mix(&wrench, *voltage).unwrap();
        let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(throttles), bits(&expected.0));
        assert_eq!(bits(achieved), bits(&expected.1.to_array()));
        assert_eq!(*saturation, expected.2.bits());
        saturated += u32::from(expected.2.any_axis());
        clamped += u32::from(expected.2.voltage_clamped());
    }
    // The sequence shows both kinds of row.
    assert!(
        (1..200).contains(&saturated) && (1..200).contains(&clamped),
        "{saturated} {clamped}"
    );
}

#[test]
fn mix_takes_the_reference_voltage_without_a_column() {
    let without = run_with(&["mix", X8], format!("{HEADER}\n0.5,0,0.1,40\n").as_bytes());
    let with = run_with(
        &["mix", X8],
        format!("{HEADER},voltage_v\n0.5,0,0.1,40,14.8\n").as_bytes(),
    );
    assert_status(&without, 0);
    assert_status(&with, 0);
    assert_eq!(stdout(&without), stdout(&with));
    assert_eq!(stdout(&without).lines().count(), 2);
}

#[test]
fn mix_answers_each_row_before_the_next() {
    let mut child = cargo_mixer(&["mix", X8]).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let (sender, answers) = mpsc::channel();
    let output = BufReader::new(child.stdout.take().unwrap());
    let reader = thread::spawn(move || output.lines().try_for_each(|line| sender.send(line.unwrap())));
    // An answer that is kept back fails the test; it does not hang it.
    let answer = || answers.recv_timeout(Duration::from_secs(30)).expect("no answer");
    writeln!(stdin, "{HEADER}").unwrap();
    assert!(answer().starts_with("throttle_0,"));
    for thrust_n in [20.0, 30.0, 40.0] {
        // In two pieces: half a line is no reason to keep an answer back.
        write!(stdin, "0,0,0,{thrust_n}\n0,").unwrap();
        let (_, [.., achieved], _) = row(&answer());
        assert!((achieved - thrust_n).abs() < 0.04, "{achieved}");
        writeln!(stdin, "0,0,{thrust_n}").unwrap();
        let (_, [.., again], _) = row(&answer());
        assert_eq!(again, achieved);
    }
    drop(stdin);
    reader.join().unwrap().unwrap();
    assert_eq!(answers.try_recv(), Err(mpsc::TryRecvError::Disconnected));
    assert!(child.wait().unwrap().success());
}

#[test]
fn mix_names_the_line_of_a_bad_row_and_goes_on() {
    let input = format!(
        "{HEADER},voltage_v\r\n0,0,0,31,15\r\n\r\nnan,0,0,31,15\r\n0,0,0,inf,15\r\n0,0,0,31,nan\r\n0,0,0,31\r\nx,0,0,31,15\r\n\"0,0,0,31,15\r\n0,0,0,31,15"
    );
    let output = run_with(&["mix", X8], input.as_bytes());
    assert_status(&output, 1);
    let answers: Vec<&str> = stdout(&output).lines().skip(1).collect();
    assert_eq!(answers.len(), 2);
    assert_eq!(answers[0], answers[1]);
    let expected = "\
error: stdin:4: the roll setpoint is not finite
error: stdin:5: the thrust setpoint is not finite
error: stdin:6: the voltage is not finite
error: stdin:7: 4 columns where the header has 5
error: stdin:8: roll_nm `x` is not a number
error: stdin:9: a quote is not closed on its line
error: 6 bad rows are left out
";
    assert_eq!(stderr(&output), expected);
}

#[test]
fn mix_refuses_a_header_that_is_none() {
    for (input, message) in [
        (
            "",
            "error: stdin:1: the input is empty; its first line is the header ",
        ),
        (
            "0,0,0,31\n0,0,0,31\n",
            "error: stdin:1: no column roll_nm, pitch_nm, yaw_nm, thrust_n; ",
        ),
        (
            "roll_nm,pitch_nm,yaw_nm\n0,0,0\n",
            "error: stdin:1: no column thrust_n; ",
        ),
        (
            "roll_nm,pitch_nm,yaw_nm,thrust_n,yaw_nm\n",
            "error: stdin:1: column `yaw_nm` stands twice",
        ),
        (
            "roll_nm,pitch_nm,yaw_nm,thrust_n,v\n",
            "error: stdin:1: unknown column `v`; ",
        ),
    ] {
        let output = run_with(&["mix", X8], input.as_bytes());
        assert_status(&output, 1);
        assert_eq!(stdout(&output), "");
        assert!(stderr(&output).starts_with(message), "{}", stderr(&output));
    }
    // A header alone is a sequence of no setpoints.
    let output = run_with(&["mix", X8], HEADER.as_bytes());
    assert_status(&output, 0);
    assert_eq!(stdout(&output).lines().count(), 1);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    // More rows than any pipe holds.
    let input = format!("{HEADER}\n{}", "0,0,0,31\n".repeat(10_000));
    let mut child = cargo_mixer(&["mix", X8]).spawn().unwrap();
    let mut first = [0; 8];
    let mut reader = child.stdout.take().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = thread::spawn(move || {
        let _ = stdin.write_all(input.as_bytes());
    });
    reader.read_exact(&mut first).unwrap();
    drop(reader);
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert_status(&output, 0);
    assert_eq!(&first, b"throttle");
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
