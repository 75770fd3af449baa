//! The check list for the bench.

use mixer_compiler::airframe::Axis;
use mixer_compiler::{Compiled, Source, compile};
use mixer_facts::checklist::Checklist;

fn compiled(text: &str) -> Compiled {
    compile(&Source::new("test.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

const X8: &str = include_str!("../../../airframes/isae-x8.toml");

#[test]
fn an_x8_has_its_list() {
    let compiled = compiled(X8);
    let text = Checklist(&compiled).to_string();
    assert_eq!(
        text,
        "on the bench    propellers off, outputs one by one; spins as seen from above
  unit 0         front right: output 0 upper, clockwise; output 4 lower, counter-clockwise
  unit 1         front left: output 1 upper, counter-clockwise; output 5 lower, clockwise
  unit 2         rear left: output 2 upper, clockwise; output 6 lower, counter-clockwise
  unit 3         rear right: output 3 upper, counter-clockwise; output 7 lower, clockwise
  +roll          raises outputs 1, 2, 5, 6 by 0.017 (right side down)
  +pitch         raises outputs 0, 1, 4, 5 by 0.017 (nose up)
  +yaw           raises outputs 4, 6 by 0.009; 1, 3 by 0.006 (nose right)
  +thrust        raises outputs 0, 1, 2, 3, 4, 5, 6, 7 by 0.017 (up)
"
    );
}

/// What the list is for: a mirrored spin and exchanged channels show.
#[test]
fn mistakes_show_in_the_list() {
    let rising = |text: &str, axis| {
        let rises = Checklist(&compiled(text)).rises(axis).unwrap();
        let mut outputs: Vec<String> = rises.iter().map(|(output, _)| output.to_string()).collect();
        outputs.sort();
        outputs
    };
    let mirrored = X8.replace("upper_spin = \"cw\"\nchannels", "upper_spin = \"ccw\"\nchannels");
    assert_ne!(mirrored, X8);
    assert_ne!(rising(&mirrored, Axis::Yaw), rising(X8, Axis::Yaw));
    let exchanged = X8.replace("[0, 4]", "[4, 0]");
    assert_eq!(rising(X8, Axis::Yaw), ["1", "3", "4", "6"]);
    assert_eq!(rising(&exchanged, Axis::Yaw), ["0", "1", "3", "6"]);
    assert_eq!(rising(&exchanged, Axis::Roll), rising(X8, Axis::Roll));
}

/// Axes that are not served are not in it.
#[test]
fn only_served_axes_are_listed() {
    let bicopter = compiled(include_str!("../../../airframes/coaxial-bicopter.toml"));
    assert!(Checklist(&bicopter).rises(Axis::Pitch).is_none());
    let text = Checklist(&bicopter).to_string();
    assert!(
        !text.contains("+pitch") && text.contains("unit 0         right: output 0 upper"),
        "{text}"
    );
}
