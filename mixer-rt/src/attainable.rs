//! The attainable set of one unit: all efforts (f, Q) that its rotors can give together.
//!
//! It is the image of the throttle box under the forward map, a curved quadrangle ("the zone of achievable
//! thrust-torque pairs", section IV-B2), almost convex: for the paper's pair its convex hull is 0.35 % larger. The
//! compiler tabulates a convex polygon inside it. Of a unit that has lost a rotor a curve is left, and of that
//! its chord.
//!
//! Desaturation projects points of the plane onto this set. The projection of `p` is piecewise affine: the plane
//! falls into the set itself, a strip beyond every edge, on which `p` goes to the edge, and a cone beyond every
//! corner, on which it goes to the corner. [`Face`] names the region that `p` lies in.

use crate::sqrt;

/// One edge of a [`AttainableSet`], in the set's own units: see [`AttainableSet::scale`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The corner where it starts.
    pub start: [f32; 2],
    /// Unit vector towards its end.
    pub along: [f32; 2],
    /// Its length.
    pub length: f32,
}

/// A convex set inside the attainable set at the reference voltage; at another voltage it is scaled by
/// `[k_f, k_Q]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttainableSet<'a> {
    /// Newtons and newton metres per unit of the coordinates below; both positive. They make the set about as
    /// high as it is wide.
    pub scale: [f32; 2],
    /// A point well inside (for a chord its middle), scaled.
    pub centre: [f32; 2],
    /// The edges of the polygon, anticlockwise in the plane with f to the right and Q upwards, each starting
    /// where its predecessor ends. A single edge is a chord, taken from both sides.
    pub edges: &'a [Edge],
}

/// Least distance from the set of a point amid its face's region, scaled.
const AMID: f32 = 0.05;

/// The part of a set that a point is projected onto.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Face {
    /// The point itself.
    #[default]
    Interior,
    /// The edge of this index.
    Edge(u8),
    /// The start of the edge of this index; for a chord 1 is its end.
    Corner(u8),
}

/// A change of face on the way of a point: after which step, and to which face.
pub(crate) type Crossing = (f32, Face);

/// A [`Face`] with its edges looked up.
#[derive(Clone, Copy)]
enum Located<'a> {
    Interior,
    Edge(&'a Edge),
    /// The corner and the edges that end and start there, where there are such.
    Corner([f32; 2], Option<&'a Edge>, Option<&'a Edge>),
}

impl AttainableSet<'_> {
    /// The face that the centre lies on.
    #[inline]
    pub(crate) fn central_face(&self) -> Face {
        if self.is_chord() {
            Face::Edge(0)
        } else {
            Face::Interior
        }
    }

    #[inline]
    fn is_chord(&self) -> bool {
        self.edges.len() == 1
    }

    /// The index of the edge before `index`.
    #[inline]
    fn before(&self, index: u8) -> u8 {
        match index.checked_sub(1) {
            Some(before) => before,
            None => self.edges.len().saturating_sub(1) as u8,
        }
    }

    /// The corner at which the edge of `index` ends.
    #[inline]
    fn after(&self, index: u8) -> u8 {
        let next = index.wrapping_add(1);
        if usize::from(next) < self.edges.len() || self.is_chord() {
            next
        } else {
            0
        }
    }

    #[inline]
    fn locate(&self, face: Face) -> Located<'_> {
        let edge = |index: u8| self.edges.get(usize::from(index));
        match face {
            Face::Interior => Located::Interior,
            Face::Edge(index) => edge(index).map_or(Located::Interior, Located::Edge),
            Face::Corner(index) => match (edge(index), edge(self.before(index))) {
                (Some(starting), _) if self.is_chord() => {
                    Located::Corner(starting.start, None, Some(starting))
                }
                (Some(starting), ending) => Located::Corner(starting.start, ending, Some(starting)),
                (None, Some(ending)) => Located::Corner(ending.at(ending.length), Some(ending), None),
                (None, None) => Located::Interior,
            },
        }
    }

    /// The projection of `point`, which lies in the region of `face`.
    #[inline]
    pub(crate) fn project(&self, face: Face, point: [f32; 2]) -> [f32; 2] {
        match self.locate(face) {
            Located::Interior => point,
            Located::Edge(edge) => edge.at(crate::clamp(edge.along(edge.relative(point)), 0.0, edge.length)),
            Located::Corner(corner, ..) => corner,
        }
    }

    /// A point that has the same projection as `point` and is well within the region of `face`.
    pub(crate) fn amid(&self, face: Face, point: [f32; 2]) -> [f32; 2] {
        let away = |from: [f32; 2], direction: [f32; 2]| {
            let way = [point[0] - from[0], point[1] - from[1]];
            let distance = sqrt(way[0] * way[0] + way[1] * way[1]);
            let distance = if distance > AMID { distance } else { AMID };
            let length = sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
            let scale = distance / length;
            [from[0] + scale * direction[0], from[1] + scale * direction[1]]
        };
        match self.locate(face) {
            Located::Interior => point,
            Located::Edge(edge) => away(self.project(face, point), edge.outwards()),
            Located::Corner(corner, Some(ending), Some(starting)) => {
                let (before, after) = (ending.outwards(), starting.outwards());
                away(corner, [before[0] + after[0], before[1] + after[1]])
            }
            Located::Corner(corner, Some(ending), None) => away(corner, ending.along),
            Located::Corner(corner, None, Some(starting)) => away(corner, starting.along.map(|part| -part)),
            Located::Corner(_, None, None) => point,
        }
    }

    /// How the projection moves when the point moves by `step` within the region of `face`: P `step`.
    #[inline]
    pub(crate) fn project_step(&self, face: Face, step: [f32; 2]) -> [f32; 2] {
        match self.locate(face) {
            Located::Interior => step,
            Located::Edge(edge) => {
                let s = edge.along(step);
                [s * edge.along[0], s * edge.along[1]]
            }
            Located::Corner(..) => [0.0, 0.0],
        }
    }

    /// The first change of face of a point that moves from `point`, in the region of `face`, by `share` times
    /// `step`, if it comes before a share of `limit`. Velocities below `noise` count as none.
    #[inline]
    pub(crate) fn crossing(
        &self,
        face: Face,
        point: [f32; 2],
        step: [f32; 2],
        limit: f32,
        noise: f32,
    ) -> Option<Crossing> {
        let mut first = (limit, None);
        // Falling through zero at `height`, with `speed`.
        let mut falls = |height: f32, speed: f32, face: Face| {
            if speed < -noise {
                let share = if height > 0.0 { height / -speed } else { 0.0 };
                if share < first.0 {
                    first = (share, Some(face));
                }
            }
        };
        match (self.locate(face), face) {
            (Located::Interior, _) => {
                for (index, edge) in self.edges.iter().enumerate() {
                    let depth = -edge.beyond(edge.relative(point));
                    falls(depth, -edge.beyond(step), Face::Edge(index as u8));
                }
            }
            (Located::Edge(edge), Face::Edge(index)) => {
                let from_start = edge.relative(point);
                let (s, speed) = (edge.along(from_start), edge.along(step));
                falls(s, speed, Face::Corner(index));
                falls(edge.length - s, -speed, Face::Corner(self.after(index)));
                if !self.is_chord() {
                    falls(edge.beyond(from_start), edge.beyond(step), Face::Interior);
                }
            }
            (Located::Corner(corner, ending, starting), Face::Corner(index)) => {
                let from_corner = [point[0] - corner[0], point[1] - corner[1]];
                if let Some(edge) = ending {
                    falls(
                        edge.along(from_corner),
                        edge.along(step),
                        Face::Edge(self.before(index)),
                    );
                }
                if let Some(edge) = starting {
                    falls(-edge.along(from_corner), -edge.along(step), Face::Edge(index));
                }
            }
            _ => {}
        }
        let (share, face) = first;
        face.map(|face| (share, face))
    }
}

