//! A search for the requests that cost most.

use mixer_setpoints::Random;
use probe::Counter;

use crate::measurement::{Request, Tally, requests};

/// Requests of a set at most.
const SET: usize = 4_000;
/// Most expensive requests that the search varies.
const POOL: usize = 16;
/// The search ends after as many variations or instructions.
const ROUNDS: u32 = 20_000;
const BUDGET: u64 = 80_000_000;

/// Steps of 2^-0 to 2^-23 of a value.
const HALVINGS: u32 = 24;
const SIGNED: [f32; 2] = [-1.0, 1.0];

/// A request and what it cost.
type Costly = (u32, Request);

/// Keeps the most expensive requests of what it measures.
pub(crate) struct Search<'a> {
    counter: &'a Counter,
    pool: [Costly; POOL],
}

impl<'a> Search<'a> {
    pub(crate) fn new(counter: &'a Counter) -> Self {
        Search {
            counter,
            pool: [(0, Request::NOTHING); POOL],
        }
    }

    /// Measures the requests of one set.
    pub(crate) fn set(&mut self, bytes: &'static [u8]) -> Tally {
        let mut tally = Tally::new();
        let mut counts = [0; SET];
        for (request, count) in requests(bytes).zip(&mut counts) {
            *count = self.measure(&mut tally, request);
        }
        let counts = &mut counts[..tally.requests()];
        if !counts.is_empty() {
            tally.set_median(*counts.select_nth_unstable(counts.len() / 2).1);
        }
        tally
    }

    /// Varies the most expensive requests so far by all magnitudes, one value or all at a time, and
    /// keeps what costs more: it follows the branches of a mixer to where several are taken at
    /// once.
    pub(crate) fn vary(&mut self) -> Tally {
        let mut tally = Tally::new();
        for (_, request) in self.pool {
            self.measure(&mut tally, request);
        }
        let mut random = Random::new(1);
        for _ in 0..ROUNDS {
            let (_, request) = self.pool[random.below(POOL)];
            let (halvings, which) = (random.index(HALVINGS), random.index(8));
            let varied = vary(&mut random, request, halvings, which);
            if varied.wrench.iter().all(|value| value.is_finite()) {
                self.measure(&mut tally, varied);
            }
            if tally.instructions() > BUDGET {
                break;
            }
        }
        tally
    }

    fn measure(&mut self, tally: &mut Tally, request: Request) -> u32 {
        let instructions = tally.measure(self.counter, &request);
        if let Some(cheapest) = self.pool.iter_mut().min_by_key(|(cost, _)| *cost)
            && instructions > cheapest.0
        {
            *cheapest = (instructions, request);
        }
        instructions
    }
}

/// Changes values by up to 2^-`halvings` of themselves: 0 to 3 an axis, 4 the voltage, from 5 on
/// all of them.
fn vary(random: &mut Random, mut request: Request, halvings: u32, which: u32) -> Request {
    let mut size = 1.0;
    for _ in 0..halvings {
        size *= 0.5;
    }
    for (axis, value) in (0..).zip(request.wrench.iter_mut()) {
        if which == axis || which > 4 {
            *value += size * random.between(SIGNED) * *value;
        }
    }
    if which > 3 {
        request.voltage_v += 0.1 * size * random.between(SIGNED) * request.voltage_v;
    }
    request
}
