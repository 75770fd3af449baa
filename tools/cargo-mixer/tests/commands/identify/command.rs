//! The command itself: files, statuses, streams.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::sweep::{bench, plain, rows, settings};
use crate::{bench_data, folder};

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
fn json_and_the_fragment_agree() {
    let folder = folder("identify-json");
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
fn streams_that_nobody_reads_change_no_status() {
    let folder = folder("identify-unread");
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
fn columns_and_signs_by_hand() {
    let folder = folder("identify-by-hand");
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

/// The run that docs/bench.md explains. `tests/run --stage bench-data` writes it.
#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn the_report_of_the_documents_is_that_of_the_bench() {
    const FILE: &str =
        "data2021_08_17_23_41_12_16p2in_prop_400kv_22V_MN4014_T_motor_map10x10_full_range_zD_025.csv";
    let data = bench_data();
    let arguments = ["--voltage-exponent", "1.75", "--cells", "6"];
    let output = run(&data.join("newdexterity"), &[&[FILE][..], &arguments].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/bench.md");
    let written = fs::read_to_string(&page).expect("the page");
    let (before, rest) = written.split_once("<!-- identify -->").expect("a place");
    let (_, after) = rest.split_once("<!-- end -->").expect("an end");
    let command = format!("$ cargo mixer identify {FILE} {}", arguments.join(" "));
    let now = format!("{before}<!-- identify -->\n\n```console\n{command}\n{told}```\n\n<!-- end -->{after}");
    if std::env::var_os("MIXER_MEASUREMENTS").is_some_and(|word| word == "write") {
        fs::write(&page, &now).expect("written");
    }
    assert!(
        fs::read_to_string(&page).expect("the page") == now,
        "run `tests/run --stage bench-data`"
    );
}