impl Edge {
    #[inline]
    fn relative(&self, point: [f32; 2]) -> [f32; 2] {
        [point[0] - self.start[0], point[1] - self.start[1]]
    }

    /// The part of `vector` along the edge.
    #[inline]
    fn along(&self, vector: [f32; 2]) -> f32 {
        vector[0] * self.along[0] + vector[1] * self.along[1]
    }

    /// The part of `vector` along the outward normal: the interior lies to the edge's left.
    #[inline]
    fn beyond(&self, vector: [f32; 2]) -> f32 {
        vector[0] * self.along[1] - vector[1] * self.along[0]
    }

    /// The outward normal.
    #[inline]
    fn outwards(&self) -> [f32; 2] {
        [self.along[1], -self.along[0]]
    }

    /// The point at distance `s` from the start.
    #[inline]
    fn at(&self, s: f32) -> [f32; 2] {
        [
            self.start[0] + s * self.along[0],
            self.start[1] + s * self.along[1],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn edge(start: [f32; 2], along: [f32; 2], length: f32) -> Edge {
        Edge { start, along, length }
    }

    const SQUARE: AttainableSet<'static> = AttainableSet {
        scale: [1.0, 1.0],
        centre: [1.0, 1.0],
        edges: &[
            edge([0.0, 0.0], [1.0, 0.0], 2.0),
            edge([2.0, 0.0], [0.0, 1.0], 2.0),
            edge([2.0, 2.0], [-1.0, 0.0], 2.0),
            edge([0.0, 2.0], [0.0, -1.0], 2.0),
        ],
    };
    const CHORD: AttainableSet<'static> = AttainableSet {
        scale: [1.0, 1.0],
        centre: [1.0, 0.0],
        edges: &[edge([0.0, 0.0], [1.0, 0.0], 2.0)],
    };

    /// Goes from the centre to `target` face by face; returns the projection there.
    fn walk(set: &AttainableSet<'_>, target: [f32; 2]) -> ([f32; 2], Face) {
        let (mut point, mut face) = (set.centre, set.central_face());
        for _ in 0..8 {
            let step = [target[0] - point[0], target[1] - point[1]];
            match set.crossing(face, point, step, 1.0, 0.0) {
                Some((share, next)) => {
                    point = [point[0] + share * step[0], point[1] + share * step[1]];
                    face = next;
                }
                None => break,
            }
        }
        (set.project(face, target), face)
    }

    #[test]
    fn projections_onto_a_square() {
        assert_eq!(walk(&SQUARE, [1.5, 0.5]), ([1.5, 0.5], Face::Interior));
        assert_eq!(walk(&SQUARE, [1.5, -1.0]), ([1.5, 0.0], Face::Edge(0)));
        assert_eq!(walk(&SQUARE, [3.0, 0.5]), ([2.0, 0.5], Face::Edge(1)));
        assert_eq!(walk(&SQUARE, [3.0, 5.0]), ([2.0, 2.0], Face::Corner(2)));
        assert_eq!(walk(&SQUARE, [-3.0, -5.0]), ([0.0, 0.0], Face::Corner(0)));
    }

    #[test]
    fn projections_onto_a_chord() {
        assert_eq!(walk(&CHORD, [1.5, -1.0]), ([1.5, 0.0], Face::Edge(0)));
        assert_eq!(walk(&CHORD, [-1.0, 3.0]), ([0.0, 0.0], Face::Corner(0)));
        assert_eq!(walk(&CHORD, [4.0, 3.0]), ([2.0, 0.0], Face::Corner(1)));
    }
}
