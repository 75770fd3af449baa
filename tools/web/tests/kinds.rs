//! What dropped files are taken for.
#![allow(missing_docs)]

use std::fs;
use std::path::Path;

use mixer_files::kind::FileKind;
use mixer_web::make::kind;

fn told(path: &str) -> (FileKind, usize) {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let name = Path::new(path).file_name().unwrap();
    let file = kind(&name.to_string_lossy(), &bytes, &[]).unwrap();
    (file.kind, file.points)
}

#[test]
fn files_of_the_project() {
    assert_eq!(told("../../examples/bench/sweep.csv"), (FileKind::Map, 36));
    assert_eq!(told("../../examples/no-bench/rotor.csv").0, FileKind::Run);
    assert_eq!(told("../../airframes/isae-x8.toml").0, FileKind::Airframe);
}

#[test]
fn texts() {
    let cases: [(&str, &[&str], FileKind); 8] = [
        (
            "upper,lower,thrust_n\n0.3,0.4,5\n0.9,0.8,22\n0.5,0.9,15\n0.9,0.5,15\n",
            &[],
            FileKind::Map,
        ),
        (
            "Throttle (%),Thrust (gf)\n40,410\n50,610\n60,800\n70,1000\n80,1200\n",
            &[],
            FileKind::Run,
        ),
        (
            "RPM,Thrust (N)\n3000,4\n4000,7\n5000,11\n6000,16\n7000,22\n",
            &["--rpm-at-full", "8000"],
            FileKind::Run,
        ),
        ("[pair]\nbasis = \"cubic\"\n", &[], FileKind::Pair),
        ("FRAME_CLASS,4\nFRAME_TYPE,1\n", &[], FileKind::Ardupilot),
        ("# diff all\nmixer OCTOX8\n", &[], FileKind::Betaflight),
        ("", &[], FileKind::Map),
        ("roll_nm,pitch_nm\n0,0\n", &[], FileKind::Map),
    ];
    for (text, options, expected) in cases {
        let options: Vec<String> = options.iter().map(|word| (*word).to_owned()).collect();
        let told = kind("file.csv", text.as_bytes(), &options).unwrap();
        assert_eq!(told.kind, expected, "{text}");
    }
}
