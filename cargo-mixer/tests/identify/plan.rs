//! `cargo mixer plan`, filled in and identified.

use std::fs;

use mixer_compiler::airframe::Basis;
use mixer_identify::fit::polynomial::Polynomial;

use crate::command::{folder, text};
use mixer_identify::paper::{THRUST, TORQUE};

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

/// The Flight Stand software as the script sees it: a board per rotor, the lower one mounted upside
/// down, and the pair of the sweeps behind them. @THRUST@ and @TORQUE@ are its coefficients.
const FLIGHT_STAND: &str = r#"
import time
from types import SimpleNamespace as Any

clock = 0.0
def sleep(seconds):
    global clock
    clock += seconds
time.sleep = sleep

FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT, ESC = 11, 14, 6, 8, 1
OutputTarget = Output = UpdateOutputRequest = Any
ListOutputsRequest = ListInputsRequest = ListSamplesRequest = ListBoardsRequest = TareInputsRequest = Any
NAMES = ["/boards/A", "/boards/B"]
pulses = {name: None for name in NAMES}

class FlightStandStub:
    def __init__(self, channel):
        pass

    def ListBoards(self, _):
        return Any(boards=[Any(name=name, display_name="simulated") for name in NAMES])

    def ListOutputs(self, _):
        return Any(outputs=[Any(name=name + "/outputs/0", output_type=ESC) for name in NAMES])

    def ListInputs(self, _):
        kinds = [FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT]
        return Any(inputs=[
            Any(name=f"{name}/inputs/{kind}", input_type=kind, signal_name=f"{name}:{kind}")
            for name in NAMES for kind in kinds])

    def TareInputs(self, _):
        assert all(pulse is None for pulse in pulses.values())

    def UpdateOutput(self, request):
        assert request.mask.paths == ["output_target"]
        target = request.output.output_target
        board = request.output.name.removesuffix("/outputs/0")
        now, last = target.target_value, pulses[board]
        assert 1100 <= now <= 1900 and (last is None or abs(now - last) < 41), (last, now)
        pulses[board] = now if target.active else None
        if not target.active:
            print("stopped", board, now)

    def ListSamples(self, _):
        u, l = [(pulses[name] - 1100) / 800 for name in NAMES]
        powers = [u*u*l*l, u*u*l, u*u, u*l*l, u*l, u, l*l, l]
        f, q = [sum(c * x for c, x in zip(of, powers)) for of in (@THRUST@, @TORQUE@)]
        values = [
            (f / 2, q - 0.1 * l, 14.8, 20 * u**3),
            (-f / 2, 0.1 * l, 14.6, 18 * l**3)]
        kinds = [FORCE_FZ, TORQUE_MZ, VOLTAGE_HV_INPUT, CURRENT_HALL_CURRENT]
        return Any(sample_group=Any(samples=[
            Any(signal_name=f"{name}:{kind}", value=value, active=True)
            for name, of in zip(NAMES, values) for kind, value in zip(kinds, of)]))
"#;

#[test]
fn the_script_for_the_flight_stand_measures_the_pair() {
    let folder = folder("plan-flight-stand");
    let range = ["--pwm-range", "1100,1900"];
    let plan = [
        "plan",
        "--min",
        "0.1",
        "--format",
        "flight-stand",
        "-o",
        "plan.py",
    ];
    let output = run(&folder, &[&plan[..], &range[..]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let stand_in = FLIGHT_STAND
        .replace("@THRUST@", &format!("{THRUST:?}"))
        .replace("@TORQUE@", &format!("{TORQUE:?}"));
    fs::create_dir_all(folder.join("google/protobuf")).expect("a folder");
    for (name, contents) in [
        ("flight_stand_api_v1_pb2.py", stand_in.as_str()),
        (
            "flight_stand_api_v1_pb2_grpc.py",
            "from flight_stand_api_v1_pb2 import *\n",
        ),
        ("grpc.py", "def insecure_channel(address):\n    return address\n"),
        (
            "google/protobuf/field_mask_pb2.py",
            "from types import SimpleNamespace as FieldMask\n",
        ),
    ] {
        fs::write(folder.join(name), contents).expect("written");
    }
    let python = |args: &[&str]| {
        std::process::Command::new("python3")
            .current_dir(&folder)
            .env("PYTHONPATH", &folder)
            .args(args)
            .output()
            .expect("python3")
    };
    let listed = python(&["plan.py"]);
    assert!(!listed.status.success() && text(&listed.stdout).contains("/boards/A simulated"));
    let boards = [
        "plan.py",
        "--upper",
        "/boards/A",
        "--lower",
        "/boards/B",
        "-o",
        "map.csv",
    ];
    let output = python(&boards);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    assert!(
        told.contains("pair 25 of 25")
            && told.ends_with("stopped /boards/A 1100.0\nstopped /boards/B 1100.0\n"),
        "{told}"
    );
    let output = run(
        &folder,
        &["identify", "map.csv", "--basis", "biquadratic", "--json"],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["files"][0]["points_used"], 25);
    for (key, truth) in [("thrust_n", THRUST), ("torque_nm", TORQUE)] {
        let found = json["pair"][key].as_array().expect("numbers");
        for (c, truth) in found.iter().zip(truth) {
            let c = c.as_f64().expect("a number");
            assert!((c - truth).abs() < 1e-6, "{key}: {c} {truth}");
        }
    }
    assert!(json["power"]["bias_nm_per_n"].is_number(), "{}", json["power"]);
}
