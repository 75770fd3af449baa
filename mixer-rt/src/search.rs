//! Desaturation with rotors out: rounds of tangents, and the best of the optima to which these lead.
//!
//! The line that stands for a single rotor's curve is drawn again wherever the unit has come to, until line and curve
//! meet ([`crate::chord`]). What is found so is an optimum among the efforts near by; a curve is not convex, so there may
//! be a better one elsewhere. Where something is left to be wished for, one round is therefore taken on hulls about the
//! curves ([`crate::hull`]): if even these give nothing better, there is no better end. Otherwise the rounds are begun anew
//! where the hulls have led, then on every quarter of the curve, or with several curves on every combination of halves of
//! the first two, and last from the best end found so far: on the whole curves, then on ever shorter parts of them about
//! it, since from line to line a unit may step to and fro over an optimum between. The best of all ends stands.
//!
//! With airmode disabled, where less thrust is asked for than roll = pitch = 0 needs, the least thrust that these need is
//! searched for first in the same way, since it is what is allowed then. Whether it is enough is not left to the lines of
//! another end: with them roll = pitch = 0 may look attainable where it is not.
//!
//! Ends are compared by their priorities, bounds first, but so that no more of one is given up for all of the next than
//! [`NEXT`]: two optima whose roll and pitch differ by rounding may differ by all of the thrust. Where the request changes
//! and another optimum becomes the best the efforts jump, as any choice by these priorities must.

use crate::chord::{Chord, Sets};
use crate::desaturation::{Airmode, Outcome, REQUEST_LIMIT, Rival, prioritise, single_rotor};
use crate::hull::{Bend, Hull};
use crate::scratch::Scratch;
use crate::{Quantity, Tables};

/// Halvings of the curves in all: one curve is tried in quarters, two in halves.
const HALVINGS: u32 = 2;

/// Rounds at most from whole curves, and from parts or where hulls have led: 12 + 1 + 6 + 4 x 6 + 12 at worst, and 36 more
/// about the best end. Most ends are reached in one to four.
const ROUNDS: u32 = 12;
const ROUNDS_OF_PARTS: u32 = 6;

/// Curves that hulls are drawn about at most. The best end is as good as theirs if that is better by no more than this in
/// the first priority in which they differ, in rows: 0.1 % of the X8's authority.
const HULLS: usize = 2;
const AS_GOOD: f32 = 2e-3;

/// Parts about the best end: their first reach to either side as a share of the curve, how much shorter the next one is where
/// nothing was gained, the last reach, the least gain, parts at most, and rounds on each.
const REACH: f32 = 0.25;
const CLOSER: f32 = 0.25;
const LEAST_REACH: f32 = 1e-3;
const GAIN: f32 = 1e-6;
const APPROACHES: u32 = 12;
const ROUNDS_OF_APPROACH: u32 = 3;

/// Share of the mixer's tolerance by which lines and curves may be apart.
const TOUCHING: f32 = 0.25;

/// What is given up of one priority for all of the next, in rows.
const NEXT: f32 = 0.005;

/// What leaving the bounds costs, beside falling short in the first priority: so much that no end gains by it.
const BEYOND: f32 = 1e3;

/// Rows beyond their bounds by less than this are within, but for rounding and what lines and curves are apart.
const WITHIN: f32 = 4e-4;

/// An end that is worse by more than this after a round, or after [`TRIED`] of them, will not be the best. The lines
/// of the first rounds are off their curves by about a tenth of that.
const HOPELESS: f32 = 0.1;
const TRIED: u32 = 4;

/// Rows that miss by less are delivered.
const DELIVERED: f32 = 1e-3;

/// Where rounds end.
#[derive(Clone, Copy)]
struct End {
    /// The lines meet their curves.
    touches: bool,
    rounds: u32,
    outcome: Outcome,
}

