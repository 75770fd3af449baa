//! Which rotors of a unit work, and what its unit then gives.

use crate::arithmetic::Scalar;
use crate::pair::{Pair, Quantity, SingleRotor, ThrottleRange};
use crate::{Health, divisor};

/// Which rotors of a unit work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rotors {
    Both,
    Upper,
    Lower,
    None,
}

/// Newton steps that invert a single rotor's thrust. The start is exact for a thrust that grows
/// with the square of the throttle, which bench maps follow to a few percent.
const STEPS: usize = 3;

/// The least rise of a thrust that is divided by, N: a thrust that does not grow with its throttle
/// takes the step to the end of the range.
const LEAST_RISE: f32 = 1e-6;

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
    fn throttles(self, throttle: f32) -> [f32; 2] {
        match self {
            Rotors::Lower => [0.0, throttle],
            _ => [throttle, 0.0],
        }
    }

    /// What the rotor gives that works, of a unit with a single one.
    #[inline]
    fn curve(self, [upper, lower]: &[SingleRotor; 2]) -> &SingleRotor {
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

    /// The efforts `[f, Q]` (N, N m) of a unit whose single rotor is at the least and at the
    /// largest throttle.
    pub(crate) fn ends(self, singles: &[SingleRotor; 2], range: &ThrottleRange) -> [[f32; 2]; 2] {
        [range.min, range.max].map(|throttle| self.curve(singles).efforts(throttle))
    }

    /// The throttles within the range at which a unit with a single rotor gives the thrust `f` (N):
    /// Newton's method on the rotor's polynomial, each step limited to the range.
    #[inline(never)]
    pub(crate) fn invert(self, singles: &[SingleRotor; 2], range: &ThrottleRange, f: f32) -> [f32; 2] {
        let [[least, _], [most, _]] = self.ends(singles, range);
        let (low, high) = (range.min * range.min, range.max * range.max);
        let span = most - least;
        let share = if span > LEAST_RISE {
            (f - least) / divisor(span)
        } else {
            0.0
        };
        let square = low + share * (high - low);
        let mut throttle = range.clamp(square.root());
        for _ in 0..STEPS {
            let [value, slope] = self.curve(singles).thrust_and_slope(throttle);
            let slope = if slope > LEAST_RISE { slope } else { LEAST_RISE };
            throttle = range.clamp(throttle + (f - value) / slope);
        }
        self.throttles(throttle)
    }
}
