//! The attainable sets of units that have lost a rotor.
//!
//! What is left is the curve of the other rotor, with the lost one's throttle at zero. A straight line stands for it:
//! at first the chord from the idle to the full throttle, then the tangent where the unit has come to, over the same
//! range of thrust. Where that repeats itself, line and curve meet in the unit's efforts. An optimum on a curve may lie
//! between the ends to which the tangents lead in turn: there the secant between them takes their place.

use crate::attainable::AttainableSet;
use crate::{Edge, Pair, Quantity, ThrottleRange, sqrt};

/// Which rotors of a unit work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rotors {
    #[default]
    Both,
    Upper,
    Lower,
    None,
}

impl Rotors {
    /// The throttles of both rotors where the one that works has `throttle`; `None` with both or no rotor.
    #[inline]
    pub(crate) fn throttles(self, throttle: f32) -> Option<[f32; 2]> {
        match self {
            Rotors::Upper => Some([throttle, 0.0]),
            Rotors::Lower => Some([0.0, throttle]),
            Rotors::Both | Rotors::None => None,
        }
    }
}

/// A step back by more than this share of the last one is a swing.
const SWING: f32 = 0.25;

/// The line that stands for the curve of a single rotor, scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chord {
    edge: [Edge; 1],
    /// The efforts in which it meets the curve, N and N m (NaN for the chord), and how that thrust changed last.
    meeting: [f32; 2],
    step: f32,
    /// dQ/df, where it is no longer that of the tangent; else NaN.
    slope: f32,
}

impl Default for Chord {
    fn default() -> Self {
        Chord {
            edge: [Edge {
                start: [0.0; 2],
                along: [1.0, 0.0],
                length: 0.0,
            }],
            meeting: [f32::NAN; 2],
            step: 0.0,
            slope: f32::NAN,
        }
    }
}

impl Chord {
    /// From `low` to `high`, both `[f, Q]` in N and N m.
    fn new(low: [f32; 2], high: [f32; 2], scale: [f32; 2]) -> Self {
        let start = [low[0] / scale[0], low[1] / scale[1]];
        let vector = [high[0] / scale[0] - start[0], high[1] / scale[1] - start[1]];
        let length = sqrt(vector[0] * vector[0] + vector[1] * vector[1]);
        Chord {
            edge: [Edge {
                start,
                along: vector.map(|part| part / length),
                length,
            }],
            meeting: [f32::NAN; 2],
            step: 0.0,
            slope: f32::NAN,
        }
    }

    /// The chord of the whole curve; `None` with both or no rotor.
    pub(crate) fn of_curve<P: Quantity>(
        pair: &Pair<P>,
        throttle: &ThrottleRange,
        rotors: Rotors,
        scale: [f32; 2],
    ) -> Option<Self> {
        let low = pair.efforts(rotors.throttles(throttle.min)?);
        let high = pair.efforts(rotors.throttles(throttle.max)?);
        Some(Chord::new(low, high, scale))
    }

    /// The tangent at a throttle, over the curve's range of thrust; `None` with both or no rotor. Where the thrust
    /// swings to and fro, the secant of the swing gives the direction from then on.
    pub(crate) fn tangent<P: Quantity>(
        &self,
        pair: &Pair<P>,
        range: &ThrottleRange,
        rotors: Rotors,
        scale: [f32; 2],
        throttle: f32,
    ) -> Option<Self> {
        let ([f, q], jacobian) = pair.efforts_and_jacobian(rotors.throttles(throttle)?);
        let [f_by, q_by] = jacobian.map(|[by_upper, by_lower]| match rotors {
            Rotors::Upper => by_upper,
            _ => by_lower,
        });
        let mut slope = self.slope;
        let mut step = 0.0;
        let before = self.meeting;
        if !before[0].is_nan() {
            step = f - before[0];
            if slope.is_nan() && step * self.step < 0.0 && step.abs() > SWING * self.step.abs() {
                slope = (q - before[1]) / step;
            }
        }
        let low = pair.efforts(rotors.throttles(range.min)?)[0];
        let high = pair.efforts(rotors.throttles(range.max)?)[0];
        let direction = if slope.is_nan() { q_by / f_by } else { slope };
        let at = |thrust: f32| [thrust, q + direction * (thrust - f)];
        Some(Chord {
            meeting: [f, q],
            step,
            slope,
            ..Chord::new(at(low), at(high), scale)
        })
    }
}

/// The attainable sets of units, by the rotors that work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sets<'a> {
    pub(crate) both: AttainableSet<'a>,
}

impl Sets<'_> {
    /// The set of a unit with its `chord`; `None` where neither rotor works.
    #[inline]
    pub(crate) fn of<'s>(&'s self, rotors: Rotors, chord: &'s Chord) -> Option<AttainableSet<'s>> {
        match rotors {
            Rotors::Both => Some(self.both),
            Rotors::Upper | Rotors::Lower => Some(AttainableSet {
                scale: self.both.scale,
                centre: chord.edge[0].at(0.5 * chord.edge[0].length),
                edges: &chord.edge,
            }),
            Rotors::None => None,
        }
    }
}
