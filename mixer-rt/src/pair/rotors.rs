//! Which rotors of a unit work, and what its unit then gives.

use crate::Health;
use crate::pair::{Pair, Quantity, SingleRotor};

/// Which rotors of a unit work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rotors {
    Both,
    Upper,
    Lower,
    None,
}

impl Rotors {
    /// The rotors of a unit with these channels.
    #[inline]
    pub(crate) fn of([upper, lower]: [u8; 2], health: Health) -> Rotors {
        match (health.has_failed(upper), health.has_failed(lower)) {
            (false, false) => Rotors::Both,
            (false, true) => Rotors::Upper,
            (true, false) => Rotors::Lower,
            (true, true) => Rotors::None,
        }
    }

    /// True where one of them works.
    #[inline]
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Rotors::Upper | Rotors::Lower)
    }

    /// The throttles of both rotors where the one that works has `throttle`.
    #[inline]
    pub(crate) fn throttles(self, throttle: f32) -> [f32; 2] {
        match self {
            Rotors::Lower => [0.0, throttle],
            _ => [throttle, 0.0],
        }
    }

    /// What the rotor gives that works, of a unit with a single one.
    #[inline]
    pub(crate) fn curve(self, [upper, lower]: &[SingleRotor; 2]) -> &SingleRotor {
        if self == Rotors::Lower { lower } else { upper }
    }

    /// The efforts `[f, Q]` (N, N m) of a unit with these rotors at `[u, l]`.
    #[inline(always)]
    pub(crate) fn efforts<P: Quantity>(
        self,
        pair: &Pair<P>,
        singles: &[SingleRotor; 2],
        [u, l]: [f32; 2],
    ) -> [f32; 2] {
        if self.is_single() {
            self.curve(singles).efforts(u + l)
        } else {
            pair.efforts([u, l])
        }
    }
}
