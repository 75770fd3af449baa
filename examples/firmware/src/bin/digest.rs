//! Mixes a hundred thousand random setpoints, with `--cfg million` a million, and prints the digest of all results
//! after each tenth; with rotors out it mixes a fiftieth of that. The host computes the same; see `tests/src/digest.rs`.
//! Which mixer and how many rotors out: see `src/subject`.
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
    use mixer_setpoints::{Digest, Mixture, RotorsOut};

    const SEED: u64 = 17;
    const ALL_TURNING: usize = if cfg!(million) { 1_000_000 } else { 100_000 };
    const COUNT: usize = if subject::ROTORS_OUT == 0 {
        ALL_TURNING
    } else {
        ALL_TURNING / 50
    };

    subject::prepare();
    let mut setpoints = Mixture::new(&subject::airframe::TABLES, SEED).zip(RotorsOut::new(
        SEED,
        subject::airframe::CHANNELS,
        subject::ROTORS_OUT,
    ));
    let mut digest = Digest::new();
    for _ in 0..10 {
        for (setpoint, health) in setpoints.by_ref().take(COUNT / 10) {
            let wrench = Wrench::from_array(setpoint.wrench);
            match subject::mix(&wrench, setpoint.voltage_v, health) {
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
