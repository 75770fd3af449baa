//! Which rotors of a unit turn, and what the unit then gives.

use crate::Health;
use crate::pair::{Expansion, Pair, Quantity, SingleRotor};

/// Which rotors of a unit turn: the upper one, the lower one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rotors([bool; 2]);

impl Rotors {
    /// Both.
    pub(crate) const BOTH: Rotors = Rotors([true; 2]);

    /// The rotors of a unit with these channels.
    #[inline]
    pub(crate) fn of(channels: [u8; 2], health: Health) -> Rotors {
        Rotors(channels.map(|channel| !health.has_failed(channel)))
    }

    /// The upper one alone, if that.
    #[inline(always)]
    pub(crate) fn without_lower(self) -> Self {
        Rotors([self.0[0], false])
    }

    /// Whether one of them turns: 0 the upper, 1 the lower.
    #[inline(always)]
    pub(crate) fn turns(self, side: usize) -> bool {
        self.0[side & 1]
    }

    /// Whether both turn.
    #[inline(always)]
    pub(crate) fn are_both(self) -> bool {
        self == Rotors::BOTH
    }

    /// The one that turns, where the other does not.
    #[inline(always)]
    pub(crate) fn single(self) -> Option<usize> {
        let [upper, lower] = self.0;
        (upper != lower).then_some(usize::from(lower))
    }

    /// The efforts `[f, Q]` (N, N m) of a unit with these rotors at `[u, l]`.
    #[inline(always)]
    pub(crate) fn efforts<P: Quantity>(
        self,
        pair: &Pair<P>,
        [upper, lower]: &[SingleRotor; 2],
        [u, l]: [f32; 2],
    ) -> [f32; 2] {
        match self.0 {
            [true, true] => pair.efforts([u, l]),
            [true, false] => upper.efforts(u),
            [false, true] => lower.efforts(l),
            [false, false] => [0.0; 2],
        }
    }

    /// The same with the derivatives by the throttles of those that turn.
    #[inline(always)]
    pub(crate) fn expansion<P: Quantity>(
        self,
        pair: &Pair<P>,
        [upper, lower]: &[SingleRotor; 2],
        [u, l]: [f32; 2],
    ) -> Expansion {
        let (curve, throttle, side) = match self.0 {
            [true, true] => return pair.expansion([u, l]),
            [true, false] => (upper, u, 0),
            [false, true] => (lower, l, 1),
            [false, false] => return Expansion::NOTHING,
        };
        let [value, slope, curvature] = curve.expansion(throttle);
        let mut expansion = Expansion {
            value,
            ..Expansion::NOTHING
        };
        (expansion.slopes[side], expansion.curvatures[side]) = (slope, curvature);
        expansion
    }
}
