//! Frames of `MIXER_BENCH_DATA`: PX4's files, and ArduPilot's frame tables. None of them is part of
//! the project.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::{Folder, Unit, import, outline, refused};

pub(crate) fn folder_of_data(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("MIXER_BENCH_DATA").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("NOT RUN: {test} needs MIXER_BENCH_DATA, the folder of real bench files");
    }
    folder
}

/// PX4's octa_cox: pairs (0, 5), (1, 4), (2, 7), (3, 6).
fn octa_cox() -> Vec<(Vec<i64>, &'static str)> {
    vec![
        (vec![0, 5], "ccw"),
        (vec![1, 4], "cw"),
        (vec![2, 7], "ccw"),
        (vec![3, 6], "cw"),
    ]
}

#[test]
fn px4_files_give_their_frames() {
    let Some(data) = folder_of_data("px4_files_give_their_frames") else {
        return;
    };
    let folder = Folder::new("px4-data");
    let file = |name: &str| data.join("px4").join(name);
    let (units, _) = import(&folder, &[&file("CONSTRUCTED_octo_cox_qgc.params")], &[]);
    assert_eq!(outline(&units), octa_cox());
    let expected = [
        [0.1905, 0.1905],
        [0.1905, -0.1905],
        [-0.1905, -0.1905],
        [-0.1905, 0.1905],
    ];
    for (unit, expected) in units.iter().zip(expected) {
        assert_eq!(unit.position_m[..2], expected);
    }
    let (units, _) = import(&folder, &[&file("octa_cox.toml")], &[]);
    assert_eq!(outline(&units), octa_cox());
    let layers = [file("dodeca_top_cox.toml"), file("dodeca_bottom_cox.toml")];
    let (units, _) = import(&folder, &layers.each_ref().map(PathBuf::as_path), &[]);
    let spins = ["cw", "ccw", "cw", "ccw", "ccw", "cw"];
    let expected: Vec<_> = spins
        .into_iter()
        .zip(0..)
        .map(|(spin, k)| (vec![k, 6 + k], spin))
        .collect();
    assert_eq!(outline(&units), expected);
    for name in [
        "REAL_excerpt_flight1_v1.12.3.params",
        "REAL_excerpt_stable_old.params",
    ] {
        assert!(refused(&folder, &file(name), &[]).contains("no rotors"));
    }
}

/// FRAME_CLASS and FRAME_TYPE by ArduPilot's names.
pub(crate) fn numbers(frame: &Value) -> (u32, u32) {
    let class = match frame["frame_class"].as_str().unwrap() {
        "OCTAQUAD" => 4,
        "Y6" => 5,
        "DODECAHEXA" => 12,
        other => panic!("{other}"),
    };
    let kind = match frame["frame_type"].as_str().unwrap() {
        "PLUS" => 0,
        "X" | "Y6A(default)" => 1,
        "V" => 2,
        "H" => 3,
        "Y6B" => 10,
        "Y6F" => 11,
        "BF_X" => 12,
        "CW_X" => 14,
        "BF_X_REV" => 18,
        "X_COR" => 20,
        "CW_X_COR" => 21,
        other => panic!("{other}"),
    };
    (class, kind)
}

/// Whether a unit is the pair of these motors: outputs, spin, and where it is.
pub(crate) fn is_pair(unit: &Unit, frame: &Value, motors: &Value) -> bool {
    let all = frame["motors"].as_array().unwrap();
    let numbers = [0, 1].map(|k| motors[k].as_i64().unwrap());
    let upper = all.iter().find(|motor| motor["motor"] == numbers[0]).unwrap();
    // A spin, or a yaw factor, positive counter-clockwise.
    let spin = match upper["spin"].as_str().unwrap() {
        "CCW" => "ccw",
        "CW" => "cw",
        factor if factor.starts_with('+') => "ccw",
        _ => "cw",
    };
    let [x, y] = [unit.position_m[0], unit.position_m[1]];
    let is_there = match upper["angle_deg"].as_f64() {
        Some(angle) => {
            let turn = (libm::atan2(y, x).to_degrees() - angle).rem_euclid(360.0);
            turn.min(360.0 - turn) < 0.1
        }
        // Roll is positive to the left, pitch to the front; a factor of 0 is on the axis.
        None => {
            let factor = |key: &str| upper[key].as_f64().unwrap();
            let same = |factor: f64, place: f64| (factor == 0.0) == (place == 0.0) && factor * place >= 0.0;
            same(-factor("roll_fac"), y) && same(factor("pitch_fac"), x)
        }
    };
    unit.channels == numbers.map(|motor| motor - 1) && unit.upper_spin == spin && is_there
}

#[test]
fn ardupilot_tables_give_their_frames() {
    let Some(data) = folder_of_data("ardupilot_tables_give_their_frames") else {
        return;
    };
    let folder = Folder::new("ardupilot-data");
    let text = fs::read_to_string(data.join("ardupilot/coax_frames.json")).unwrap();
    let table: Value = serde_json::from_str(&text).unwrap();
    let frames = table["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 14);
    for frame in frames {
        let (class, kind) = numbers(frame);
        let name = format!("{} {}", frame["frame_class"], frame["frame_type"]);
        let file = folder.write("a.param", &format!("FRAME_CLASS,{class}\nFRAME_TYPE,{kind}\n"));
        if kind == 20 || kind == 21 {
            assert!(refused(&folder, &file, &["--arm", "0.45"]).contains("turn the same way"));
            continue;
        }
        let (units, _) = import(&folder, &[Path::new(&file)], &["--arm", "0.45"]);
        let pairs = frame["pairs_top_bottom"].as_array().unwrap();
        assert_eq!(units.len(), pairs.len(), "{name}");
        for pair in pairs {
            assert!(
                units.iter().any(|unit| is_pair(unit, frame, pair)),
                "{name}: {pair} {units:?}"
            );
        }
    }
}
