//! Both airframes are mixed by the one generic function.

use std::process::Command;

#[test]
fn mixes_both_airframes() {
    let run = Command::new(env!("CARGO_BIN_EXE_build-script")).output().unwrap();
    assert!(run.status.success(), "{run:?}");
    let text = String::from_utf8(run.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let [x8, x8_hover, x8_roll, y6, y6_hover, y6_roll] = lines[..] else {
        panic!("{text}");
    };
    assert_eq!((x8, y6), ("isae-x8, 8 rotors", "px4-y6, 6 rotors"));
    for (line, rotors) in [(x8_hover, 8), (x8_roll, 8), (y6_hover, 6), (y6_roll, 6)] {
        assert_eq!(line.split(", ").count(), rotors, "{text}");
    }
    assert_ne!(x8_hover, x8_roll);
    assert_ne!(y6_hover, y6_roll);
}
