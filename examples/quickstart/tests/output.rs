//! What a newcomer sees first holds together.

use std::process::Command;

#[test]
fn mixes_the_sequence() {
    let run = Command::new(env!("CARGO_BIN_EXE_quickstart")).output().unwrap();
    assert!(run.status.success(), "{run:?}");
    let text = String::from_utf8(run.stdout).unwrap();
    let of = |name: &str| -> Vec<&str> {
        text.lines()
            .filter_map(|line| line.strip_prefix(name))
            .map(str::trim)
            .collect()
    };
    let numbers = |line: &str| -> Vec<f32> {
        let list = line.trim_matches(['[', ']']).split(", ");
        list.map(|number| number.parse().unwrap()).collect()
    };
    // Only the last setpoint asks for more than there is.
    assert_eq!(of("saturated"), ["false", "false", "false", "false", "true"]);
    for (asked, achieved) in of("asked").into_iter().zip(of("achieved")).take(4) {
        for (asked, achieved) in numbers(asked).into_iter().zip(numbers(achieved)) {
            // Four units of 0.01 N at 15.2 V (k_f = 1.05), and what printing rounds.
            assert!((asked - achieved).abs() < 0.043, "{text}");
        }
    }
    let throttles: Vec<f32> = of("throttle").into_iter().flat_map(numbers).collect();
    assert_eq!(throttles.len(), 5 * 8, "{text}");
    assert!(
        throttles.iter().all(|throttle| (0.1..=1.0).contains(throttle)),
        "{text}"
    );
}
