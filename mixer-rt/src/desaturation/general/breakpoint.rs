//! The breakpoints of a dual step: where units and segments leave their corners, edges or ends, and
//! where the first row is at its price.
//!
//! A long step passes the first one again and again. Two are kept, so that only every other passage
//! looks through all of them.

use super::variable::positive;

/// A breakpoint, as the bits of an f32, and what turns there. As integers the bits of positive
/// floats have the floats' order, and those of negative ones come first. Comparing them spares
/// transfers from the floating-point unit.
#[derive(Clone, Copy)]
pub(super) struct Breakpoint {
    pub(super) bits: i32,
    pub(super) of: u8,
}

impl Breakpoint {
    /// Not known yet: a search is needed.
    pub(super) const UNKNOWN: i32 = i32::MIN;

    #[inline(always)]
    pub(super) fn new(step: f32, of: u8) -> Self {
        let bits = step.to_bits() as i32;
        Breakpoint { bits, of }
    }

    /// The dual step there, zero where rounding has put it below.
    #[inline(always)]
    pub(super) fn step(self) -> f32 {
        positive(f32::from_bits(self.bits as u32))
    }

    /// Takes in what turns earlier.
    #[inline(always)]
    pub(super) fn consider(&mut self, of: u8, step: f32) {
        let new = Breakpoint::new(step, of);
        if new.bits < self.bits {
            *self = new;
        }
    }
}

/// The two breakpoints that come first.
#[derive(Clone, Copy)]
pub(super) struct FirstTwo(pub(super) [Breakpoint; 2]);

impl FirstTwo {
    /// Before any is considered: that of a row, which ends the dual step.
    #[inline(always)]
    pub(super) fn new(limit: Breakpoint) -> Self {
        FirstTwo([limit; 2])
    }

    /// Takes a breakpoint in if it is one of the two.
    #[inline(always)]
    pub(super) fn consider(&mut self, of: u8, step: f32) {
        let new = Breakpoint::new(step, of);
        let [first, second] = self.0;
        if new.bits < first.bits {
            self.0 = [new, first];
        } else if new.bits < second.bits {
            self.0[1] = new;
        }
    }
}
