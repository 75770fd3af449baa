//! The command itself: files, statuses, streams.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::sweep::{bench, plain, rows, settings};

/// A folder of this test's own, empty.
pub(crate) fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("identify-{test}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder");
    path
}

fn run(folder: &Path, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
    command
        .current_dir(folder)
        .args(["mixer", "identify"])
        .args(args)
        .output()
        .expect("the program runs")
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

#[test]
fn writes_a_fragment_that_completes_to_an_airframe() {
    let folder = folder("fragment");
    fs::write(folder.join("map_2024-05-06.csv"), plain(&rows(1))).expect("written");
    let output = run(&folder, &["map_2024-05-06.csv", "-o", "pair.toml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let fragment = fs::read_to_string(folder.join("pair.toml")).expect("the fragment");
    let mut names: Vec<_> = fs::read_dir(&folder)
        .expect("a folder")
        .flatten()
        .map(|e| e.file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["map_2024-05-06.csv", "pair.toml"],
        "no temporary file stays"
    );
    for provenance in [
        "map_2024-05-06.csv",
        "2024-05-06",
        "100 of 100 rows used",
        "R2 9",
        "leave-one-out",
        "[[unit]]",
    ] {
        assert!(fragment.contains(provenance), "{provenance} in\n{fragment}");
    }
    let unit = "[[unit]]\nposition_m = [0.0, 0.0, 0.0]\nupper_spin = \"cw\"\nchannels = [0, 1]\n";
    let airframe: toml::Table = format!("name = \"x\"\n{fragment}\n{unit}").parse().expect("TOML");
    assert_eq!(airframe["pair"]["upper_spin"].as_str(), Some("cw"));
    assert_eq!(airframe["pair"]["thrust_n"].as_array().map(Vec::len), Some(8));
    let min = airframe["throttle"]["min"].as_float().expect("an idle");
    assert!((0.1..0.12).contains(&min), "{min}");
    for line in text(&output.stdout).lines() {
        assert!(line.chars().count() <= 100, "wider than 100 columns: {line}");
    }
}

#[test]
fn json_and_the_fragment_agree() {
    let folder = folder("json");
    fs::write(folder.join("map.csv"), plain(&rows(2))).expect("written");
    let output = run(
        &folder,
        &["map.csv", "--json", "--basis", "cubic", "-o", "pair.toml"],
    );
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let toml: toml::Table = fs::read_to_string(folder.join("pair.toml"))
        .expect("read")
        .parse()
        .expect("TOML");
    assert_eq!(json["pair"]["basis"], "cubic");
    for key in ["thrust_n", "torque_nm"] {
        let of_json: Vec<f64> = serde_json::from_value(json["pair"][key].clone()).expect("numbers");
        let of_toml: Vec<f64> = toml["pair"][key]
            .as_array()
            .expect("an array")
            .iter()
            .flat_map(|v| v.as_float())
            .collect();
        assert_eq!((of_json.len(), &of_json), (9, &of_toml));
    }
    for key in [
        "r2",
        "residual_rms",
        "residual_max",
        "leave_one_out_rms",
        "condition_number",
        "full_scale",
    ] {
        assert!(
            json["pair"]["thrust"][key].as_f64().is_some_and(|x| x > 0.0),
            "{key}"
        );
    }
    assert_eq!(json["pair"]["thrust"]["ci95"].as_array().map(Vec::len), Some(9));
    assert_eq!(json["files"][0]["points_used"], 100);
    assert_eq!(json["voltage"]["thrust"]["status"], "refused");
}

#[test]
fn statuses_and_streams() {
    let folder = folder("statuses");
    fs::write(folder.join("map.csv"), plain(&rows(3))).expect("written");
    fs::write(folder.join("bad.csv"), "a,b\n1,2\n").expect("written");
    let status = |args: &[&str]| run(&folder, args).status.code();
    assert_eq!(status(&["map.csv"]), Some(0));
    assert_eq!(status(&["bad.csv", "-o", "out.toml"]), Some(1));
    assert_eq!(status(&["missing.csv"]), Some(1));
    assert_eq!(status(&["map.csv", "bad.csv", "-o", "out.toml"]), Some(1));
    assert!(
        !folder.join("out.toml").exists(),
        "nothing is written when a file is refused"
    );
    assert_eq!(status(&["map.csv", "-o", "no/such/folder/out.toml"]), Some(1));
    for usage in [
        &["map.csv", "-o", "map.csv"][..],
        &["map.csv", "--json", "-o", "-"],
        &["map.csv", "--throttle", "0.5,0.2"],
        &["map.csv", "--column", "up=x"],
        &["map.csv", "--torque-sign", "x"],
        &["map.csv", "--date", "yesterday"],
        &["map.csv", "--basis", "quintic"],
        &["map.csv", "--voltage-exponent", "0"],
        &["map.csv", "--voltage-exponent", "1.7,x"],
        &[],
    ] {
        assert_eq!(status(usage), Some(2), "{usage:?}");
    }
    assert_eq!(
        fs::read(folder.join("map.csv")).expect("read"),
        plain(&rows(3)),
        "the input stays as it was"
    );
    let both = text(&run(&folder, &["bad.csv", "missing.csv"]).stderr);
    assert!(
        both.contains("bad.csv:1: no throttle column") && both.contains("missing.csv: cannot be read"),
        "{both}"
    );
    let output = run(&folder, &["map.csv", "-o", "-"]);
    assert!(
        text(&output.stdout)
            .parse::<toml::Table>()
            .expect("TOML")
            .contains_key("pair")
    );
    assert!(text(&output.stderr).contains("model error "));
}

#[test]
fn streams_that_nobody_reads_change_no_status() {
    let folder = folder("unread");
    fs::write(folder.join("map.csv"), plain(&rows(3))).expect("written");
    fs::write(folder.join("bad.csv"), "a,b\n1,2\n").expect("written");
    for (args, status) in [
        (&["map.csv"][..], 0),
        (&["map.csv", "-o", "out.toml"], 0),
        (&["bad.csv"], 1),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-mixer"));
        command
            .current_dir(&folder)
            .args(["mixer", "identify"])
            .args(args);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program runs");
        drop((child.stdout.take(), child.stderr.take()));
        let found = child.wait().expect("it ends");
        assert_eq!(found.code(), Some(status), "{args:?}");
    }
    assert!(folder.join("out.toml").exists());
}

#[test]
fn refused_rows_are_named_on_standard_error() {
    let folder = folder("rows");
    let mut bytes = plain(&rows(4));
    bytes.extend(b"0.5,oops,1,1,14\n");
    fs::write(folder.join("map.csv"), bytes).expect("written");
    let output = run(&folder, &["map.csv"]);
    assert!(output.status.success());
    let told = text(&output.stderr);
    assert!(
        told.contains("refused: map.csv:102: \"lower\" = \"oops\" is not a finite number"),
        "{told}"
    );
    assert!(text(&output.stdout).contains("1 refused"));
}

#[test]
fn columns_and_signs_by_hand() {
    let folder = folder("by-hand");
    let mut file = "one;two;F;M\n".to_string();
    for r in rows(5) {
        let (f, q) = (r.thrust[0] + r.thrust[1], r.torque[0] + r.torque[1]);
        file += &format!(
            "{:?};{:?};{:?};{:?}\n",
            1100.0 + 800.0 * r.u,
            1100.0 + 800.0 * r.l,
            -1000.0 * f,
            1000.0 * q
        );
    }
    fs::write(folder.join("odd.csv"), file).expect("written");
    let by_hand = [
        "odd.csv",
        "--json",
        "--basis=biquadratic",
        "--column=upper=one",
        "--column=lower=#2",
        "--column=thrust=F",
        "--unit=thrust=mN",
        "--column=torque=M",
        "--unit=torque=mN·m",
        "--pwm-range=1100,1900",
        "--thrust-sign=-",
        "--torque-sign=+",
    ];
    let output = run(&folder, &by_hand);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    fs::write(folder.join("map.csv"), plain(&rows(5))).expect("written");
    let plain = run(&folder, &["map.csv", "--json", "--basis=biquadratic"]);
    let reference: serde_json::Value = serde_json::from_slice(&plain.stdout).expect("JSON");
    for key in ["thrust_n", "torque_nm"] {
        for k in 0..8 {
            let [a, b] = [&json, &reference].map(|j| j["pair"][key][k].as_f64().expect("a number"));
            assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{key} {k}: {a} {b}");
        }
    }
    assert_eq!(json["files"][0]["signs"]["thrust"][0], -1.0);
    assert_eq!(json["files"][0]["signs"]["thrust_policy"], "given");
    assert_eq!(reference["files"][0]["signs"]["thrust_policy"], "auto");
}

#[test]
fn sixteen_thousand_rows_are_read_in_well_under_a_second() {
    let mut log =
        "\u{feff}Time (s),ESC A (µs),ESC B (µs),Servo 1 (µs),AccX (g),Torque (N·m),Thrust (gf),Voltage (V),\
                   Current (A),Motor Electrical Speed (RPM),Electrical Power (W),App message,\n"
            .to_string();
    for (k, r) in rows(6).iter().enumerate() {
        for step in 0..160 {
            log += &format!(
                "{}.{step:03}4578300000037998,{},{},,0.012109375,{:?},{:?},14.8123456789,1.23456789,3456,12.3456789,,\n",
                k,
                1000.0 + 1000.0 * r.u,
                1000.0 + 1000.0 * r.l,
                r.torque[0] + r.torque[1],
                (r.thrust[0] + r.thrust[1]) / 0.00980665,
            );
        }
    }
    // The best of three: other tests share the machine.
    let read = || {
        let start = Instant::now();
        let bench = bench("log.csv", log.as_bytes(), &settings(None)).expect("a bench");
        assert_eq!((bench.rows, bench.points_used), (16_000, 100));
        start.elapsed()
    };
    let best = (0..3).map(|_| read()).min().expect("a time");
    assert!(best < Duration::from_millis(700), "{best:?} without optimisation");
}

/// Messages do not grow with the input: megabytes of a broken file give a few lines.
#[test]
fn messages_of_broken_files_are_short() {
    let folder = folder("broken");
    let header = "upper,lower,thrust_n,torque_nm\n";
    let bad_rows: String = (0..50_000).map(|k| format!("0.5,none-{k},1,0.1\n")).collect();
    let texts = [
        format!("{header}0.5,0.5,{},1\n", "9".repeat(1_000_000)),
        "x".repeat(1_000_000),
        "c,".repeat(100_000),
        text(&plain(&rows(1))) + &bad_rows,
    ];
    for (k, broken) in texts.iter().enumerate() {
        fs::write(folder.join("broken.csv"), broken).expect("written");
        let output = run(&folder, &["broken.csv"]);
        let told = output.stderr.len();
        assert!((1..25_000).contains(&told), "{k}: {told} bytes");
        assert!(!text(&output.stderr).contains("panicked"), "{k}");
    }
}
