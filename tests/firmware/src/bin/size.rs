//! One mixer and nothing else.
//!
//! Built with a mixer chosen (see `src/subject`) this image reads a setpoint and a voltage from
//! registers, mixes, and writes the result to registers; built without, it does nothing. The
//! difference between the two in `.text` and `.rodata` is what the mixer adds to an image: code,
//! tables, and the two dozen loads and stores around it.
//!
//! Except for `wls`, whose crate can panic, the image links only if no panic can be reached: the
//! panic handler calls a function that does not exist. `--cfg panic_path` adds an index that may be
//! out of range, so that a test can see the link fail.
#![no_std]
#![no_main]

use core::panic::PanicInfo;

use cortex_m_rt::entry;

#[cfg(airframe)]
#[path = "../subject/mod.rs"]
mod subject;

/// Any place that the optimiser knows nothing about; the image is measured, never run.
#[cfg(any(airframe, panic_path))]
const REGISTERS: *mut u32 = 0x4000_0000 as *mut u32;

#[entry]
fn main() -> ! {
    #[cfg(airframe)]
    subject::prepare();
    loop {
        #[cfg(airframe)]
        step();
        #[cfg(panic_path)]
        // SAFETY: a volatile access to a device register.
        unsafe {
            let table = [1_u32, 2, 3, 5];
            REGISTERS.write_volatile(table[REGISTERS.read_volatile() as usize]);
        }
        cortex_m::asm::wfi();
    }
}

#[cfg(airframe)]
fn step() {
    // SAFETY: volatile accesses to device registers.
    let read = |offset: usize| f32::from_bits(unsafe { REGISTERS.add(offset).read_volatile() });
    let write = |offset: usize, bits: u32| unsafe { REGISTERS.add(offset).write_volatile(bits) };
    let setpoint = mixer_rt::Wrench {
        roll_nm: read(0),
        pitch_nm: read(1),
        yaw_nm: read(2),
        thrust_n: read(3),
    };
    let health = match subject::ROTORS_OUT {
        0 => mixer_rt::Health::GOOD,
        // The channels of rotors that the vehicle has found out.
        _ => mixer_rt::Health::GOOD.with_failed(read(11).to_bits() as u8),
    };
    match subject::mix(&setpoint, read(4), health) {
        #[cfg(baseline)]
        Ok((throttle, within)) => {
            for (offset, throttle) in throttle.iter().enumerate() {
                write(16 + offset, throttle.to_bits());
            }
            write(9, u32::from(within));
        }
        #[cfg(not(baseline))]
        Ok(mix) => {
            for (offset, throttle) in mix.throttle.iter().enumerate() {
                write(16 + offset, throttle.to_bits());
            }
            write(5, mix.achieved.roll_nm.to_bits());
            write(6, mix.achieved.pitch_nm.to_bits());
            write(7, mix.achieved.yaw_nm.to_bits());
            write(8, mix.achieved.thrust_n.to_bits());
            write(9, u32::from(mix.saturation.bits()));
        }
        Err(_) => write(10, 1),
    }
}

#[cfg(not(baseline = "wls"))]
unsafe extern "C" {
    /// Defined nowhere.
    safe fn the_mixer_can_panic() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    #[cfg(not(baseline = "wls"))]
    the_mixer_can_panic();
    #[cfg(baseline = "wls")]
    loop {}
}
