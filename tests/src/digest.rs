//! The same bits on the host and on the target, over many random setpoints: one number is compared
//! for all of them.

use mixer_compiler::Compiled;
use mixer_rt::{Wrench, tables::UnitState};
use mixer_setpoints::{Digest, Mixture, RotorsOut};

/// Digest after each tenth of `count` setpoints with `rotors_out`, as the `digest` image prints
/// them.
pub fn of(compiled: &Compiled, count: usize, rotors_out: u32) -> Vec<u64> {
    let tables = compiled.tables.view();
    let healths = RotorsOut::new(Digest::SEED, compiled.tables.channels(), rotors_out);
    let mut setpoints = Mixture::new(&tables, Digest::SEED).zip(healths);
    let mut digest = Digest::new();
    let mut tenths = Vec::new();
    for _ in 0..10 {
        for (setpoint, health) in setpoints.by_ref().take(count / 10) {
            let wrench = Wrench::from_array(setpoint.wrench);
            let mut throttle = vec![tables.throttle.min; compiled.tables.channels()];
            let mixed = mixer_rt::tables::mix_into(
                &tables,
                &wrench,
                setpoint.conditions(),
                health,
                || vec![UnitState::default(); tables.units.len()],
                &mut mixer_rt::tables::by_channel(&mut throttle),
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
