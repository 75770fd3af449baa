//! What dropped files are taken for.
#![allow(missing_docs)]

use std::fs;
use std::path::Path;

use mixer_web::kind::kind;

fn told(path: &str, options: &[&str]) -> (&'static str, usize) {
    let text = fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let name = Path::new(path)
        .file_name()
        .unwrap()
        .to_string_lossy()
        .into_owned();
    let options: Vec<String> = options.iter().map(|word| (*word).to_owned()).collect();
    let kind = kind(&name, &String::from_utf8_lossy(&text), &options).unwrap();
    (kind.kind, kind.points)
}

#[test]
fn files_of_the_project() {
    assert_eq!(told("../../examples/bench/sweep.csv", &[]), ("map", 36));
    assert_eq!(told("../../examples/no-bench/rotor.csv", &[]).0, "run");
    assert_eq!(told("../../airframes/isae-x8.toml", &[]).0, "airframe");
}

#[test]
fn texts() {
    let cases: [(&str, &[&str], &str); 7] = [
        (
            "upper,lower,thrust_n\n0.3,0.4,5\n0.9,0.8,22\n0.5,0.9,15\n0.9,0.5,15\n",
            &[],
            "map",
        ),
        (
            "Throttle (%),Thrust (gf)\n40,410\n50,610\n60,800\n70,1000\n80,1200\n",
            &[],
            "run",
        ),
        (
            "RPM,Thrust (N)\n3000,4\n4000,7\n5000,11\n6000,16\n7000,22\n",
            &["--rpm-at-full", "8000"],
            "run",
        ),
        ("[pair]\nbasis = \"cubic\"\n", &[], "pair"),
        ("FRAME_CLASS,4\nFRAME_TYPE,1\n", &[], "parameters"),
        ("", &[], "map"),
        ("roll_nm,pitch_nm\n0,0\n", &[], "map"),
    ];
    for (text, options, expected) in cases {
        let options: Vec<String> = options.iter().map(|word| (*word).to_owned()).collect();
        assert_eq!(kind("file.csv", text, &options).unwrap().kind, expected, "{text}");
    }
}