impl End {
    /// True where roll = pitch = 0, the request, needs no more than `thrust`.
    fn is_level_at(&self, thrust: f32) -> bool {
        self.touches && self.outcome.is_within() && self.outcome.thrust <= thrust
    }
}

impl Outcome {
    /// Lower is better.
    fn cost(&self) -> f32 {
        let [first, second, third] = self.short;
        let beyond = if self.is_within() {
            0.0
        } else {
            self.beyond - WITHIN
        };
        BEYOND * beyond + first + NEXT * (second + NEXT * third)
    }

    /// True where the thrust asked for is enough.
    fn is_allowed(&self) -> bool {
        let [.., thrust] = self.wanted;
        self.is_within() && self.ceiling <= thrust
    }

    pub(crate) fn is_within(&self) -> bool {
        self.beyond < WITHIN
    }

    fn is_delivered(&self) -> bool {
        self.beyond < DELIVERED && self.short.iter().all(|short| *short < DELIVERED)
    }
}

/// A frame and what is asked of it.
pub(crate) struct Search<'s, 't, P, I, S> {
    tables: &'s Tables<'t, P, I, S>,
    request: [f32; 4],
    factors: [f32; 2],
    /// As in [`prioritise`].
    ceiling: Option<f32>,
}

/// Finds attainable efforts (`[f, Q]` at the reference voltage, in the scratch) that serve `request` (`[roll,
/// pitch, yaw, thrust]`, bounded) in the order of priority. `factors` is `[k_f, k_Q]`.
pub(crate) fn desaturate<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: [f32; 4],
    factors: [f32; 2],
    scratch: &mut [Scratch],
) {
    let mut search = Search {
        tables,
        request,
        factors,
        ceiling: None,
    };
    let singles = scratch
        .iter()
        .filter(|scratch| scratch.rotors.is_single())
        .count();
    if singles == 0 {
        let outcome = search.round(scratch, &[], None);
        if !outcome.is_delivered() {
            search.leave_hollows(scratch, outcome);
        }
        return;
    }
    let halvings = if singles == 1 { HALVINGS } else { 1 };
    search.draw(scratch, 0, 0);
    let mut first = search.settle(scratch, ROUNDS, None);
    if first.outcome.is_delivered() {
        return;
    }
    keep(scratch);
    search.ceiling = Some(first.outcome.ceiling);
    if tables.desaturation.airmode == Airmode::Disabled {
        let [.., yaw, _] = request;
        let lowest = Search {
            request: [0.0, 0.0, yaw, -REQUEST_LIMIT],
            ceiling: Some(REQUEST_LIMIT),
            ..search
        };
        lowest.draw(scratch, 0, 0);
        let mut floor = lowest.settle(scratch, ROUNDS, None);
        let [along, _, _, thrust] = first.outcome.wanted;
        if !(first.outcome.is_allowed() && floor.is_level_at(thrust)) {
            keep(scratch);
            lowest.search(scratch, halvings, &mut floor);
            search.ceiling = Some(floor.outcome.thrust);
            // From there: roll = pitch = 0, if nothing better is found.
            first = floor;
            let [.., yaw_short] = floor.outcome.short;
            first.outcome.short = [along, (floor.outcome.thrust - thrust).abs(), yaw_short];
            search.touch_efforts(scratch);
            search.improve(scratch, ROUNDS, &mut first);
        }
    }
    search.search(scratch, halvings, &mut first);
}

/// Keeps the efforts as those of the best end.
pub(crate) fn keep(scratch: &mut [Scratch]) {
    for scratch in scratch.iter_mut() {
        scratch.best = scratch.efforts;
    }
}

/// Takes the efforts of the best end.
pub(crate) fn restore(scratch: &mut [Scratch]) {
    for scratch in scratch.iter_mut() {
        scratch.efforts = scratch.best;
    }
}

impl<P: Quantity, I, S> Search<'_, '_, P, I, S> {
    /// The same with the largest thrust that is allowed known, in its row.
    pub(crate) fn under(&self, ceiling: f32) -> Self {
        Search {
            ceiling: Some(ceiling),
            ..*self
        }
    }

