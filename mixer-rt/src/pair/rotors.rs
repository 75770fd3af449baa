//! Which rotors of a unit turn.

use crate::Health;

/// Which rotors of a unit turn: the upper one, the lower one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rotors([bool; 2]);

impl Rotors {
    /// Both.
    pub(crate) const BOTH: Rotors = Rotors([true; 2]);

    /// The rotors of a unit with these channels.
    #[inline]
    pub(crate) fn of(channels: [u8; 2], health: Health) -> Rotors {
        Rotors(channels.map(|channel| !health.has_failed(channel)))
    }

    /// All of a unit: both, or the upper one of a single rotor.
    #[inline(always)]
    pub(crate) fn all(is_single: bool) -> Self {
        Rotors([true, !is_single])
    }

    /// The upper one alone, if that.
    #[inline(always)]
    pub(crate) fn without_lower(self) -> Self {
        Rotors([self.0[0], false])
    }

    /// Whether the upper one turns, and the lower one.
    #[inline(always)]
    pub(crate) fn turning(self) -> [bool; 2] {
        self.0
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
}
