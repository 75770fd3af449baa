//! The rate loop as an Embassy task: SysTick signals a cycle, a second task measures the battery.
//!
//! `cargo run --release --features embassy --bin embassy`
#![no_std]
#![no_main]

#[path = "../../../firmware/src/board.rs"]
mod board;
#[path = "../../../firmware/src/control.rs"]
mod control;
#[path = "../rate.rs"]
mod rate;

use core::panic::PanicInfo;

use cortex_m_rt::exception;
use cortex_m_semihosting::{debug, hprintln};
use embassy_executor::Spawner;
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_sync::signal::Signal;

use board::DischargingPack;
use control::Battery;
use rate::{CYCLES_PER_MEASUREMENT, RATE_HZ, RateLoop, VOLTAGE};

/// A cycle is due.
static CYCLE: Signal<CriticalSectionRawMutex, ()> = Signal::new();
/// A measurement is due.
static MEASUREMENT: Signal<CriticalSectionRawMutex, ()> = Signal::new();

#[exception]
fn SysTick() {
    CYCLE.signal(());
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let (Ok(fly), Ok(measure)) = (fly(), measure()) else {
        return;
    };
    spawner.spawn(measure);
    spawner.spawn(fly);
    if let Some(peripherals) = cortex_m::Peripherals::take() {
        board::pace(peripherals.SYST, RATE_HZ);
    }
}

#[embassy_executor::task]
async fn fly() {
    let mut rate_loop = RateLoop::new();
    let mut cycles = 0_u32;
    loop {
        CYCLE.wait().await;
        if cycles.is_multiple_of(CYCLES_PER_MEASUREMENT) {
            MEASUREMENT.signal(());
        }
        cycles = cycles.wrapping_add(1);
        if !rate_loop.cycle() {
            break;
        }
    }
    rate_loop.report();
    debug::exit(debug::EXIT_SUCCESS);
}

#[embassy_executor::task]
async fn measure() {
    let mut pack = DischargingPack::full();
    loop {
        MEASUREMENT.wait().await;
        VOLTAGE.measured(pack.voltage_v());
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
