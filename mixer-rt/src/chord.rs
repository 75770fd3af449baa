//! The attainable sets of units that have lost a rotor.

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

/// What is left of a unit's attainable set when a rotor is lost: the curve of the other one, with the lost one's
/// throttle at zero. Its chord stands for it.
#[derive(Clone, Copy, Debug)]
struct Chord {
    edge: [Edge; 1],
    centre: [f32; 2],
}

impl Chord {
    /// The chord from `low` to `high`, both `[f, Q]`.
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
            centre: [start[0] + 0.5 * vector[0], start[1] + 0.5 * vector[1]],
        }
    }
}

/// The attainable sets of units with both rotors, the upper one alone and the lower one alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sets<'a> {
    both: AttainableSet<'a>,
    upper: Chord,
    lower: Chord,
}

impl<'a> Sets<'a> {
    pub(crate) fn new<P: Quantity>(
        both: AttainableSet<'a>,
        pair: &Pair<P>,
        &ThrottleRange { min, max }: &ThrottleRange,
    ) -> Self {
        let chord = |low, high| Chord::new(pair.efforts(low), pair.efforts(high), both.scale);
        Sets {
            both,
            upper: chord([min, 0.0], [max, 0.0]),
            lower: chord([0.0, min], [0.0, max]),
        }
    }

    /// The set of a unit; `None` where neither rotor works.
    #[inline]
    pub(crate) fn of(&self, rotors: Rotors) -> Option<AttainableSet<'_>> {
        let chord = |chord: &'_ Chord| AttainableSet {
            scale: self.both.scale,
            centre: chord.centre,
            edges: &[],
        };
        match rotors {
            Rotors::Both => Some(self.both),
            Rotors::Upper => Some(AttainableSet {
                edges: &self.upper.edge,
                ..chord(&self.upper)
            }),
            Rotors::Lower => Some(AttainableSet {
                edges: &self.lower.edge,
                ..chord(&self.lower)
            }),
            Rotors::None => None,
        }
    }
}
