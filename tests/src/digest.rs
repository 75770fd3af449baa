//! The same bits on the host and on the target, over many random setpoints: one number is compared for all of them.

use mixer_compiler::Compiled;
use mixer_rt::{Health, Scratch, Wrench};
use mixer_setpoints::{Digest, Mixture};

/// Where the sequence of setpoints starts; the `digest` image has the same.
pub const SEED: u64 = 17;

/// Digest after each tenth of `count` setpoints, as the `digest` image prints them.
pub fn of(compiled: &Compiled, count: u32) -> Vec<u64> {
    let tables = compiled.tables.view();
    let mut setpoints = Mixture::new(&tables, SEED);
    let mut digest = Digest::new();
    let mut tenths = Vec::new();
    for _ in 0..10 {
        for setpoint in setpoints.by_ref().take(count as usize / 10) {
            let wrench = Wrench::from_array(setpoint.wrench);
            let mut scratch = vec![Scratch::default(); tables.units.len()];
            let mut throttle = vec![tables.throttle.min; 2 * tables.units.len()];
            let mixed = mixer_rt::mix_into(
                &tables,
                &wrench,
                setpoint.voltage_v,
                Health::GOOD,
                &mut scratch,
                &mut throttle,
            );
            match &mixed {
                Ok((achieved, saturation)) => digest.mix(Ok((&throttle, achieved, *saturation))),
                Err(error) => digest.mix(Err(*error)),
            }
        }
        tenths.push(digest.value());
    }
    tenths
}
