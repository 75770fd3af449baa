//! Flight logs of `MIXER_BENCH_DATA`, one of each stack, flown with a plant of the airframe's own map.

use std::fs;

use serde_json::Value;

use crate::{bench_data, folder, run_with};

/// A log of the data, unpacked.
fn unpacked(data: &std::path::Path, name: &str, into: &std::path::Path) -> String {
    let mut log = Vec::new();
    let packed = fs::read(data.join("logs").join(format!("{name}.xz"))).unwrap();
    lzma_rs::xz_decompress(&mut &packed[..], &mut log).unwrap();
    let path = into.join(name);
    fs::write(&path, log).unwrap();
    path.display().to_string()
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn both_stacks_logs_have_the_scale_of_their_plant() {
    let data = bench_data();
    let folder = folder("review");
    let airframe = data.join("logs/x8-log.toml").display().to_string();
    let of = |log: &str, more: &[&str]| {
        let output = run_with(&[&["review", log, &airframe, "--json"], more].concat(), b"");
        let text = String::from_utf8(output.stdout).unwrap();
        let json: Value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        (json, output.status.code())
    };
    let number = |json: &Value, at: &str| {
        json.pointer(at)
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("{at} in {json}"))
    };
    for (name, stack, stopped, by) in [
        ("px4-x8-lower-stopped.ulg", "px4", 1, "mixer"),
        ("ardupilot-x8-yaw.bin", "ardupilot", 0, "controllers"),
    ] {
        let log = unpacked(&data, name, &folder);
        let (json, status) = of(&log, &[]);
        assert_eq!((status, json["stack"].as_str()), (Some(0), Some(stack)));
        let scale = number(&json, "/thrust/scale");
        assert!((scale - 1.0).abs() < 0.01, "{name}: {scale}");
        let [low, high] = [0, 1].map(|k| number(&json, &format!("/thrust/interval/{k}")));
        assert!(
            low < 1.0 && 1.0 < high && high - low < 0.03,
            "{name}: {low} to {high}"
        );
        assert!(
            (number(&json, "/hover/upper") - number(&json, "/hover/model/0")).abs() < 0.01,
            "{json}"
        );
        assert!(
            (number(&json, "/hover/lower") - number(&json, "/hover/model/1")).abs() < 0.01,
            "{json}"
        );
        assert!(number(&json, "/hover/yaw_nm").abs() < 0.01, "{json}");
        assert_eq!(json["saturated"]["by"], by);
        assert_eq!(json["stopped"].as_array().unwrap().len(), stopped);
        // A mass that is 10 % off is 10 % of the scale.
        let (heavy, _) = of(&log, &["--mass", "6.6"]);
        assert!(
            (number(&heavy, "/thrust/scale") * 1.1 / scale - 1.0).abs() < 2e-3,
            "{heavy}"
        );
    }
    // Another vehicle's airframe.
    let y6 = run_with(
        &[
            "review",
            &folder.join("ardupilot-x8-yaw.bin").display().to_string(),
            "airframes/px4-y6.toml",
            "--json",
        ],
        b"",
    );
    assert_eq!(y6.status.code(), Some(1));
    let errors: Value = serde_json::from_slice(&y6.stdout).unwrap();
    let message = errors["errors"][0]["message"].as_str().unwrap();
    assert!(message.contains("it has 8 motors, px4-y6 6 rotors"), "{errors}");
}

#[test]
#[ignore = "needs MIXER_BENCH_DATA"]
fn the_airframe_with_the_scale_compiles() {
    let data = bench_data();
    let folder = folder("review-scaled");
    let log = unpacked(&data, "ardupilot-x8-yaw.bin", &folder);
    let airframe = data.join("logs/x8-log.toml").display().to_string();
    let scaled = folder.join("scaled.toml").display().to_string();
    let arguments = ["review", &log, &airframe, "--mass", "5.5", "-o", &scaled];
    let output = run_with(&arguments, b"");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = fs::read_to_string(&scaled).unwrap();
    assert!(
        text.contains("# cargo mixer review ardupilot-x8-yaw.bin"),
        "{text}"
    );
    let again = run_with(&["review", &log, &scaled, "--mass", "5.5", "--json"], b"");
    let json: Value = serde_json::from_slice(&again.stdout).unwrap();
    let scale = json["thrust"]["scale"].as_f64().unwrap();
    assert!((scale - 1.0).abs() < 1e-3, "{scale}");
    // Not over a file without being told to.
    assert_eq!(run_with(&arguments, b"").status.code(), Some(1));
    // Nor what the log does not contradict.
    let other = folder.join("other.toml").display().to_string();
    let arguments = ["review", &log, &airframe, "-o", &other];
    let output = run_with(&arguments, b"");
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("holds 1: the log does not contradict"), "{error}");
    assert!(!std::path::Path::new(&other).exists());
    assert_eq!(
        run_with(&[&arguments[..], &["--force"]].concat(), b"")
            .status
            .code(),
        Some(0)
    );
}
