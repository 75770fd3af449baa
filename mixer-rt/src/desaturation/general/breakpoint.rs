//! The breakpoints of a dual step: where variables leave their corners or edges, and where the
//! first row is at its price.
//!
//! A long step passes the first one again and again. Two are kept, so that only every other passage
//! looks through all variables.

use super::variable::positive;

/// The index of row 0 in the place of a variable; those of the other rows follow.
pub(super) const ROW: u8 = 252;

/// The breakpoint of a variable or a row, as the bits of an f32. As integers the bits of positive
/// floats have the floats' order, and those of negative ones come first. Comparing them spares
/// transfers from the floating-point unit.
#[derive(Clone, Copy)]
pub(super) struct Breakpoint {
    pub(super) bits: i32,
    pub(super) variable: u8,
}

impl Breakpoint {
    /// Not known yet: a search is needed.
    pub(super) const UNKNOWN: Breakpoint = Breakpoint {
        bits: i32::MIN,
        variable: ROW,
    };

    /// The dual step there, zero where rounding has put it below.
    #[inline(always)]
    pub(super) fn step(self) -> f32 {
        positive(f32::from_bits(self.bits as u32))
    }
}

/// The two breakpoints that come first.
#[derive(Clone, Copy)]
pub(super) struct FirstTwo(pub(super) [Breakpoint; 2]);

impl FirstTwo {
    /// Before any variable is considered: that of a row, which ends the dual step.
    #[inline(always)]
    pub(super) fn new(limit: Breakpoint) -> Self {
        FirstTwo([limit; 2])
    }

    /// Takes a variable's breakpoint in if it is one of the two.
    #[inline(always)]
    pub(super) fn consider(&mut self, variable: u8, breakpoint: f32) {
        let bits = breakpoint.to_bits() as i32;
        let new = Breakpoint { bits, variable };
        let [first, second] = self.0;
        if bits < first.bits {
            self.0 = [new, first];
        } else if bits < second.bits {
            self.0[1] = new;
        }
    }
}
