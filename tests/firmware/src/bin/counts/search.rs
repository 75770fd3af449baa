//! A search for the requests that cost most: mutation and selection, in populations apart.
//!
//! What a mix costs changes in steps, with the branches that it takes, and is level in between.
//! Hence a child replaces its parent where it costs as much: it drifts over the level parts. A
//! population that starts from other requests ends on another hill. So there are many, of which the
//! better half goes on at a time, until one is left.

use core::cmp::Reverse;

use cortex_m_semihosting::hprintln;
use mixer_setpoints::Random;

use crate::measurement::{GIVEN, Meter, SET};
use crate::request::{Request, vary};

/// Requests that live at a time.
const POPULATION: usize = 16;
/// Populations at the start, a power of two.
const POPULATIONS: usize = 16;
/// Of as many requests the most expensive starts a member of a population.
const TOURNAMENT: usize = 8;
/// One child in as many takes the place of any member, not of its parent.
const MIGRATION: u32 = 16;
/// The search ends after as many mixes, or after its budget of instructions.
const MIXES: u64 = 1_000_000;

/// What a request costs, and the request.
type Costly = (u32, Request);

const NOTHING: Costly = (0, Request::NOTHING);

/// The state of a search.
pub(crate) struct Search<'a> {
    meter: &'a mut Meter,
    random: Random,
    /// Instructions of mixes, and mixes.
    spent: u64,
    mixes: u64,
}

impl<'a> Search<'a> {
    pub(crate) fn new(meter: &'a mut Meter) -> Self {
        Search {
            meter,
            random: Random::new(1),
            spent: 0,
            mixes: 0,
        }
    }

    /// Searches from the requests of `start` for `budget` instructions of mixes, and prints the best
    /// of every population, the best of all first: what it costs, and the request.
    pub(crate) fn run(&mut self, start: impl Iterator<Item = Request>, budget: u64) {
        let mut pool = [NOTHING; 2 * SET + GIVEN];
        let mut started = 0;
        for (slot, request) in pool.iter_mut().zip(start) {
            *slot = (self.count(&request), request);
            started += 1;
        }
        let pool = &pool[..started];
        let mut populations = [(); POPULATIONS].map(|()| [(); POPULATION].map(|()| self.drawn(pool)));
        // What is given is what was found before: none of it is left to chance.
        populations[0][0] = most(pool);
        // Every round takes as much: 16 populations, 8, 4, 2, 1.
        let rounds = u64::from(POPULATIONS.ilog2() + 1);
        let mut alive = POPULATIONS;
        while alive > 0 {
            let parts = rounds * alive as u64;
            for members in &mut populations[..alive] {
                (self.spent, self.mixes) = (0, 0);
                while self.spent < budget / parts && self.mixes < MIXES / parts {
                    self.evolve(members);
                }
            }
            populations.sort_unstable_by_key(|members| Reverse(most(members).0));
            alive /= 2;
        }
        for (cost, request) in populations.iter().map(|members| most(members)) {
            hprintln!("{} {}", cost, request);
        }
    }

    /// The most expensive of a few of `pool`.
    fn drawn(&mut self, pool: &[Costly]) -> Costly {
        most(&[(); TOURNAMENT].map(|()| pool[self.random.below(pool.len())]))
    }

    /// One child, which lives if it costs as much as the member whose place it takes.
    fn evolve(&mut self, members: &mut [Costly; POPULATION]) {
        let [parent, other, third, any] = [(); 4].map(|()| self.random.below(POPULATION));
        let child = vary(
            &mut self.random,
            members[parent].1,
            members[other].1,
            members[third].1,
        );
        let place = if self.random.index(MIGRATION) == 0 {
            any
        } else {
            parent
        };
        let cost = self.count(&child);
        if cost >= members[place].0 {
            members[place] = (cost, child);
        }
    }

    /// What a request costs; nothing where it is not finite.
    fn count(&mut self, request: &Request) -> u32 {
        self.mixes += 1;
        if !request.is_finite() {
            return 0;
        }
        let cost = self.meter.count_afresh(request);
        self.spent += u64::from(cost);
        cost
    }
}

/// The most expensive.
fn most(requests: &[Costly]) -> Costly {
    let most = requests.iter().max_by_key(|(cost, _)| *cost);
    most.copied().unwrap_or(NOTHING)
}
