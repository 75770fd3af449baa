//! What the host wants of the image: QEMU's loader puts it into memory that nothing else uses.

use mixer_rt::Health;

use crate::request::Request;

/// The board's PSRAM, which `memory.x` leaves alone. `tests/src/firmware.rs` has the same.
const ADDRESS: *const u32 = 0x2100_0000 as *const u32;
/// The first word of an order. Memory without one is zero.
const MARK: u32 = 0x4f52_4445;
/// Words before the requests, and of each.
const HEAD: usize = 4;
const WORDS: usize = 7;

/// The order.
#[derive(Clone, Copy)]
pub(crate) struct Order {
    /// Instructions of mixes after which the search ends; 0 for none.
    pub(crate) budget: u64,
    /// Requests that come with the order.
    given: usize,
}

impl Order {
    pub(crate) fn read() -> Order {
        match word(0) {
            MARK => Order {
                budget: u64::from(word(1)) << 32 | u64::from(word(2)),
                given: word(3) as usize,
            },
            _ => Order { budget: 0, given: 0 },
        }
    }

    /// The requests that come with it.
    pub(crate) fn given(self) -> impl Iterator<Item = Request> {
        (0..self.given).map(|index| {
            let at = |offset| word(HEAD + WORDS * index + offset);
            let failed = u64::from(at(5)) << 32 | u64::from(at(6));
            Request {
                wrench: [0, 1, 2, 3].map(|axis| f32::from_bits(at(axis))),
                voltage_v: f32::from_bits(at(4)),
                health: (0..64)
                    .filter(|channel| failed >> channel & 1 != 0)
                    .fold(Health::GOOD, Health::with_failed),
            }
        })
    }
}

fn word(index: usize) -> u32 {
    // SAFETY: memory of the board, 16 MiB of it.
    unsafe { ADDRESS.add(index).read_volatile() }
}
