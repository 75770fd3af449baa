//! How an image ends: with its verdict as QEMU's exit status, also in a panic.

use core::panic::PanicInfo;

use cortex_m_semihosting::{debug, hprintln};

use crate::{Counter, Inexact, NOPS};

/// Leaves QEMU, with success where `passed`.
pub fn exit(passed: bool) -> ! {
    debug::exit(if passed {
        debug::EXIT_SUCCESS
    } else {
        debug::EXIT_FAILURE
    });
    loop {
        cortex_m::asm::wfi();
    }
}

/// What `measure` says of its measurements; false, with a line that says why, where instructions
/// cannot be counted.
pub fn with_counter(measure: impl FnOnce(Counter) -> bool) -> bool {
    match Counter::new() {
        Ok(counter) => measure(counter),
        Err(Inexact { counted }) => {
            hprintln!(
                "{} instructions were counted as {}: is -icount shift=10 set?",
                NOPS,
                counted
            );
            false
        }
    }
}

/// Says that no airframe was chosen; false.
pub fn no_airframe() -> bool {
    hprintln!("no airframe: build with --cfg airframe --cfg 'airframe=\"isae-x8\"'");
    false
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    exit(false)
}
