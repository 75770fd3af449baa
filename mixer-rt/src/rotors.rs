//! Which rotors of a unit work, and the curve that a single rotor leaves its unit.

use crate::{Health, Pair, Quantity, ThrottleRange, sqrt};

/// Which rotors of a unit work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rotors {
    #[default]
    Both,
    Upper,
    Lower,
    None,
}

/// Newton steps that invert a single rotor's thrust. The start is exact for a thrust that grows with the square of the
/// throttle, which bench maps follow to a few percent.
const STEPS: usize = 3;

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

    /// The efforts `[f, Q]` (N, N m) of a unit whose single rotor is at the least and at the largest throttle.
    pub(crate) fn ends<P: Quantity>(self, pair: &Pair<P>, range: &ThrottleRange) -> [[f32; 2]; 2] {
        [range.min, range.max].map(|throttle| pair.efforts(self.throttles(throttle)))
    }

    /// The throttles within the range at which a unit with a single rotor gives the thrust `f` (N): Newton's method on the
    /// pair's polynomial, each step limited to the range.
    #[inline(never)]
    pub(crate) fn invert<P: Quantity>(self, pair: &Pair<P>, range: &ThrottleRange, f: f32) -> [f32; 2] {
        let [[least, _], [most, _]] = self.ends(pair, range);
        let (low, high) = (range.min * range.min, range.max * range.max);
        let share = (f - least) / (most - least);
        let square = low + share * (high - low);
        let mut throttle = range.clamp(if square > low { sqrt(square) } else { range.min });
        for _ in 0..STEPS {
            let [u, l] = self.throttles(throttle);
            let [value, by_upper, by_lower] = pair.thrust.value_and_gradient(u, l);
            let slope = if self == Rotors::Lower { by_lower } else { by_upper };
            // Where a thrust does not grow with its throttle the step is limited to the range.
            throttle = range.clamp(throttle + (f - value) / slope);
        }
        self.throttles(throttle)
    }
}