    /// Unless the best end is known to be the best: rounds from where hulls lead, on parts of the curves, then from the best
    /// end. Leaves its efforts in the scratch.
    fn search(&self, scratch: &mut [Scratch], halvings: u32, best: &mut End) {
        restore(scratch);
        let hulled = self.round_on_hulls(scratch);
        if best.touches && hulled.is_some_and(|hulled| !hulled.is_better_by(AS_GOOD, &best.outcome)) {
            restore(scratch);
            return;
        }
        if hulled.is_some() {
            self.touch_efforts(scratch);
            self.improve(scratch, ROUNDS_OF_PARTS, best);
        }
        let on_whole_curves = best.outcome.cost();
        for combination in 0..1 << HALVINGS {
            let rounds = if best.outcome.is_within() {
                ROUNDS_OF_PARTS
            } else {
                ROUNDS
            };
            self.draw(scratch, halvings, combination);
            self.improve(scratch, rounds, best);
        }
        if !best.touches || best.outcome.cost() < on_whole_curves {
            restore(scratch);
            self.touch_efforts(scratch);
            self.improve(scratch, ROUNDS, best);
        }
        self.approach(scratch, best);
        restore(scratch);
    }

    /// The steps on hulls about the curves, close to them where the units are; `None` where a curve has none.
    #[inline(never)]
    fn round_on_hulls(&self, scratch: &mut [Scratch]) -> Option<Outcome> {
        let tables = self.tables;
        let range = [tables.throttle.min, tables.throttle.max];
        self.draw(scratch, 0, 0);
        let mut hulls = [Hull::default(); HULLS];
        let mut singles = scratch.iter_mut().filter(|scratch| scratch.rotors.is_single());
        for (hull, index) in hulls.iter_mut().zip(0..) {
            let Some(scratch) = singles.next() else { break };
            let (rotors, scale) = (scratch.rotors, tables.attainable.scale);
            let throttle = single_rotor(tables, rotors, scratch.efforts[0])?;
            match hull.draw(&tables.pair, range, rotors, scale, throttle) {
                Bend::None => {}
                Bend::OneWay => scratch.chord = scratch.chord.hulled(index),
                Bend::BothWays => return None,
            }
        }
        if singles.next().is_some() {
            return None;
        }
        Some(self.round(scratch, &hulls, None))
    }

    /// Rounds from the best end on ever shorter parts of the curves about it.
    fn approach(&self, scratch: &mut [Scratch], best: &mut End) {
        let [scale, _] = self.tables.attainable.scale;
        let mut reach = REACH;
        for _ in 0..APPROACHES {
            restore(scratch);
            self.touch_efforts(scratch);
            for scratch in scratch.iter_mut().filter(|scratch| scratch.rotors.is_single()) {
                scratch.chord = scratch.chord.about(scratch.efforts[0] / scale, reach);
            }
            let before = best.outcome.cost();
            let rounds = self.improve(scratch, ROUNDS_OF_APPROACH, best);
            if best.outcome.cost() < before - GAIN {
                continue;
            }
            // Where the tangents move nothing, they do not on shorter parts.
            reach *= CLOSER;
            if reach < LEAST_REACH || rounds == 1 && self.is_at_best(scratch) {
                break;
            }
        }
    }

    /// True where every single rotor gives the thrust that it has at the best end.
    fn is_at_best(&self, scratch: &[Scratch]) -> bool {
        let mut singles = scratch.iter().filter(|scratch| scratch.rotors.is_single());
        let [tolerance, _] = self.tables.tolerance.efforts;
        singles.all(|scratch| (scratch.efforts[0] - scratch.best[0]).abs() <= tolerance)
    }

