//! The rate loop as an RTIC task: SysTick runs it at the highest priority, the idle task measures
//! the battery.
//!
//! `cargo run --release --features rtic --bin rtic`
#![no_std]
#![no_main]

#[path = "../../../firmware/src/board.rs"]
mod board;
#[path = "../../../firmware/src/control.rs"]
mod control;
#[path = "../rate.rs"]
mod rate;

use core::panic::PanicInfo;

// The vector table and the entry.
use cortex_m_rt as _;
use cortex_m_semihosting::{debug, hprintln};

/// What RTIC asks of a device: the board has no crate of its own, and no interrupt but SysTick is
/// used.
mod device {
    pub(crate) const NVIC_PRIO_BITS: u8 = 3;
}

#[rtic::app(device = crate::device, peripherals = false)]
mod app {
    use cortex_m_semihosting::debug;

    use crate::board::{self, DischargingPack};
    use crate::control::Battery;
    use crate::rate::{CYCLES_PER_MEASUREMENT, RATE_HZ, RateLoop, VOLTAGE};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        rate_loop: RateLoop,
        pack: DischargingPack,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        board::pace(context.core.SYST, RATE_HZ);
        let local = Local {
            rate_loop: RateLoop::new(),
            pack: DischargingPack::full(),
        };
        (Shared {}, local)
    }

    #[task(binds = SysTick, priority = 7, local = [rate_loop])]
    fn cycle(context: cycle::Context) {
        let rate_loop = context.local.rate_loop;
        if !rate_loop.cycle() {
            rate_loop.report();
            debug::exit(debug::EXIT_SUCCESS);
        }
    }

    #[idle(local = [pack])]
    fn idle(context: idle::Context) -> ! {
        let mut wakes = 0_u32;
        loop {
            cortex_m::asm::wfi();
            if wakes.is_multiple_of(CYCLES_PER_MEASUREMENT) {
                VOLTAGE.measured(context.local.pack.voltage_v());
            }
            wakes = wakes.wrapping_add(1);
        }
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(debug::EXIT_FAILURE);
    loop {
        cortex_m::asm::wfi();
    }
}
