//! A search for the requests that cost most.

use probe::Counter;

use crate::measurement::{Request, Tally, requests};

/// Dearest requests that the search varies.
const POOL: usize = 16;
const ROUNDS: u32 = 4_000;

/// A request and what it cost.
type Costly = (u32, Request);

struct Search<'a> {
    counter: &'a Counter,
    tally: Tally,
    pool: [Costly; POOL],
}

impl Search<'_> {
    fn try_request(&mut self, request: Request) {
        let instructions = self.tally.measure(self.counter, &request);
        if let Some(cheapest) = self.pool.iter_mut().min_by_key(|(cost, _)| *cost)
            && instructions > cheapest.0
        {
            *cheapest = (instructions, request);
        }
    }
}

/// Varies the dearest requests of `bytes` by all magnitudes, one value or all at a time, and keeps what costs more:
/// it follows the branches of a mixer to where several are taken at once.
pub(crate) fn dearest(counter: &Counter, bytes: &'static [u8]) -> Tally {
    let nothing = Request {
        wrench: [0.0; 4],
        voltage_v: 0.0,
    };
    let mut search = Search {
        counter,
        tally: Tally::new(),
        pool: [(0, nothing); POOL],
    };
    for request in requests(bytes) {
        search.try_request(request);
    }
    let mut random = Random(1);
    for _ in 0..ROUNDS {
        let draw = random.bits();
        let (_, request) = search.pool[draw as usize % POOL];
        let varied = random.vary(request, (draw >> 8) % 24, (draw >> 16) % 8);
        if varied.wrench.iter().all(|value| value.is_finite()) {
            search.try_request(varied);
        }
    }
    search.tally
}

/// Xorshift (Marsaglia 2003), 32 bits.
struct Random(u32);

impl Random {
    fn bits(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// Uniform in [-1, 1).
    fn signed(&mut self) -> f32 {
        self.bits() as i32 as f32 * (1.0 / 2_147_483_648.0)
    }

    /// Changes values by up to 2^-`halvings` of themselves: 0 to 3 an axis, 4 the voltage, from 5 on all of them.
    fn vary(&mut self, mut request: Request, halvings: u32, which: u32) -> Request {
        let mut size = 1.0;
        for _ in 0..halvings {
            size *= 0.5;
        }
        for (axis, value) in (0..).zip(request.wrench.iter_mut()) {
            if which == axis || which > 4 {
                *value += size * self.signed() * *value;
            }
        }
        if which > 3 {
            request.voltage_v += 0.1 * size * self.signed() * request.voltage_v;
        }
        request
    }
}
