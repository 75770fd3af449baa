//! An independent oracle in Python judges the mixers: thousands of random setpoints and voltages,
//! and every golden vector, against the forward physics of the airframe file.
#![allow(missing_docs)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use cargo_mixer::commands::mix::MIX;
use cargo_mixer::rows::answer;
use mixer_compiler::Compiled;
use mixer_rt::Health;
use mixer_tests::{airframes, frames, golden, root};

/// Random setpoints per frame.
const SETPOINTS: usize = 500;

/// Of the frames, and how many are drawn.
const SEED: u64 = 1;
const FRAMES: u64 = 12;

/// The columns of a golden table that a mixer is asked.
const ASKED: [&str; 6] = [
    "roll_nm",
    "pitch_nm",
    "yaw_nm",
    "thrust_n",
    "voltage_v",
    "density_kg_m3",
];

fn oracle(arguments: &[&str]) -> Output {
    Command::new("python3")
        .arg(root().join("tests/oracle.py"))
        .args(arguments)
        .current_dir(root())
        .output()
        .unwrap_or_else(|error| panic!("the oracle needs python3 (3.11 or later): {error}"))
}

fn scratch(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Has the oracle judge `mixed`; panics with its list of faults.
fn judge(airframe: &str, name: &str, setpoints: &str, mixed: &str) -> String {
    judge_with(airframe, name, setpoints, mixed, &[])
}

/// [`judge`] with the channels of the rotors that are out, if any.
fn judge_with(airframe: &str, name: &str, setpoints: &str, mixed: &str, failed: &[&str]) -> String {
    let (asked, answered) = (
        scratch(&format!("{name}.setpoints.csv")),
        scratch(&format!("{name}.mixed.csv")),
    );
    fs::write(&asked, setpoints).expect("scratch folder");
    fs::write(&answered, mixed).expect("scratch folder");
    let files = [&asked, &answered].map(|path| path.display().to_string());
    let arguments = [&["judge", airframe, &files[0], &files[1]], failed].concat();
    let verdict = oracle(&arguments);
    let said = String::from_utf8_lossy(&verdict.stdout).into_owned();
    assert!(
        verdict.status.success(),
        "{name}: {said}{}",
        String::from_utf8_lossy(&verdict.stderr)
    );
    said
}

/// The answer of the mixer to setpoints in CSV, as `cargo mixer mix` gives it.
fn mix(path: &str, setpoints: &str) -> String {
    mix_with(path, Health::GOOD, setpoints)
}

fn compiled(path: &str) -> Compiled {
    let text = fs::read_to_string(root().join(path)).expect(path);
    let compiled = mixer_compiler::compile(&mixer_compiler::Source::new(path, text));
    compiled.unwrap_or_else(|faults| panic!("{faults}"))
}

/// [`mix`] with rotors out.
fn mix_with(path: &str, health: Health, setpoints: &str) -> String {
    let compiled = compiled(path);
    let mut mixed = Vec::new();
    let bad = answer(&MIX, &compiled, health, setpoints.as_bytes(), &mut mixed, |bad| {
        eprintln!("{bad:?}")
    });
    assert!(matches!(bad, Ok(0)), "{bad:?}");
    String::from_utf8(mixed).expect("CSV is UTF-8")
}

/// Frames of the zoo, written to files: each class at least once. The golden vectors judge the
/// airframes of the project.
fn files() -> Vec<String> {
    let zoo = frames::zoo(SEED).expect("airframes/");
    let write = |index| {
        let text = zoo.specimen(index).text;
        frames::compile_text(&text).ok()?;
        let path = scratch(&format!("zoo-{index}.toml"));
        fs::write(&path, text).expect("scratch folder");
        Some(path.display().to_string())
    };
    (0..FRAMES).filter_map(write).collect()
}

#[test]
fn random_setpoints_are_mixed_as_the_physics_demand() {
    for (seed, file) in files().iter().enumerate() {
        let drawn = oracle(&["draw", file, &SETPOINTS.to_string(), &seed.to_string()]);
        assert!(
            drawn.status.success(),
            "{}",
            String::from_utf8_lossy(&drawn.stderr)
        );
        let setpoints = String::from_utf8(drawn.stdout).expect("CSV is UTF-8");
        let name = Path::new(file).file_stem().expect("name").to_string_lossy();
        let said = judge(
            file,
            &format!("random.{name}"),
            &setpoints,
            &mix(file, &setpoints),
        );
        print!("{file}: {said}");
        let attainable: usize = said
            .split(", ")
            .nth(1)
            .and_then(|part| part.split(' ').next()?.parse().ok())
            .expect("count");
        assert!(
            attainable >= SETPOINTS / 30,
            "{file}: only {attainable} setpoints tested the inverse map"
        );
    }
}

#[test]
fn golden_vectors_are_as_the_physics_demand() {
    for name in airframes().expect("airframes/") {
        let table = fs::read_to_string(golden::folder().join(format!("{name}.vectors.csv"))).expect("golden");
        let header = table.lines().next().expect("header");
        let split = |line: &str, is_asked: bool| {
            let cells = line.split(',').zip(header.split(','));
            let cells = cells.filter(|(_, column)| is_asked == ASKED.contains(column));
            cells.map(|(cell, _)| decimal(cell)).collect::<Vec<_>>().join(",")
        };
        let (mut setpoints, mut mixed) = (String::new(), String::new());
        for line in table.lines() {
            let _ = writeln!(setpoints, "{}", split(line, true));
            let _ = writeln!(mixed, "{}", split(line, false));
        }
        judge(
            &format!("airframes/{name}.toml"),
            &format!("golden.{name}"),
            &setpoints,
            &mixed,
        );
    }
}

/// A cell of a golden table for the oracle: bits become the shortest decimal of the float.
fn decimal(cell: &str) -> String {
    match cell.strip_prefix("0x") {
        Some(digits) => format!(
            "{:?}",
            f32::from_bits(u32::from_str_radix(digits, 16).expect("bits"))
        ),
        None => cell.to_owned(),
    }
}

/// The judge must condemn what is wrong: one fault at a time in an otherwise right answer.
#[test]
fn the_oracle_finds_planted_faults() {
    let file = "airframes/isae-x8.toml";
    let setpoints =
        "roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v\n0.5,-0.3,0.1,31.0,15.0\n0.0,0.0,5.0,60.0,14.8\n";
    let mixed = mix(file, setpoints);
    judge(file, "planted.none", setpoints, &mixed);
    let rows: Vec<Vec<&str>> = mixed.lines().map(|line| line.split(',').collect()).collect();
    let spoilt = |row: usize, column: usize, value: &str| {
        let mut rows = rows.clone();
        rows[row][column] = value;
        rows.iter().map(|row| row.join(",") + "\n").collect::<String>()
    };
    let faults = [
        ("throttle out of range", spoilt(1, 0, "0.0999")),
        ("throttle off", spoilt(1, 3, "0.5")),
        ("untrue thrust", spoilt(1, 11, "31.2")),
        ("flag without cause", spoilt(1, 12, "16")),
        ("missing flag", spoilt(2, 12, "0")),
        ("voltage flag", spoilt(1, 12, "256")),
        (
            "missing row",
            mixed.lines().take(2).map(|line| format!("{line}\n")).collect(),
        ),
    ];
    for (what, answer) in faults {
        let (asked, answered) = (scratch("planted.setpoints.csv"), scratch("planted.mixed.csv"));
        fs::write(&asked, setpoints).expect("scratch folder");
        fs::write(&answered, answer).expect("scratch folder");
        let verdict = oracle(&[
            "judge",
            file,
            &asked.display().to_string(),
            &answered.display().to_string(),
        ]);
        assert!(!verdict.status.success(), "{what} went unnoticed");
    }
}

/// A mixer that ignores the density, or does not say that it clamped it, is condemned.
#[test]
fn the_oracle_finds_an_ignored_density() {
    let file = "airframes/x8-11in-least-power.toml";
    let setpoints = "roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v,density_kg_m3\n0.5,-0.3,0.1,31.0,11.0,0.9\n";
    judge(file, "density.own", setpoints, &mix(file, setpoints));
    for other in [setpoints.replace("0.9", "1.2"), setpoints.replace("0.9", "0.0")] {
        let (asked, answered) = (scratch("density.setpoints.csv"), scratch("density.mixed.csv"));
        fs::write(&asked, setpoints).expect("scratch folder");
        fs::write(&answered, mix(file, &other)).expect("scratch folder");
        let files = [&asked, &answered].map(|path| path.display().to_string());
        let verdict = oracle(&["judge", file, &files[0], &files[1]]);
        assert!(!verdict.status.success(), "{other}");
    }
}

/// A mixer that leaves the power bias out, or takes another, is condemned.
#[test]
fn the_oracle_finds_a_missing_power_bias() {
    let file = "tests/fixtures/power-bias-x12.toml";
    let setpoints =
        "roll_nm,pitch_nm,yaw_nm,thrust_n,voltage_v\n0.5,-0.3,0.1,62.0,15.0\n0.0,0.0,0.0,70.0,14.0\n";
    judge(file, "bias.own", setpoints, &mix(file, setpoints));
    let text = fs::read_to_string(root().join(file)).expect(file);
    for bias in ["0.0", "0.004", "-0.005"] {
        let other = scratch(&format!("bias{bias}.toml"));
        let changed = text.replace(
            "power_bias_nm_per_n = -0.004",
            &format!("power_bias_nm_per_n = {bias}"),
        );
        assert_ne!(changed, text);
        fs::write(&other, changed).expect("scratch folder");
        let (asked, answered) = (scratch("bias.setpoints.csv"), scratch("bias.mixed.csv"));
        fs::write(&asked, setpoints).expect("scratch folder");
        fs::write(&answered, mix(&other.display().to_string(), setpoints)).expect("scratch folder");
        let files = [&asked, &answered].map(|path| path.display().to_string());
        let verdict = oracle(&["judge", file, &files[0], &files[1]]);
        assert!(!verdict.status.success(), "a bias of {bias} went unnoticed");
    }
}

#[test]
fn setpoints_with_rotors_out_are_mixed_as_the_physics_demand() {
    for (seed, file) in files().iter().enumerate() {
        let drawn = oracle(&["draw", file, "120", &(100 + seed).to_string()]);
        let setpoints = String::from_utf8(drawn.stdout).expect("CSV is UTF-8");
        let name = Path::new(file).file_stem().expect("name").to_string_lossy();
        let rotors = compiled(file).airframe.rotors() as u8;
        // One rotor of each layer, and where there are enough two of different units.
        for failed in [vec![0], vec![rotors - 1], vec![0, rotors / 2 + 1]] {
            if failed.len() > 1 && rotors < 8 {
                continue;
            }
            let health = failed
                .iter()
                .fold(Health::GOOD, |health, &channel| health.with_failed(channel));
            let channels: Vec<String> = failed.iter().map(u8::to_string).collect();
            let channels = channels.join(",");
            let said = judge_with(
                file,
                &format!("out.{name}.{channels}"),
                &setpoints,
                &mix_with(file, health, &setpoints),
                &[&channels],
            );
            print!("{file}, {channels} out: {said}");
        }
    }
}

/// Where the file declares what the polynomials at zero give, the bits are those of the file that
/// does not.
#[test]
fn a_declared_curve_is_the_polynomial_where_it_says_the_same() {
    let file = "airframes/isae-x8.toml";
    let text = fs::read_to_string(root().join(file)).expect(file);
    let declared = text.replace(
        "[voltage]",
        "[pair.lower_out]\nthrust_n = [2.7640, 12.3604, 0.0]\ntorque_nm = [-0.0907, -0.1312, 0.0]\n\n\
         [pair.upper_out]\nthrust_n = [0.2363, 12.2092, 0.0]\ntorque_nm = [0.0720, 0.1441, 0.0]\n\n[voltage]",
    );
    let of = |text: String| {
        let compiled = mixer_compiler::compile(&mixer_compiler::Source::new(file, text));
        compiled.unwrap_or_else(|faults| panic!("{faults}")).tables
    };
    let (plain, declared) = (of(text), of(declared));
    assert_eq!(plain, declared);
}
