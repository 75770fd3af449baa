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
}
