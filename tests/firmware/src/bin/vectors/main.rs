//! One airframe's golden vectors on the target, with all rotors and with each of them out: one line of result.
#![no_std]
#![no_main]

mod harness;

use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use harness::differing;
use mixer_rt::Health;

mixer_macros::airframe!("../../airframes/isae-x8.toml");
include!("../../../../golden/isae-x8.vectors.rs");

#[entry]
fn main() -> ! {
    let (mut rows, mut differ) = (VECTORS.len(), differing(&VECTORS, isae_x8::mix));
    for (failed, vectors) in &ROTORS_OUT {
        let health = Health::GOOD.with_failed(*failed);
        rows += vectors.len();
        differ += differing(vectors, |setpoint, voltage_v| {
            isae_x8::mix_with_health(setpoint, voltage_v, health)
        });
    }
    hprintln!("isae-x8: {} vectors, {} differ", rows, differ);
    probe::exit(differ == 0)
}
