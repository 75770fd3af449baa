//! Other optima of sets that bend inwards.
//!
//! Where a unit's attainable set bends inwards, in a hollow, an end of the steps need not be the best. It is if no unit is
//! held back in a hollow: the multipliers that end a step are the normal of a plane that touches the attainable wrenches,
//! and if they draw every unit to where its set reaches furthest in their direction, then no attainable wrench is beyond
//! that plane. So for every unit that is held back the steps are taken anew with that unit at either end of its hollow, one of
//! which is where its set does reach furthest: once it is kept there, then it only starts there, since it may belong on from there.
//! The other units start where the best end so far has them. The best of all ends stands.
//!
//! Where the request changes and another optimum becomes the best the efforts jump, as any choice of the best must.

use crate::Quantity;
use crate::desaturation::{Outcome, Rival};
use crate::scratch::Scratch;
use crate::search::{Search, keep, restore};

impl<P: Quantity, I, S> Search<'_, '_, P, I, S> {
    /// Leaves the efforts of the best end in the scratch: the end of `best`, whose efforts and hollows are there, or one that
    /// another unit's start leads to.
    pub(crate) fn leave_hollows(&self, scratch: &mut [Scratch], mut best: Outcome) {
        keep(scratch);
        let others = self.under(best.ceiling);
        for unit in 0..scratch.len() {
            let hollow = scratch.get(unit).map_or([None; 2], |scratch| scratch.hollow);
            for above in hollow.into_iter().flatten() {
                for stays in [true, false] {
                    let rival = Rival {
                        unit,
                        corner: above.get() - 1,
                        stays,
                        short: best.short,
                    };
                    let outcome = others.round(scratch, &[], Some(rival));
                    if outcome.is_better_than(&best) {
                        best = outcome;
                        keep(scratch);
                    }
                }
            }
        }
        restore(scratch);
    }
}
