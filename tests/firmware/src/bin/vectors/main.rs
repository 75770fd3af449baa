//! One airframe's golden vectors on the target, with all rotors and with each of them out: one line
//! of result, and QEMU's exit status. Copy it with `harness.rs`; the paths and the airframe's module
//! are yours.
#![no_std]
#![no_main]

mod harness;

use core::panic::PanicInfo;

use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use harness::{differing, differing_with_rotors_out, rows};
use mixer_rt::{Conditions, Health, Wrench};

mixer_macros::airframe!("../../airframes/isae-x8.toml");

/// All rotors turn.
static VECTORS: &str = include_str!("../../../../golden/isae-x8.vectors.csv");

/// One rotor is out, or two are.
static ROTORS_OUT: &str = include_str!("../../../../golden/isae-x8.rotors-out.csv");

#[entry]
fn main() -> ! {
    let with_rotor_out = |setpoint: &Wrench, conditions: Conditions, health: Health| {
        isae_x8::mix_with_health(setpoint, conditions, health)
    };
    let differ = differing(VECTORS, isae_x8::mix) + differing_with_rotors_out(ROTORS_OUT, with_rotor_out);
    let count = rows(VECTORS).count() + rows(ROTORS_OUT).count();
    hprintln!("isae-x8: {} vectors, {} differ", count, differ);
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
