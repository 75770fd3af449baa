//! One mixer, measured request by request.

use core::mem::MaybeUninit;

use cortex_m_semihosting::hprintln;
use mixer_rt::{Health, Wrench};
use probe::Counter;

use crate::order::Order;
use crate::request::{Request, requests};
use crate::search::Search;
use crate::subject::{self, Mixed};
use crate::{ATTAINABLE, SATURATED};

/// Requests of a set at most, and of those that are given.
pub(crate) const SET: usize = 2_000;
pub(crate) const GIVEN: usize = 64;

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

/// Measures one mixer.
pub(crate) struct Meter {
    counter: Counter,
    /// Requests that were refused, though all are finite.
    refused: u32,
}

impl Meter {
    /// Mixes `request` and returns its instructions.
    pub(crate) fn count(&mut self, request: &Request) -> u32 {
        let mut output = MaybeUninit::<Mixed>::uninit();
        let pointer = output.as_mut_ptr().cast();
        // SAFETY: the output is of the type that `mix` writes, which it does in every call.
        let (instructions, mixed) = unsafe {
            (
                self.counter
                    .count(mix, &request.asked(), pointer, request.voltage_v),
                output.assume_init(),
            )
        };
        self.refused += u32::from(mixed.is_err());
        instructions
    }

    /// As [`Meter::count`], whatever was mixed before.
    pub(crate) fn count_afresh(&mut self, request: &Request) -> u32 {
        subject::prepare();
        self.count(request)
    }

    /// Mixes `request` and returns its stack, bytes.
    fn stack(&self, request: &Request) -> usize {
        let mut output = MaybeUninit::<Mixed>::uninit();
        // SAFETY: the output is of the type that `mix` writes; no interrupt is enabled.
        unsafe {
            probe::high_water(
                mix,
                &request.asked(),
                output.as_mut_ptr().cast(),
                request.voltage_v,
            )
        }
    }

    /// Measures a set and prints its line.
    fn set(
        &mut self,
        name: &str,
        set: impl Iterator<Item = Request>,
        count: fn(&mut Meter, &Request) -> u32,
    ) {
        let mut counts = [0; SET];
        let (mut requests, mut stack) = (0, 0);
        for (request, instructions) in set.zip(&mut counts) {
            *instructions = count(self, &request);
            stack = stack.max(self.stack(&request));
            requests += 1;
        }
        let counts = &mut counts[..requests];
        counts.sort_unstable();
        hprintln!(
            "{} {} {} {} {} {}",
            name,
            requests,
            counts.iter().map(|count| u64::from(*count)).sum::<u64>(),
            counts.get(requests / 2).copied().unwrap_or(0),
            counts.last().copied().unwrap_or(0),
            stack
        );
    }
}

impl Request {
    fn asked(&self) -> Asked {
        Asked {
            setpoint: Wrench::from_array(self.wrench),
            health: self.health,
        }
    }
}

/// Does what is ordered; false if something is wrong with the measurement.
pub(crate) fn run() -> bool {
    probe::with_counter(|counter| {
        let mut meter = Meter { counter, refused: 0 };
        let order = Order::read();
        subject::prepare();
        if order.budget > 0 {
            let sets = requests(ATTAINABLE).chain(requests(SATURATED));
            Search::new(&mut meter).run(order.given().chain(sets), order.budget);
        } else {
            meter.set("attainable", requests(ATTAINABLE), Meter::count);
            meter.set("saturated", requests(SATURATED), Meter::count);
            meter.set("given", order.given(), Meter::count_afresh);
        }
        meter.refused == 0
    })
}
