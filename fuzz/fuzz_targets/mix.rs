//! Any bits as setpoint, voltage and failed rotors, on every airframe: no panic, throttles in range or a refusal.
//!
//! `any_bits_give_throttles_in_range_or_a_refusal` in `tests/allocation.rs` does the same with fixed bits.
#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use mixer_compiler::{Compiled, Source};
use mixer_rt::{Health, Wrench};

fn airframes() -> &'static [Compiled] {
    static AIRFRAMES: OnceLock<Vec<Compiled>> = OnceLock::new();
    AIRFRAMES.get_or_init(|| {
        let texts = [
            include_str!("../../airframes/coaxial-bicopter.toml"),
            include_str!("../../airframes/isae-x8.toml"),
            include_str!("../../airframes/px4-x12.toml"),
            include_str!("../../airframes/px4-y6.toml"),
            include_str!("../../airframes/single-pair.toml"),
        ];
        let compile = |text: &str| mixer_compiler::compile(&Source::new("airframe.toml", text)).expect("compiles");
        texts.into_iter().map(compile).collect()
    })
}

fuzz_target!(|input: (u8, [u32; 4], u32, [u8; 2])| {
    let (which, wrench, volts, failed) = input;
    let airframes = airframes();
    let tables = &airframes[usize::from(which) % airframes.len()].tables;
    let setpoint = Wrench::from_array(wrench.map(f32::from_bits));
    // Half of the inputs have all rotors.
    let health = if which < 128 {
        Health::GOOD
    } else {
        Health::GOOD.with_failed(failed[0]).with_failed(failed[1])
    };
    let Ok((throttle, achieved, _)) = tables.mix_with_health(&setpoint, f32::from_bits(volts), health) else {
        return;
    };
    let range = tables.throttle;
    for (channel, throttle) in (0..).zip(throttle) {
        let in_range = (range.min..=range.max).contains(&throttle);
        assert!(in_range || (health.has_failed(channel) && throttle == 0.0));
    }
    assert!(achieved.to_array().iter().all(|x| x.is_finite()));
});
