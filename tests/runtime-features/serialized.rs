//! Wrenches, axes and saturation flags come back from a file as they were written.
#![allow(missing_docs)]

use mixer_rt::{Axis, Direction, Saturation, Wrench};
use serde_json::{from_str, to_string};

#[test]
fn wrenches_come_back_with_their_bits() {
    let wrench = Wrench {
        roll_nm: 0.1,
        pitch_nm: -0.5,
        yaw_nm: -0.0,
        thrust_n: f32::MIN_POSITIVE,
    };
    let text = to_string(&wrench).expect("JSON");
    assert!(
        text.starts_with(r#"{"roll_nm":0.1,"pitch_nm":-0.5,"yaw_nm":-0.0,"thrust_n":"#),
        "{text}"
    );
    let read: Wrench = from_str(&text).expect("a wrench");
    assert_eq!(
        read.to_array().map(f32::to_bits),
        wrench.to_array().map(f32::to_bits)
    );
}

#[test]
fn axes_and_directions_are_words() {
    assert_eq!(
        to_string(&Axis::ALL).expect("JSON"),
        r#"["roll","pitch","yaw","thrust"]"#
    );
    for axis in Axis::ALL {
        assert_eq!(
            from_str::<Axis>(&format!("{:?}", axis.name())).expect("an axis"),
            axis
        );
    }
    for (direction, word) in [
        (Direction::Positive, r#""positive""#),
        (Direction::Negative, r#""negative""#),
    ] {
        assert_eq!(to_string(&direction).expect("JSON"), word);
        assert_eq!(from_str::<Direction>(word).expect("a direction"), direction);
    }
}

#[test]
fn saturation_is_its_bits() {
    for bits in 0..=0x3ff {
        let saturation = Saturation::from_bits(bits);
        let text = to_string(&saturation).expect("JSON");
        assert_eq!(text, bits.to_string());
        assert_eq!(from_str::<Saturation>(&text).expect("flags"), saturation);
    }
    let unknown = from_str::<Saturation>("65535").expect("flags");
    assert_eq!(unknown.bits(), 0x3ff, "unknown bits are dropped");
    assert!(from_str::<Saturation>("65536").is_err());
}
