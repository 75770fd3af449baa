//! One airframe's golden vectors on the target, with all rotors and with each of them out: one line
//! of result, and QEMU's exit status. Copy it with `harness.rs`; the two paths and the airframe's
//! module are yours.
#![no_std]
#![no_main]

mod harness;

use core::panic::PanicInfo;

use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
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
    exit(differ == 0)
}

/// Leaves QEMU, or rests on a board.
fn exit(passed: bool) -> ! {
    debug::exit(if passed {
        debug::EXIT_SUCCESS
    } else {
        debug::EXIT_FAILURE
    });
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    exit(false)
}
