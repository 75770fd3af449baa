//! Mixes the golden vectors of every airframe and compares every bit with what the host computed.
//!
//! Prints one line per airframe: vectors, mismatches, instructions per mix (mean and worst over the vectors) and
//! stack per mix. Exit status 0 if every bit agrees and every non-finite setpoint is refused.
//!
//! A count runs from the call of the mixer to its return, both included. The voltage and two pointers (setpoint,
//! result) go in registers.
#![no_std]
#![no_main]

use core::mem::MaybeUninit;

use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use mixer_rt::{Mix, SetpointError, Wrench};
use probe::{Counter, Mixer};

/// One row of the golden vectors; floats as their f32 bits.
struct Vector<const CHANNELS: usize> {
    /// Roll, pitch, yaw (N m), thrust (N).
    setpoint: [u32; 4],
    voltage_v: u32,
    throttle: [u32; CHANNELS],
    achieved: [u32; 4],
    saturation: u16,
}

/// What a mixer returns.
type Mixed<const CHANNELS: usize> = Result<Mix<CHANNELS>, SetpointError>;

/// Checks the airframe whose module is `$module`, behind the C calling convention.
macro_rules! check {
    ($check:ident, $name:literal, $module:ident, $vectors:ident) => {{
        /// # Safety
        ///
        /// `setpoint` is valid to read, `output` to write a [`Mixed`] of this airframe.
        unsafe extern "C" fn mix(setpoint: *const Wrench, output: *mut (), voltage_v: f32) {
            // SAFETY: the caller's promise.
            unsafe {
                output
                    .cast::<Mixed<{ $module::CHANNELS }>>()
                    .write($module::mix(&*setpoint, voltage_v))
            }
        }
        // SAFETY: `mix` writes the result for as many channels as the vectors have.
        unsafe { $check.airframe::<{ $module::CHANNELS }>($name, &$vectors, mix) }
    }};
}

include!(concat!(env!("OUT_DIR"), "/golden.rs"));

/// Mismatches that are printed in full, per airframe.
const SHOWN: u32 = 5;

struct Check {
    counter: Counter,
    passed: bool,
}

impl Check {
    /// Mixes the vectors of one airframe and prints its line.
    ///
    /// # Safety
    ///
    /// `mix` must write a [`Mixed`] for `CHANNELS` channels.
    unsafe fn airframe<const CHANNELS: usize>(
        &mut self,
        name: &str,
        vectors: &[Vector<CHANNELS>],
        mix: Mixer,
    ) {
        let (mut mismatches, mut sum, mut worst, mut stack) = (0, 0_u64, 0, 0);
        for (row, vector) in vectors.iter().enumerate() {
            let setpoint = wrench(vector.setpoint);
            let voltage_v = f32::from_bits(vector.voltage_v);
            let mut output = MaybeUninit::<Mixed<CHANNELS>>::uninit();
            let pointer = output.as_mut_ptr().cast();
            // SAFETY: the output is of the type that `mix` writes, which it does in every call; no interrupt is
            // enabled.
            let (instructions, bytes, mixed) = unsafe {
                let bytes = probe::high_water(mix, &setpoint, pointer, voltage_v);
                (
                    self.counter.count(mix, &setpoint, pointer, voltage_v),
                    bytes,
                    output.assume_init(),
                )
            };
            sum += u64::from(instructions);
            worst = worst.max(instructions);
            stack = stack.max(bytes);
            if !agrees(vector, &mixed) {
                mismatches += 1;
                if mismatches <= SHOWN {
                    show(name, row, vector, &mixed);
                }
            }
        }
        // SAFETY: as above.
        let accepted = unsafe { accepted_non_finite(vectors, mix) };
        if accepted > 0 {
            hprintln!(
                "{}: {} non-finite setpoints were mixed instead of refused",
                name,
                accepted
            );
        }
        self.passed &= mismatches == 0 && accepted == 0;
        // One decimal in whole numbers: float formatting would be the largest part of this image.
        let tenths = sum * 10 / vectors.len() as u64;
        hprintln!(
            "{:<24} {:>8} {:>10} {:>8}.{} {:>8} {:>8}",
            name,
            vectors.len(),
            mismatches,
            tenths / 10,
            tenths % 10,
            worst,
            stack
        );
    }
}

fn wrench([roll, pitch, yaw, thrust]: [u32; 4]) -> Wrench {
    Wrench {
        roll_nm: f32::from_bits(roll),
        pitch_nm: f32::from_bits(pitch),
        yaw_nm: f32::from_bits(yaw),
        thrust_n: f32::from_bits(thrust),
    }
}

fn bits(wrench: &Wrench) -> [u32; 4] {
    [wrench.roll_nm, wrench.pitch_nm, wrench.yaw_nm, wrench.thrust_n].map(f32::to_bits)
}

fn agrees<const CHANNELS: usize>(expected: &Vector<CHANNELS>, mixed: &Mixed<CHANNELS>) -> bool {
    mixed.as_ref().is_ok_and(|mix| {
        mix.throttle.map(f32::to_bits) == expected.throttle
            && bits(&mix.achieved) == expected.achieved
            && mix.saturation.bits() == expected.saturation
    })
}

fn show<const CHANNELS: usize>(name: &str, row: usize, expected: &Vector<CHANNELS>, mixed: &Mixed<CHANNELS>) {
    // Line 1 of the file is the header.
    hprintln!("{}.vectors.csv:{}: throttle, achieved, saturation", name, row + 2);
    hprintln!(
        "  host   {:08x?} {:08x?} {}",
        expected.throttle,
        expected.achieved,
        expected.saturation
    );
    match mixed {
        Ok(mix) => hprintln!(
            "  target {:08x?} {:08x?} {}",
            mix.throttle.map(f32::to_bits),
            bits(&mix.achieved),
            mix.saturation.bits()
        ),
        Err(_) => hprintln!("  target refused the setpoint"),
    }
}

/// How many of the first vector's setpoints with one axis not finite were mixed all the same.
///
/// # Safety
///
/// `mix` must write a [`Mixed`] for `CHANNELS` channels.
unsafe fn accepted_non_finite<const CHANNELS: usize>(vectors: &[Vector<CHANNELS>], mix: Mixer) -> u32 {
    let mut accepted = 0;
    for vector in vectors.iter().take(1) {
        for axis in 0..4 {
            for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut setpoint = vector.setpoint;
                setpoint[axis] = value.to_bits();
                let mut output = MaybeUninit::<Mixed<CHANNELS>>::uninit();
                // SAFETY: the output is of the type that `mix` writes, which it does in every call.
                let mixed = unsafe {
                    mix(
                        &wrench(setpoint),
                        output.as_mut_ptr().cast(),
                        f32::from_bits(vector.voltage_v),
                    );
                    output.assume_init()
                };
                accepted += u32::from(mixed.is_ok());
            }
        }
    }
    accepted
}

#[entry]
fn main() -> ! {
    probe::exit(probe::with_counter(run))
}

fn run(counter: Counter) -> bool {
    hprintln!(
        "instructions per mix, less {} of the measurement itself",
        counter.overhead()
    );
    hprintln!(
        "{:<24} {:>8} {:>10} {:>10} {:>8} {:>8}",
        "airframe",
        "vectors",
        "mismatches",
        "mean",
        "worst",
        "stack_b"
    );
    let mut check = Check {
        counter,
        passed: true,
    };
    for_each_airframe(&mut check);
    check.passed
}
