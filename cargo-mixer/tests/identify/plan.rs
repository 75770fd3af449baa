//! `cargo mixer plan`, filled in and identified.

use std::fs;

use cargo_mixer::identify::polynomial::Polynomial;
use mixer_compiler::airframe::Basis;

use crate::command::{folder, text};
use crate::sweep::{THRUST, TORQUE};

fn run(folder: &std::path::Path, args: &[&str]) -> std::process::Output {
    std::process::Command::new(env!("CARGO_BIN_EXE_cargo-mixer"))
        .current_dir(folder)
        .args(args)
        .output()
        .expect("the program runs")
}

#[test]
fn a_filled_template_is_identified() {
    let folder = folder("plan");
    let output = run(
        &folder,
        &["plan", "--levels", "5", "--min", "0.07", "-o", "plan.csv"],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let plan = fs::read_to_string(folder.join("plan.csv")).expect("the plan");
    let [f, q] = [&THRUST, &TORQUE].map(|c| Polynomial::of(Basis::Biquadratic, c));
    let mut lines = plan.lines();
    let mut filled = format!("{}\n", lines.next().expect("a header"));
    for line in lines {
        let throttles: Vec<f64> = line
            .split(',')
            .take(2)
            .map(|x| x.parse().expect("a throttle"))
            .collect();
        let (u, l) = (throttles[0], throttles[1]);
        filled += &format!("{u},{l},{},{},14.8,14.9,,\n", f.at(u, l), q.at(u, l));
    }
    fs::write(folder.join("filled.csv"), &filled).expect("written");
    let output = run(
        &folder,
        &["identify", "filled.csv", "--basis", "biquadratic", "--json"],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["files"][0]["points_used"], 25);
    assert_eq!(json["voltage"]["range_v"], serde_json::json!([14.8, 14.8]));
    for (c, truth) in json["pair"]["thrust_n"]
        .as_array()
        .expect("numbers")
        .iter()
        .zip(THRUST)
    {
        assert!(
            (c.as_f64().expect("a number") - truth).abs() < 1e-6,
            "{c} {truth}"
        );
    }

    // As it comes it is refused with the reason, and a plan is not overwritten.
    let output = run(&folder, &["identify", "plan.csv"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        text(&output.stderr).contains("the thrust is empty")
            || text(&output.stderr).contains("is empty in every row")
    );
    assert_eq!(
        run(&folder, &["plan", "--min", "0.1", "-o", "plan.csv"])
            .status
            .code(),
        Some(1)
    );
    assert_eq!(
        run(&folder, &["plan", "--min", "0.1", "-o", "plan.csv", "--force"])
            .status
            .code(),
        Some(0)
    );
    for usage in [
        &["plan"][..],
        &["plan", "--min", "0.1", "--levels", "3"],
        &["plan", "--min", "1.0"],
        &["plan", "--min", "7"],
    ] {
        assert_eq!(run(&folder, usage).status.code(), Some(2), "{usage:?}");
    }
}
