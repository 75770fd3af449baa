//! Mixes random setpoints of one airframe, as many as `Digest::setpoints` says (`--cfg million` for a
//! million), with all rotors and with one and two out, and prints the number of rotors out and the
//! digest of all results after each tenth. The host computes the same; see `tests/src/digest.rs`.
#![no_std]
#![no_main]

#[cfg(airframe)]
#[allow(dead_code, reason = "images that ask for one kind of health share the module")]
#[path = "../subject/mod.rs"]
mod subject;

use cortex_m_rt::entry;

#[cfg(all(airframe, not(baseline)))]
fn run() -> bool {
    use cortex_m_semihosting::hprintln;
    use mixer_rt::Wrench;
    use mixer_setpoints::{Digest, Mixture, RotorsOut};
    use subject::airframe;

    for rotors_out in 0..=Digest::MOST_ROTORS_OUT {
        let healths = RotorsOut::new(Digest::SEED, airframe::CHANNELS, rotors_out);
        let mut setpoints = Mixture::new(&airframe::TABLES, Digest::SEED).zip(healths);
        let mut digest = Digest::new();
        for _ in 0..10 {
            let tenth = Digest::setpoints(cfg!(million), rotors_out) / 10;
            for (setpoint, health) in setpoints.by_ref().take(tenth) {
                let wrench = Wrench::from_array(setpoint.wrench);
                let mixed = if rotors_out == 0 {
                    airframe::mix(&wrench, setpoint.conditions())
                } else {
                    airframe::mix_with_health(&wrench, setpoint.conditions(), health)
                };
                match mixed {
                    Ok(mix) => digest.mix(Ok((&mix.throttle, &mix.achieved, mix.saturation))),
                    Err(error) => digest.mix(Err(error)),
                }
            }
            hprintln!("{} {:016x}", rotors_out, digest.value());
        }
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
