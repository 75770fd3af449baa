//! Any bits as setpoint, voltage and failed rotors, on every airframe and fixture with every
//! airmode: no panic, and throttles in range or a refusal.
//!
//! `tests/allocation/properties.rs` does the same with fixed bits on random layouts.
#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use mixer_compiler::{Compiled, Source};
use mixer_rt::{Health, Wrench};

/// Vertical axes with and without a closed form, tilted axes, one to six units, all bases, with
/// and without voltage.
const TEXTS: [&str; 8] = [
    include_str!("../../../airframes/coaxial-bicopter.toml"),
    include_str!("../../../airframes/isae-x8.toml"),
    include_str!("../../../airframes/px4-x12.toml"),
    include_str!("../../../airframes/px4-y6.toml"),
    include_str!("../../../airframes/single-pair.toml"),
    include_str!("../../../tests/fixtures/cubic-tilted-x8.toml"),
    include_str!("../../../tests/fixtures/polynomial-x10.toml"),
    include_str!("../../../tests/fixtures/quartic-y6.toml"),
];

const AIRMODES: [&str; 3] = ["disabled", "roll-pitch", "roll-pitch-yaw"];

/// Roll, pitch, yaw (N m) and thrust (N) beyond which all of these airframes are saturated.
const LARGE: [f32; 4] = [60.0, 60.0, 6.0, 300.0];

/// A file with another airmode.
fn with_airmode(text: &str, airmode: &str) -> String {
    let line = format!("airmode = \"{airmode}\"\n");
    if !text.contains("[allocation]") {
        return format!("{text}\n[allocation]\n{line}");
    }
    let rest = text.lines().filter(|line| !line.starts_with("airmode"));
    let rest = rest.flat_map(|line| [line, "\n"]).collect::<String>();
    rest.replace("[allocation]\n", &format!("[allocation]\n{line}"))
}

fn airframes() -> &'static [Compiled] {
    static AIRFRAMES: OnceLock<Vec<Compiled>> = OnceLock::new();
    AIRFRAMES.get_or_init(|| {
        let texts = TEXTS
            .into_iter()
            .flat_map(|text| AIRMODES.map(|airmode| with_airmode(text, airmode)));
        let compile = |text: String| {
            mixer_compiler::compile(&Source::new("airframe.toml", text))
                .unwrap_or_else(|faults| panic!("{faults}"))
        };
        texts.map(compile).collect()
    })
}

fuzz_target!(|input: (u8, u8, [u32; 4], u32, [u8; 3])| {
    let (which, kind, bits, volts, failed) = input;
    let airframes = airframes();
    let tables = &airframes[usize::from(which) % airframes.len()].tables;
    // Most bits are numbers that no vehicle knows; half of the inputs are of a controller's size.
    let wrench: [f32; 4] = std::array::from_fn(|axis| {
        if kind & 1 == 0 {
            LARGE[axis] * (bits[axis] as i32 as f32 / i32::MAX as f32)
        } else {
            f32::from_bits(bits[axis])
        }
    });
    let volts = if kind & 2 == 0 {
        10.0 + 16.0 * (volts as f32 / u32::MAX as f32)
    } else {
        f32::from_bits(volts)
    };
    // None to three rotors out; channels beyond the airframe's are no one's.
    let health = failed
        .iter()
        .take(usize::from(kind >> 2) % 4)
        .fold(Health::GOOD, |health, channel| health.with_failed(channel % 16));
    let finite =
        wrench.iter().all(|x| x.is_finite()) && (volts.is_finite() || tables.corrections.voltage.is_none());
    let mixed = tables.mix_with_health(&Wrench::from_array(wrench), volts, health);
    assert_eq!(mixed.is_ok(), finite);
    let Ok((throttle, achieved, _)) = mixed else {
        return;
    };
    let range = tables.throttle;
    for (channel, throttle) in (0..).zip(throttle) {
        let in_range = (range.min..=range.max).contains(&throttle);
        assert!(if health.has_failed(channel) {
            throttle == 0.0
        } else {
            in_range
        });
    }
    assert!(achieved.to_array().iter().all(|x| x.is_finite()));
});
