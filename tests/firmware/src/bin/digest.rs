//! Mixes random setpoints, as many as `Digest::setpoints` says (`--cfg million` for a million), and
//! prints the digest of all results after each tenth. The host computes the same; see
//! `tests/src/digest.rs`. Which mixer and how many rotors out: see `src/subject`.
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

    const COUNT: usize = Digest::setpoints(cfg!(million), subject::ROTORS_OUT);

    subject::prepare();
    let healths = RotorsOut::new(Digest::SEED, subject::airframe::CHANNELS, subject::ROTORS_OUT);
    let mut setpoints = Mixture::new(&subject::airframe::TABLES, Digest::SEED).zip(healths);
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
