//! One mixer, measured request by request.

use core::mem::MaybeUninit;

use cortex_m_semihosting::hprintln;
use mixer_rt::{Health, Wrench};
use mixer_setpoints::RotorsOut;
use probe::Counter;

use crate::search::Search;
use crate::subject::{self, Mixed};
use crate::{ATTAINABLE, SATURATED};

/// Where the sequence of the rotors that are out starts.
const SEED: u64 = 9;

/// A wrench, which rotors are out, and the battery's voltage.
#[derive(Clone, Copy)]
pub(crate) struct Request {
    /// Roll, pitch, yaw (N m), thrust (N).
    pub(crate) wrench: [f32; 4],
    pub(crate) health: Health,
    /// V.
    pub(crate) voltage_v: f32,
}

impl Request {
    /// Asks for nothing.
    pub(crate) const NOTHING: Request = Request {
        wrench: [0.0; 4],
        health: Health::GOOD,
        voltage_v: 0.0,
    };
}

/// Requests as the build script has written them, to as many rotors less as the subject is asked
/// with.
pub(crate) fn requests(bytes: &'static [u8]) -> impl Iterator<Item = Request> {
    let healths = RotorsOut::new(SEED, subject::airframe::CHANNELS, subject::ROTORS_OUT);
    bytes.chunks_exact(20).zip(healths).map(|(row, health)| {
        let mut values = [0.0; 5];
        for (value, bytes) in values.iter_mut().zip(row.chunks_exact(4)) {
            let mut word = [0; 4];
            word.copy_from_slice(bytes);
            *value = f32::from_le_bytes(word);
        }
        let [roll, pitch, yaw, thrust, voltage_v] = values;
        Request {
            wrench: [roll, pitch, yaw, thrust],
            health,
            voltage_v,
        }
    })
}

/// What a mixer is asked by, beside the voltage.
struct Asked {
    setpoint: Wrench,
    health: Health,
}

/// # Safety
///
/// `asked` is valid to read, `output` to write a [`Mixed`].
unsafe extern "C" fn mix(asked: *const Asked, output: *mut (), voltage_v: f32) {
    // SAFETY: the caller's promise.
    unsafe {
        let Asked { setpoint, health } = &*asked;
        output
            .cast::<Mixed>()
            .write(subject::mix(setpoint, voltage_v, *health))
    }
}

/// What the requests of one set cost.
pub(crate) struct Tally {
    requests: u32,
    sum: u64,
    worst: u32,
    /// Zero where it is not known.
    median: u32,
    stack: usize,
    dearest: Request,
    /// Requests that were refused, though all are finite.
    refused: u32,
}

impl Tally {
    pub(crate) fn new() -> Self {
        Tally {
            requests: 0,
            sum: 0,
            worst: 0,
            median: 0,
            stack: 0,
            dearest: Request::NOTHING,
            refused: 0,
        }
    }

    /// Mixes `request`, once for the instructions, which it returns, and once for the stack.
    pub(crate) fn measure(&mut self, counter: &Counter, request: &Request) -> u32 {
        let asked = Asked {
            setpoint: Wrench::from_array(request.wrench),
            health: request.health,
        };
        let mut output = MaybeUninit::<Mixed>::uninit();
        let pointer = output.as_mut_ptr().cast();
        // SAFETY: the output is of the type that `mix` writes, which it does in every call; no
        // interrupt is enabled.
        let (instructions, stack, mixed) = unsafe {
            (
                counter.count(mix, &asked, pointer, request.voltage_v),
                probe::high_water(mix, &asked, pointer, request.voltage_v),
                output.assume_init(),
            )
        };
        self.refused += u32::from(mixed.is_err());
        self.requests += 1;
        self.sum += u64::from(instructions);
        self.stack = self.stack.max(stack);
        if instructions > self.worst {
            self.worst = instructions;
            self.dearest = *request;
        }
        instructions
    }

    /// How many there were.
    pub(crate) fn requests(&self) -> usize {
        self.requests as usize
    }

    pub(crate) fn set_median(&mut self, instructions: u32) {
        self.median = instructions;
    }

    /// Instructions of all requests.
    pub(crate) fn instructions(&self) -> u64 {
        self.sum
    }

    /// Prints a line; false if a request was refused.
    pub(crate) fn print(&self, set: &str) -> bool {
        let [roll, pitch, yaw, thrust] = self.dearest.wrench.map(f32::to_bits);
        hprintln!(
            "{} {} {} {} {} {} {:08x},{:08x},{:08x},{:08x},{:08x}",
            set,
            self.requests,
            self.sum,
            self.median,
            self.worst,
            self.stack,
            roll,
            pitch,
            yaw,
            thrust,
            self.dearest.voltage_v.to_bits()
        );
        self.refused == 0
    }
}

/// Measures and prints all sets; false if something is wrong with the measurement.
pub(crate) fn run() -> bool {
    probe::with_counter(|counter| {
        subject::prepare();
        let attainable = Search::new(&counter).set(ATTAINABLE);
        let mut search = Search::new(&counter);
        let saturated = search.set(SATURATED);
        let searched = search.vary();
        attainable.print("attainable") & saturated.print("saturated") & searched.print("searched")
    })
}
