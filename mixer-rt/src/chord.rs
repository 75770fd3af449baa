//! The attainable sets of units that have lost a rotor.
//!
//! What is left is the curve of the other rotor, with the lost one's throttle at zero. A straight line stands for it or
//! for a part of it: at first the chord from end to end, then the tangent where the unit has come to, over the same range
//! of thrust. Where that repeats itself, line and curve meet in the unit's efforts. An optimum on a curve may lie between
//! the ends to which the tangents lead in turn: there the secant between them takes their place.

use crate::attainable::AttainableSet;
use crate::hull::Hull;
use crate::{Edge, Pair, Quantity, clamp, sqrt};

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

    /// Of a Jacobian over both throttles, what the one that works changes.
    #[inline]
    pub(crate) fn derivative(self, jacobian: [[f32; 2]; 2]) -> [f32; 2] {
        jacobian.map(|[by_upper, by_lower]| match self {
            Rotors::Upper => by_upper,
            _ => by_lower,
        })
    }

    /// True where one of them works.
    #[inline]
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Rotors::Upper | Rotors::Lower)
    }
}

/// A step back by more than this share of the last one is a swing.
const SWING: f32 = 0.25;

/// How a line stands to its curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Kind {
    /// Through its ends.
    #[default]
    Chord,
    /// Along it where they meet.
    Tangent,
    /// In the direction of a swing.
    Secant,
    /// Through its ends, with the hull of this index in its place.
    Hull(u8),
}

/// The line that stands for the curve of a single rotor, scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Chord {
    edge: [Edge; 1],
    kind: Kind,
    /// The efforts in which it meets the curve, N and N m, and how that thrust changed last; zero for the chord.
    meeting: [f32; 2],
    step: f32,
}

impl Default for Chord {
    fn default() -> Self {
        Chord {
            edge: [Edge {
                start: [0.0; 2],
                along: [1.0, 0.0],
                length: 0.0,
            }],
            kind: Kind::Chord,
            meeting: [0.0; 2],
            step: 0.0,
        }
    }
}

/// The edge between two scaled points.
pub(crate) fn edge(start: [f32; 2], end: [f32; 2]) -> Edge {
    let vector = [end[0] - start[0], end[1] - start[1]];
    let length = sqrt(vector[0] * vector[0] + vector[1] * vector[1]);
    Edge {
        start,
        along: vector.map(|part| part / length),
        length,
    }
}

/// The edge from `low` to `high`, both `[f, Q]` in N and N m.
fn scaled_edge(low: [f32; 2], high: [f32; 2], scale: [f32; 2]) -> [Edge; 1] {
    let scaled = |[f, q]: [f32; 2]| [f / scale[0], q / scale[1]];
    [edge(scaled(low), scaled(high))]
}

impl Chord {
    /// The chord of the curve between two throttles; `None` with both or no rotor.
    pub(crate) fn between<P: Quantity>(
        pair: &Pair<P>,
        range: [f32; 2],
        rotors: Rotors,
        scale: [f32; 2],
    ) -> Option<Self> {
        let low = pair.efforts(rotors.throttles(range[0])?);
        let high = pair.efforts(rotors.throttles(range[1])?);
        Some(Chord {
            edge: scaled_edge(low, high, scale),
            ..Chord::default()
        })
    }

    /// The same with the hull of this index in its place.
    pub(crate) fn hulled(&self, index: u8) -> Self {
        Chord {
            kind: Kind::Hull(index),
            ..*self
        }
    }

    /// The part of it that lies within `reach` times its length of where its scaled thrust is `f`.
    pub(crate) fn about(&self, f: f32, reach: f32) -> Self {
        let [edge] = self.edge;
        let at = (f - edge.start[0]) / edge.along[0];
        let [low, high] =
            [at - reach * edge.length, at + reach * edge.length].map(|s| clamp(s, 0.0, edge.length));
        Chord {
            edge: [Edge {
                start: edge.at(low),
                length: high - low,
                ..edge
            }],
            ..*self
        }
    }

    /// The tangent at a throttle, over the same range of thrust; `None` with both or no rotor. Where the thrust swings
    /// to and fro, the secant of the swing gives the direction from then on.
    pub(crate) fn tangent<P: Quantity>(
        &self,
        pair: &Pair<P>,
        rotors: Rotors,
        scale: [f32; 2],
        throttle: f32,
    ) -> Option<Self> {
        let ([f, q], jacobian) = pair.efforts_and_jacobian(rotors.throttles(throttle)?);
        let [f_by, q_by] = rotors.derivative(jacobian);
        let way = [f - self.meeting[0], q - self.meeting[1]];
        let step = if matches!(self.kind, Kind::Chord | Kind::Hull(_)) {
            0.0
        } else {
            way[0]
        };
        let swings = step * self.step < 0.0 && step.abs() > SWING * self.step.abs();
        let (kind, slope) = match self.kind {
            Kind::Secant => {
                let [df, dq] = self.edge[0].along;
                (Kind::Secant, dq * scale[1] / (df * scale[0]))
            }
            Kind::Tangent if swings => (Kind::Secant, way[1] / way[0]),
            _ => (Kind::Tangent, q_by / f_by),
        };
        let [Edge { start, along, length }] = self.edge;
        let low = scale[0] * start[0];
        let high = low + scale[0] * (along[0] * length);
        let at = |thrust: f32| [thrust, q + slope * (thrust - f)];
        Some(Chord {
            edge: scaled_edge(at(low), at(high), scale),
            kind,
            meeting: [f, q],
            step,
        })
    }
}

/// The attainable sets of units, by the rotors that work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sets<'a> {
    pub(crate) both: AttainableSet<'a>,
    /// In the place of curves.
    pub(crate) hulls: &'a [Hull],
}

impl Sets<'_> {
    /// The set of a unit with its `chord`; `None` where neither rotor works.
    #[inline]
    pub(crate) fn of<'s>(&'s self, rotors: Rotors, chord: &'s Chord) -> Option<AttainableSet<'s>> {
        let scale = self.both.scale;
        match rotors {
            Rotors::Both => Some(self.both),
            Rotors::Upper | Rotors::Lower => match chord.kind {
                Kind::Hull(index) => Some(self.hulls.get(usize::from(index))?.set(scale)),
                _ => Some(AttainableSet {
                    scale,
                    centre: chord.edge[0].at(0.5 * chord.edge[0].length),
                    edges: &chord.edge,
                }),
            },
            Rotors::None => None,
        }
    }
}