    /// Whole curves, their lines drawn where the units are.
    fn touch_efforts(&self, scratch: &mut [Scratch]) {
        self.draw(scratch, 0, 0);
        for scratch in scratch.iter_mut() {
            self.touch(scratch, scratch.efforts[0]);
        }
    }

    /// Chords of the curves; of curves halved so often only of one part each, `combination` says which: its bits are those
    /// of all parts in turn. Once [`HALVINGS`] are used up, curves are whole.
    fn draw(&self, scratch: &mut [Scratch], halvings: u32, combination: u32) {
        let tables = self.tables;
        let (low, high) = (tables.throttle.min, tables.throttle.max);
        let (mut left, mut combination) = (HALVINGS, combination);
        for scratch in scratch.iter_mut().filter(|scratch| scratch.rotors.is_single()) {
            let halvings = if left < halvings { left } else { halvings };
            left -= halvings;
            let parts = 1 << halvings;
            let part = combination & (parts - 1);
            combination >>= halvings;
            let step = (high - low) / parts as f32;
            let range = [part, part + 1].map(|part| low + part as f32 * step);
            if let Some(chord) = Chord::between(&tables.pair, range, scratch.rotors, tables.attainable.scale)
            {
                scratch.chord = chord;
            }
        }
    }

    /// Draws the line of a unit again for the thrust `f`; returns the throttles there, `None` where there is no line.
    fn touch(&self, scratch: &mut Scratch, f: f32) -> Option<[f32; 2]> {
        let (rotors, scale) = (scratch.rotors, self.tables.attainable.scale);
        let throttle = single_rotor(self.tables, rotors, f)?;
        scratch.chord = scratch
            .chord
            .tangent(&self.tables.pair, rotors, scale, throttle)?;
        rotors.throttles(throttle)
    }

    /// Rounds from the lines drawn; an end that is better takes the place of `best`. Returns how many they were.
    fn improve(&self, scratch: &mut [Scratch], rounds: u32, best: &mut End) -> u32 {
        let end = self.settle(scratch, rounds, Some(best));
        if end.touches && (!best.touches || end.outcome.cost() < best.outcome.cost()) {
            *best = end;
            keep(scratch);
        }
        end.rounds
    }

    /// The steps with the lines as they are drawn.
    pub(crate) fn round(&self, scratch: &mut [Scratch], hulls: &[Hull], rival: Option<Rival>) -> Outcome {
        let sets = Sets {
            both: self.tables.attainable,
            hulls,
        };
        prioritise(
            self.tables,
            &sets,
            self.request,
            self.factors,
            self.ceiling,
            rival,
            scratch,
        )
    }

    /// At most `rounds` of them, fewer where the end will not be better than `best`.
    #[inline(never)]
    fn settle(&self, scratch: &mut [Scratch], rounds: u32, best: Option<&End>) -> End {
        let tables = self.tables;
        let hopeless = best.map(|best| best.outcome.cost() + HOPELESS);
        let mut round = 0;
        loop {
            let outcome = self.round(scratch, &[], None);
            round += 1;
            let least = if round < TRIED {
                outcome.short[0]
            } else {
                outcome.cost()
            };
            let mut off = [0.0; 4];
            for (unit, scratch) in tables.units.iter().zip(scratch.iter_mut()) {
                let [f, q] = scratch.efforts;
                if let Some([u, l]) = self.touch(scratch, f) {
                    let missed = self.factors[1] * (tables.pair.torque.value(u, l) - q);
                    for (off, effect) in off.iter_mut().zip(unit.effectiveness[1]) {
                        *off += (effect * missed).abs();
                    }
                }
            }
            // What is left is less than the inverse map may miss.
            let mut off = off.iter().zip(tables.tolerance.wrench);
            let touches = off.all(|(off, tolerance)| *off <= TOUCHING * tolerance);
            if touches || round >= rounds || hopeless.is_some_and(|hopeless| least > hopeless) {
                return End {
                    touches,
                    rounds: round,
                    outcome,
                };
            }
        }
    }
}
