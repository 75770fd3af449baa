//! Mixes the golden vectors of every airframe, with all rotors and with one out, and compares every
//! bit with what the host computed.
//!
//! Prints one line per airframe: vectors, mismatches, instructions per mix (mean and worst over the
//! vectors), stack per mix and the floating-point exceptions that its mixes raise, with all rotors
//! and with one out (1 invalid operation, 2 division by zero, 4 overflow, in sum). Exit status 0 if
//! every bit agrees and every non-finite setpoint is refused.
//!
//! A count runs from the call of the mixer to its return, both included. The voltage and two
//! pointers (setpoint with density, result) go in registers.
#![no_std]
#![no_main]

use core::mem::MaybeUninit;

use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;
use harness::{agrees, differing_with_rotors_out, request, rows};
use mixer_rt::{Conditions, Mix, SetpointError, Wrench};
use probe::{Counter, Mixer};

#[path = "../vectors/harness.rs"]
mod harness;

/// A setpoint and the air's density, kg/m3.
type Asked = (Wrench, Conditions);

/// What a mixer returns.
type Mixed<const CHANNELS: usize> = Result<Mix<CHANNELS>, SetpointError>;

/// Checks the airframe whose module is `$module`, behind the C calling convention.
macro_rules! check {
    ($check:ident, $name:literal, $module:ident, $vectors:expr, $rotors_out:expr) => {{
        /// # Safety
        ///
        /// `asked` is valid to read, `output` to write a [`Mixed`] of this airframe.
        unsafe extern "C" fn mix(asked: *const Asked, output: *mut (), _: f32) {
            // SAFETY: the caller's promise.
            unsafe {
                let (setpoint, conditions) = *asked;
                output
                    .cast::<Mixed<{ $module::CHANNELS }>>()
                    .write($module::mix(&setpoint, conditions))
            }
        }
        let mut different = 0;
        let raised = probe::exceptions(|| {
            different = differing_with_rotors_out($rotors_out, |setpoint, conditions, health| {
                $module::mix_with_health(setpoint, conditions, health)
            });
        });
        $check.rotors_out($name, different);
        // SAFETY: `mix` writes the result for as many channels as the vectors have.
        unsafe { $check.airframe::<{ $module::CHANNELS }>($name, $vectors, mix, raised) };
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
    /// Notes how many rows with rotors out differ.
    fn rotors_out(&mut self, name: &str, differing: usize) {
        if differing > 0 {
            hprintln!("{}.rotors-out.csv: {} rows differ", name, differing);
            self.passed = false;
        }
    }

    /// Mixes the vectors of one airframe and prints its line. `raised_with_rotors_out` are the
    /// exceptions of the vectors with a rotor out.
    ///
    /// # Safety
    ///
    /// `mix` must write a [`Mixed`] for `CHANNELS` channels.
    unsafe fn airframe<const CHANNELS: usize>(
        &mut self,
        name: &str,
        table: &str,
        mix: Mixer<Asked>,
        raised_with_rotors_out: u32,
    ) {
        let vectors = rows(table);
        let count = vectors.clone().count();
        let (mut mismatches, mut sum, mut worst, mut stack) = (0, 0_u64, 0, 0);
        let raised = probe::exceptions(|| {
            for (row, vector) in vectors.clone().enumerate() {
                let Some((setpoint, conditions)) = request(vector, CHANNELS) else {
                    hprintln!("{}: row {} of the vectors is too short", name, row);
                    self.passed = false;
                    continue;
                };
                let mut output = MaybeUninit::<Mixed<CHANNELS>>::uninit();
                let pointer = output.as_mut_ptr().cast();
                let asked = (setpoint, conditions);
                let voltage_v = conditions.voltage_v;
                // SAFETY: the output is of the type that `mix` writes, which it does in every call; no
                // interrupt is enabled.
                let (instructions, bytes, mixed) = unsafe {
                    let bytes = probe::high_water(mix, &asked, pointer, voltage_v);
                    (
                        self.counter.count(mix, &asked, pointer, voltage_v),
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
        });
        // SAFETY: as above.
        let accepted = unsafe { accepted_non_finite::<CHANNELS>(vectors, mix) };
        if accepted > 0 {
            hprintln!(
                "{}: {} non-finite setpoints were mixed instead of refused",
                name,
                accepted
            );
        }
        self.passed &= mismatches == 0 && accepted == 0;
        // One decimal in whole numbers: float formatting would be the largest part of this image.
        let tenths = sum * 10 / count as u64;
        hprintln!(
            "{:<24} {:>8} {:>10} {:>8}.{} {:>8} {:>8} {:>10} {:>10}",
            name,
            count,
            mismatches,
            tenths / 10,
            tenths % 10,
            worst,
            stack,
            raised,
            raised_with_rotors_out
        );
    }
}

fn show<const CHANNELS: usize>(name: &str, row: usize, expected: &str, mixed: &Mixed<CHANNELS>) {
    // Line 1 of the file is the header.
    hprintln!(
        "{}.vectors.csv:{}: request, throttle, achieved, saturation",
        name,
        row + 2
    );
    hprintln!("  host   {}", expected);
    match mixed {
        Ok(mix) => hprintln!(
            "  target {:08x?} {:08x?} {:08x}",
            mix.throttle.map(f32::to_bits),
            mix.achieved.to_array().map(f32::to_bits),
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
unsafe fn accepted_non_finite<'a, const CHANNELS: usize>(
    vectors: impl Iterator<Item = &'a str>,
    mix: Mixer<Asked>,
) -> u32 {
    let mut accepted = 0;
    let requests = vectors.take(1).filter_map(|row| request(row, CHANNELS));
    for (setpoint, conditions) in requests {
        for axis in 0..4 {
            for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let mut setpoint = setpoint.to_array();
                setpoint[axis] = value;
                let mut output = MaybeUninit::<Mixed<CHANNELS>>::uninit();
                // SAFETY: the output is of the type that `mix` writes, which it does in every call.
                let mixed = unsafe {
                    let asked = (Wrench::from_array(setpoint), conditions);
                    mix(&asked, output.as_mut_ptr().cast(), conditions.voltage_v);
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
        "{:<24} {:>8} {:>10} {:>10} {:>8} {:>8} {:>10} {:>10}",
        "airframe",
        "vectors",
        "mismatches",
        "mean",
        "worst",
        "stack_b",
        "exceptions",
        "rotors_out"
    );
    let mut check = Check {
        counter,
        passed: true,
    };
    for_each_airframe(&mut check);
    check.passed
}
