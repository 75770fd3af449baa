//! A control loop with a compiled mixer, as it would stand in a flight controller.
//!
//! SysTick paces the loop at 400 Hz. Every cycle takes the rate controller's wrench and the
//! battery's voltage, mixes, and writes the rotors' speed controllers. A setpoint that is not
//! finite leaves the rotors as they are; when it lasts, they are stopped. Run it with `cargo run
//! --release`.
#![no_std]
#![no_main]

mod board;
mod control;
mod flight;

use core::panic::PanicInfo;

use cortex_m_rt::{entry, exception};
use cortex_m_semihosting::{debug, hprintln};

use board::{DischargingPack, Pulses};
use control::{Cycle, MotorControl};

mixer_macros::airframe!("../../airframes/isae-x8.toml");

const RATE_HZ: u32 = 400;
/// A tenth of a second without a usable setpoint stops the rotors.
const PATIENCE: u32 = RATE_HZ / 10;

#[exception]
fn SysTick() {
    // Waking the loop is all there is to do.
}

#[entry]
fn main() -> ! {
    if let Some(peripherals) = cortex_m::Peripherals::take() {
        board::pace(peripherals.SYST, RATE_HZ);
        fly();
        debug::exit(debug::EXIT_SUCCESS);
    }
    loop {
        cortex_m::asm::wfi();
    }
}

fn fly() {
    let mut motors = MotorControl::new(isae_x8::mix, Pulses::new(), DischargingPack::full(), PATIENCE);
    let (mut mixed, mut saturated, mut held, mut disarmed) = (0, 0, 0, 0);
    let mut most_yaw_nm = 0.0_f32;
    for cycle in 0.. {
        cortex_m::asm::wfi();
        let Some(setpoint) = flight::setpoint(cycle) else {
            break;
        };
        match motors.cycle(&setpoint) {
            Cycle::Mixed { achieved, saturation } => {
                most_yaw_nm = achieved.yaw_nm.max(most_yaw_nm);
                mixed += 1;
                saturated += u32::from(saturation.bits() != 0);
            }
            Cycle::Held => held += 1,
            Cycle::Disarmed => disarmed += 1,
        }
        // A flight controller would log at a lower rate, and never to a debugger.
        if cycle % RATE_HZ == 0 {
            hprintln!("cycle {}: pulses {:?} us", cycle, motors.outputs().width_us);
        }
    }
    hprintln!("mixed {}, held {}, disarmed {}", mixed, held, disarmed);
    hprintln!(
        "saturated {}, yaw at most {} mN m",
        saturated,
        (1e3 * most_yaw_nm) as i32
    );
    hprintln!("pulses after landing {:?} us", motors.outputs().width_us);
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(debug::EXIT_FAILURE);
    loop {
        cortex_m::asm::wfi();
    }
}
