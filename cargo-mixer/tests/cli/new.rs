//! The first hour: a whole airframe from `new` and from `identify --frame`.

use std::fs;

use super::*;
use mixer_identify::paper::{THRUST, TORQUE};

fn path(name: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("new");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    let _ = fs::remove_file(&path);
    path.to_str().unwrap().to_owned()
}

/// A bench file of the paper's pair: a grid of 10 x 10 throttles.
fn bench(name: &str) -> String {
    let mut text = "upper,lower,thrust_n,torque_nm\n".to_owned();
    for k in 0..100 {
        let [u, l] = [k / 10, k % 10].map(|step| 0.1 + 0.1 * f64::from(step));
        let terms = [u * u * l * l, u * u * l, u * u, u * l * l, u * l, u, l * l, l];
        let value = |of: [f64; 8]| of.iter().zip(terms).map(|(c, term)| c * term).sum::<f64>();
        text += &format!("{u:.1},{l:.1},{:.4},{:.5}\n", value(THRUST), value(TORQUE));
    }
    let path = path(name);
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn new_frames_are_accepted_without_a_warning() {
    for (frame, arm, rotors) in [
        ("x8", Some("0.45"), 8),
        ("y6", Some("0.5"), 6),
        ("x12", Some("1"), 12),
        ("bicopter", Some("0.45"), 4),
        ("single", None, 2),
    ] {
        let file = path(&format!("my-{frame}.toml"));
        let mut arguments = vec!["new", "--frame", frame, "-o", &file];
        arguments.extend(arm.into_iter().flat_map(|arm| ["--arm", arm]));
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let checked = run(&["check", "--json", "--deny-warnings", &file]);
        assert_status(&checked, 0);
        let summary: Value = serde_json::from_slice(&checked.stdout).unwrap();
        assert_eq!(summary["name"], format!("my-{frame}"));
        assert_eq!(summary["rotors"], rotors);
        for line in fs::read_to_string(&file).unwrap().lines() {
            assert!(line.chars().count() <= 110, "{line}");
        }
    }
}

/// The frames are those of `airframes/`, which are PX4's.
#[test]
fn new_frames_have_the_geometry_of_px4() {
    let units = |path: &str| {
        let text = fs::read_to_string(path).unwrap();
        let airframe =
            mixer_compiler::airframe::Airframe::read(&mixer_compiler::Source::new(path, text)).unwrap();
        let mut units: Vec<_> = airframe
            .units
            .iter()
            .map(|unit| {
                (
                    unit.position_m.map(|x| (1e3 * x).round() as i64),
                    unit.upper_spin.name(),
                )
            })
            .collect();
        units.sort();
        units
    };
    for (frame, arm, known) in [
        ("y6", "0.5", "airframes/px4-y6.toml"),
        ("x8", "0.45", "airframes/isae-x8.toml"),
        ("bicopter", "0.45", "airframes/coaxial-bicopter.toml"),
    ] {
        let file = path(&format!("px4-{frame}.toml"));
        run(&["new", "--frame", frame, "--arm", arm, "-o", &file]);
        assert_eq!(
            units(&file),
            units(root().join(known).to_str().unwrap()),
            "{frame}"
        );
    }
}

#[test]
fn new_overwrites_only_by_force() {
    let file = path("kept.toml");
    fs::write(&file, "mine").unwrap();
    let arguments = ["new", "--frame", "single", "-o", &file];
    let output = run(&arguments);
    assert_status(&output, 1);
    assert!(
        stderr(&output).ends_with("is there already: --force overwrites it\n"),
        "{}",
        stderr(&output)
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    let forced: Vec<&str> = arguments.into_iter().chain(["--force"]).collect();
    assert_eq!(run(&forced).status.code(), Some(0));
    assert!(
        fs::read_to_string(&file)
            .unwrap()
            .starts_with("#:schema ./airframe.schema.json\nname = \"kept\"\n")
    );
}

#[test]
fn new_refuses_what_check_would() {
    let (pair, file) = (path("bad-pair.toml"), path("bad.toml"));
    fs::write(&pair, "[throttle]\nmin = 0.05\nmax = 1\n[pair]\n").unwrap();
    let output = run(&[
        "new", "--frame", "x8", "--arm", "0.45", "--pair", &pair, "-o", &file,
    ]);
    assert_status(&output, 1);
    assert!(stderr(&output).contains("error[MIX003]"), "{}", stderr(&output));
    assert!(!Path::new(&file).exists());
    for arguments in [
        &["new", "--frame", "x8", "-o", &file][..],
        &["new", "--frame", "single", "--arm", "1", "-o", &file],
        &["new", "-o", &file],
    ] {
        assert_status(&run(arguments), 2);
    }
}

#[test]
fn identify_writes_a_whole_airframe() {
    let (bench, pair, file) = (bench("map.csv"), path("pair.toml"), path("my-frame.toml"));
    let output = run(&["identify", &bench, "--frame", "x8", "--arm", "0.45", "-o", &file]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_status(&run(&["check", "--deny-warnings", &file]), 0);
    let text = fs::read_to_string(&file).unwrap();
    for part in [
        "name = \"my-frame\"",
        "# Identified by cargo mixer identify",
        "map.csv",
        "arm_m = 0.45",
    ] {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
    assert!(!text.contains("To make an airframe of it"), "{text}");
    // The tables alone and `new` come to the same.
    assert_eq!(
        run(&["identify", &bench, "-o", &pair, "--force"]).status.code(),
        Some(0)
    );
    let other = path("other.toml");
    let output = run(&[
        "new", "--frame", "x8", "--arm", "0.45", "--pair", &pair, "--name", "my-frame", "-o", &other,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = fs::read_to_string(&other).unwrap();
    assert!(!text.contains("To make an airframe of it"), "{text}");
    let values = |file: &str| fs::read_to_string(file).unwrap().parse::<toml::Table>().unwrap();
    assert_eq!(values(&file), values(&other));
    // Nothing is overwritten by accident.
    assert_status(&run(&["identify", &bench, "-o", &pair]), 1);
    assert_eq!(
        run(&["identify", &bench, "-o", &pair, "--force"]).status.code(),
        Some(0)
    );
    assert_status(&run(&["identify", &bench, "--arm", "0.45"]), 2);
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_is_written_to() {
    let arguments = ["new", "--frame", "single", "--name", "a", "-o", "/dev/stdout"];
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("name = \"a\""), "{}", stdout(&output));
}

/// The stand-in for a bench that docs/first-airframe.md takes has no noise: what its rounding
/// leaves is no outlier.
#[test]
fn the_stand_in_for_a_bench_has_no_row_that_stands_out() {
    let (bench, pair) = (path("sweep.csv"), path("of-sweep.toml"));
    let sweep = run(&[
        "sweep",
        "airframes/isae-x8.toml",
        "--figure",
        "forward",
        "-o",
        &bench,
        "--force",
    ]);
    assert_eq!(sweep.status.code(), Some(0), "{}", stderr(&sweep));
    let output = run(&["identify", &bench, "-o", &pair, "--force"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = stdout(&output);
    assert!(told.contains("no row stands out"), "{told}");
}

/// A file that warns is written, and its warnings are of what is there.
#[test]
fn warnings_are_of_the_file_that_is_written() {
    let file = path("long.toml");
    let output = run(&["new", "--frame", "x8", "--arm", "45", "-o", &file]);
    let told = stderr(&output);
    assert!(output.status.success(), "{told}");
    assert!(
        told.contains("warning[MIX310]") && told.contains(&format!("--> {file}:26:9")),
        "{told}"
    );
    assert!(
        !told.contains("not written") && told.contains(&format!("wrote {file}")),
        "{told}"
    );
}

/// Verdict and warnings stay on one screen; `--verbose` shows the places.
#[test]
fn several_warnings_are_a_line_each() {
    let file = path("several.toml");
    assert!(
        run(&["new", "--frame", "x8", "--arm", "45", "-o", &file])
            .status
            .success()
    );
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text + "\n[vehicle]\nmass_kg = 300.0\n").unwrap();
    let output = run(&["check", &file]);
    let told = stderr(&output);
    let is_warning = |line: &str| line.starts_with(&file) && line.contains(": warning[MIX");
    assert!(
        told.lines().count() >= 2 && told.lines().all(is_warning),
        "{told}"
    );
    assert!(
        stdout(&output).lines().count() + told.lines().count() <= 30,
        "{told}"
    );
    assert!(stderr(&run(&["check", "--verbose", &file])).contains("   = help: "));
}
