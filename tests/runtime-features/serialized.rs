//! What mixers take and give comes back from a file as it was written.
#![allow(missing_docs)]

use mixer_rt::{Axis, Conditions, Direction, Health, Mix, Saturation, SetpointError, Wrench};
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

/// What a mixer takes and gives, for a log of flights.
#[test]
fn mixes_and_conditions_come_back() {
    let mut mix = Mix::<40>::default();
    mix.throttle = std::array::from_fn(|channel| channel as f32 / 40.0);
    mix.achieved = Wrench::from_array([0.1, 0.2, 0.3, 31.4]);
    mix.saturation = Saturation::from_bits(1 << 4);
    let text = to_string(&mix).expect("JSON");
    assert_eq!(from_str::<Mix<40>>(&text).expect("a mix"), mix);
    let shorter = from_str::<Mix<41>>(&text).expect_err("another number of rotors");
    assert!(shorter.to_string().contains("expected 41 numbers"), "{shorter}");

    let thin = Conditions::at_voltage(14.8).in_air(0.909);
    for conditions in [thin, 14.8.into()] {
        let text = to_string(&conditions).expect("JSON");
        assert_eq!(from_str::<Conditions>(&text).expect("conditions"), conditions);
    }
    let health = Health::GOOD.with_failed(3).with_failed(63);
    let text = to_string(&health).expect("JSON");
    assert_eq!(text, (1_u64 << 3 | 1 << 63).to_string());
    assert_eq!(from_str::<Health>(&text).expect("health"), health);
    for error in [
        SetpointError::NonFinite(Axis::Yaw),
        SetpointError::NonFiniteVoltage,
    ] {
        let text = to_string(&error).expect("JSON");
        assert_eq!(from_str::<SetpointError>(&text).expect("an error"), error);
    }
}
