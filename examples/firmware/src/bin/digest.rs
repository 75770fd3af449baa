//! Mixes a hundred thousand random setpoints, with `--cfg million` a million, and prints the digest of all results
//! after each tenth. The host computes the same; see `tests/src/digest.rs`. Which mixer: see `src/subject`.
#![no_std]
#![no_main]

#[cfg(airframe)]
#[path = "../subject/mod.rs"]
mod subject;

use cortex_m_rt::entry;

#[cfg(all(airframe, not(baseline)))]
fn run() -> bool {
    use cortex_m_semihosting::hprintln;
    use mixer_rt::Wrench;
    use mixer_setpoints::{Digest, Mixture};

    const SEED: u64 = 17;
    const COUNT: usize = if cfg!(million) { 1_000_000 } else { 100_000 };

    subject::prepare();
    let mut setpoints = Mixture::new(&subject::airframe::TABLES, SEED);
    let mut digest = Digest::new();
    for _ in 0..10 {
        for setpoint in setpoints.by_ref().take(COUNT / 10) {
            match subject::mix(&Wrench::from_array(setpoint.wrench), setpoint.voltage_v) {
                Ok(mix) => digest.mix(Ok((&mix.throttle, &mix.achieved, mix.saturation))),
                Err(error) => digest.mix(Err(error)),
            }
        }
        hprintln!("{:016x}", digest.value());
    }
    true
}

#[cfg(not(all(airframe, not(baseline))))]
fn run() -> bool {
    probe::no_airframe()
}

#[entry]
fn main() -> ! {
    probe::exit(run())
}
