//! The attainable set of one unit: all efforts (f, Q) that its rotors can give together.
//!
//! It is the image of the throttle box under the forward map, a curved quadrangle ("the zone of achievable
//! thrust-torque pairs", section IV-B2), almost convex for the paper's pair: its convex hull is 0.35 % larger. Those of
//! real pairs bend inwards more. The compiler tabulates a polygon inside it, all of which is seen from one point, the
//! centre. Of a unit that has lost a rotor a curve is left, and of that its chord.
//!
//! Desaturation projects points of the plane onto this set. The projection of `p` is piecewise affine: the plane
//! falls into the set itself, a strip beyond every edge, on which `p` goes to the edge, and a cone beyond every
//! corner, on which it goes to the corner. [`Face`] names the region that `p` lies in, and a [`Point`] is held by
//! coordinates of its own region, so that the projection stays exact however far outside `p` lies, and a point that
//! comes to a border is on it.
//!
//! Where the border bends inwards, at a corner of more than 180 degrees, the strips of both edges overlap: there a
//! projection that comes to the corner goes on along the other edge, from the same distance. `p` turns about the corner
//! by the angle between the edges.

mod edge;
mod hollow;

use crate::{clamp, sqrt};
pub use edge::Edge;
use edge::NO_EDGE;

/// A set inside the attainable set at the reference voltage; at another voltage it is scaled by `[k_f, k_Q]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttainableSet<'a> {
    /// Newtons and newton metres per unit of the coordinates below; both positive. They make the set about as
    /// high as it is wide.
    pub scale: [f32; 2],
    /// A point inside from which all of it is seen (for a chord its middle), scaled.
    pub centre: [f32; 2],
    /// The edges of the polygon, anticlockwise in the plane with f to the right and Q upwards, each starting
    /// where its predecessor ends. A single edge is a chord, taken from both sides.
    pub edges: &'a [Edge],
}

/// The part of a set that a point is projected onto.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Face {
    /// The point itself. The index is that of an edge through whose triangle with the centre the point was seen last.
    #[default]
    Interior,
    /// The edge of this index.
    Edge,
    /// The start of the edge of this index; for a chord 1 is its end.
    Corner,
}

/// A point of the plane, by its projection.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Point {
    pub(crate) face: Face,
    index: u8,
    /// Interior: the point. Edge: the projection's distance from the edge's start, and the point's from the edge,
    /// outwards. Corner: the heights above the borders to the edge that ends there and to the edge that starts there
    /// (a chord: above its only border, and the distance from the chord, outwards).
    at: [f32; 2],
}

impl Point {
    /// In a corner that it cannot leave.
    pub(crate) fn pinned(corner: u8) -> Self {
        Point {
            face: Face::Corner,
            index: corner,
            at: [f32::INFINITY; 2],
        }
    }

    /// True where it can leave its face no more.
    pub(crate) fn is_pressed(&self) -> bool {
        self.face != Face::Interior && self.at[1] == f32::INFINITY
            || self.face == Face::Corner && self.at[0] == f32::INFINITY
    }

    /// The face, and which one of its kind; any interior is the same.
    pub(crate) fn region(&self) -> (Face, u8) {
        (self.face, self.index)
    }
}

/// A change of face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// After this multiple of the step.
    pub(crate) share: f32,
    face: Face,
    index: u8,
}

/// The first fall of a height through zero.
struct Falls {
    barred: Option<(Face, u8)>,
    first: Option<Crossing>,
    limit: f32,
}

impl Falls {
    /// `height` changes by `speed` per step; speeds below `noise` count as none.
    #[inline(always)]
    fn watch(&mut self, height: f32, speed: f32, noise: f32, face: Face, index: u8) {
        if speed < -noise && height < -speed * self.limit && self.barred != Some((face, index)) {
            let share = if height > 0.0 { height / -speed } else { 0.0 };
            self.limit = share;
            self.first = Some(Crossing { share, face, index });
        }
    }
}

/// Efforts inside the set that move by less than this on the whole way stand still.
const STANDING: f32 = 3e-5;

/// Efforts that come to be outside the set by less than this are still inside.
const OUTSIDE: f32 = 3e-6;

impl AttainableSet<'_> {
    #[inline]
    fn is_chord(&self) -> bool {
        self.edges.len() == 1
    }

    #[inline]
    fn edge(&self, index: u8) -> &Edge {
        self.edges.get(usize::from(index)).unwrap_or(&NO_EDGE)
    }

    /// The index of the edge that ends at the corner of `index`.
    #[inline]
    fn before(&self, index: u8) -> u8 {
        match index.checked_sub(1) {
            Some(before) => before,
            None => self.edges.len().saturating_sub(1) as u8,
        }
    }

    /// The index of the corner at which the edge of `index` ends.
    #[inline]
    fn after(&self, index: u8) -> u8 {
        let next = index.wrapping_add(1);
        if usize::from(next) < self.edges.len() || self.is_chord() {
            next
        } else {
            0
        }
    }

    /// The position of the corner of `index`.
    #[inline]
    pub(crate) fn corner(&self, index: u8) -> [f32; 2] {
        match self.edges.get(usize::from(index)) {
            Some(edge) => edge.start,
            None => {
                let edge = self.edge(0);
                edge.at(edge.length)
            }
        }
    }

    /// The edge through whose triangle with the centre `point` is seen, found from `index` on.
    #[inline]
    fn sector(&self, point: [f32; 2], index: u8) -> u8 {
        let way = [point[0] - self.centre[0], point[1] - self.centre[1]];
        // Positive where `way` is anticlockwise of the start of the edge.
        let beyond_start = |index: u8| {
            let start = self.edge(index).start;
            (start[0] - self.centre[0]) * way[1] - (start[1] - self.centre[1]) * way[0] >= 0.0
        };
        let mut index = index;
        if beyond_start(index) {
            for _ in self.edges {
                let next = self.after(index);
                if !beyond_start(next) {
                    break;
                }
                index = next;
            }
        } else {
            for _ in self.edges {
                index = self.before(index);
                if beyond_start(index) {
                    break;
                }
            }
        }
        index
    }

    /// Finds the face that `point` is projected onto.
    pub(crate) fn locate(&self, point: [f32; 2]) -> Point {
        let mut index = 0;
        if !self.is_chord() {
            if point == self.centre {
                return Point {
                    face: Face::Interior,
                    index,
                    at: point,
                };
            }
            index = self.sector(point, 0);
            let edge = self.edge(index);
            if edge.beyond(edge.relative(point)) <= 0.0 {
                return Point {
                    face: Face::Interior,
                    index,
                    at: point,
                };
            }
        }
        // Along the border, downhill.
        let mut backwards = false;
        for _ in self.edges {
            let edge = self.edge(index);
            let way = edge.relative(point);
            let s = edge.along(way);
            if s < 0.0 {
                let before = self.edge(self.before(index));
                if self.is_chord() || before.along(before.relative(point)) >= before.length {
                    return self.at_corner(index, way);
                }
                index = self.before(index);
                backwards = true;
            } else if s > edge.length && !backwards {
                let corner = self.corner(self.after(index));
                let way = [point[0] - corner[0], point[1] - corner[1]];
                if self.is_chord() || self.edge(self.after(index)).along(way) <= 0.0 {
                    return self.at_corner(self.after(index), way);
                }
                index = self.after(index);
            } else {
                return Point {
                    face: Face::Edge,
                    index,
                    at: [clamp(s, 0.0, edge.length), edge.beyond(way)],
                };
            }
        }
        Point {
            face: Face::Corner,
            index,
            at: [0.0; 2],
        }
    }

    /// The distance of `point` from the set.
    pub(crate) fn distance(&self, point: [f32; 2]) -> f32 {
        let nearest = self.project(&self.locate(point));
        let [f, q] = [point[0] - nearest[0], point[1] - nearest[1]];
        sqrt(f * f + q * q)
    }

    /// The projection of `point`.
    #[inline]
    pub(crate) fn project(&self, point: &Point) -> [f32; 2] {
        match point.face {
            Face::Interior => point.at,
            Face::Edge => self.edge(point.index).at(point.at[0]),
            Face::Corner => self.corner(point.index),
        }
    }

    /// The direction of the edge that the projection is bound to.
    #[inline]
    pub(crate) fn direction(&self, point: &Point) -> [f32; 2] {
        self.edge(point.index).along
    }

    /// The velocity of `point`, in its own coordinates, where it moves by `step` in the plane.
    #[inline]
    pub(crate) fn velocity(&self, point: &Point, step: [f32; 2]) -> [f32; 2] {
        match point.face {
            Face::Interior => step,
            Face::Corner => self.heights(point.index, step),
            Face::Edge => {
                let edge = self.edge(point.index);
                [edge.along(step), edge.beyond(step)]
            }
        }
    }

    /// The first change of face of a point on its way along `limit` times `velocity` (in its own coordinates).
    /// Velocities along an edge below `standing` and outside the set below `noise` count as none.
    #[inline]
    pub(crate) fn crossing(
        &self,
        point: &mut Point,
        velocity: [f32; 2],
        limit: f32,
        [standing, noise]: [f32; 2],
        barred: Option<(Face, u8)>,
    ) -> Option<Crossing> {
        let mut falls = Falls {
            barred,
            first: None,
            limit,
        };
        let [along, away] = velocity;
        let index = point.index;
        match point.face {
            Face::Interior => self.exit(point, velocity, &mut falls),
            Face::Edge => {
                let (height, corner, next) = if along < 0.0 {
                    (point.at[0], index, self.before(index))
                } else {
                    let after = self.after(index);
                    (self.edge(index).length - point.at[0], after, after)
                };
                let (face, next) = if self.turn(corner) > 0.0 || self.is_chord() {
                    (Face::Corner, corner)
                } else if barred == Some((Face::Edge, next)) {
                    // Either edge leads to the other: the way goes inside.
                    (Face::Interior, index)
                } else {
                    (Face::Edge, next)
                };
                falls.watch(height, -along.abs(), standing, face, next);
                if !self.is_chord() {
                    falls.watch(point.at[1], away, noise, Face::Interior, index);
                }
            }
            Face::Corner => {
                let (ending, starting) = self.borders(index);
                let [first, second] = point.at;
                falls.watch(first, along, noise, Face::Edge, ending);
                if !self.is_chord() {
                    falls.watch(second, away, noise, Face::Edge, starting);
                }
            }
        }
        falls.first
    }

    /// Where a point inside leaves the polygon: through the first edge, of those through which the way comes to be seen in
    /// turn, whose far corner it leaves on the centre's side, or through the last, if it ends beyond that.
    #[inline]
    fn exit(&self, point: &mut Point, velocity: [f32; 2], falls: &mut Falls) {
        let from = point.at;
        let limit = falls.limit;
        let end = [from[0] + limit * velocity[0], from[1] + limit * velocity[1]];
        let last = self.sector(end, point.index);
        let mut index = if from == self.centre {
            last
        } else {
            self.sector(from, point.index)
        };
        let left_of_way =
            |point: [f32; 2]| velocity[0] * (point[1] - from[1]) - velocity[1] * (point[0] - from[0]);
        let forwards = left_of_way(self.centre) >= 0.0;
        for _ in self.edges {
            if index == last {
                break;
            }
            let next = self.after(index);
            let far = left_of_way(self.corner(if forwards { next } else { index }));
            let is_passed = if forwards { far <= 0.0 } else { far >= 0.0 };
            if !is_passed && self.edge(index).beyond(velocity) > STANDING {
                break;
            }
            index = if forwards { next } else { self.before(index) };
        }
        point.index = index;
        let edge = self.edge(index);
        if index != last || edge.beyond(edge.relative(end)) > OUTSIDE {
            let depth = -edge.beyond(edge.relative(from));
            falls.watch(depth, -edge.beyond(velocity), STANDING, Face::Edge, index);
        }
    }

    /// Moves `point` by `way` in its own coordinates, within its region.
    #[inline]
    pub(crate) fn shift(&self, point: &mut Point, way: [f32; 2]) {
        point.at = [point.at[0] + way[0], point.at[1] + way[1]];
        if point.face == Face::Edge {
            point.at[0] = clamp(point.at[0], 0.0, self.edge(point.index).length);
        }
    }

    /// Takes `point`, which lies on the border of its region, over to the next.
    pub(crate) fn cross(&self, point: &mut Point, crossing: Crossing) {
        let Crossing { face, index, .. } = crossing;
        let from = *point;
        let at = match (from.face, face) {
            (Face::Edge, Face::Interior) => self.edge(from.index).at(from.at[0]),
            (Face::Edge, Face::Edge) => {
                let starts_here = self.after(from.index) == index;
                let s = if starts_here { 0.0 } else { self.edge(index).length };
                // What was pressed on one edge is not on another.
                let away = if from.at[1] < f32::INFINITY {
                    from.at[1]
                } else {
                    0.0
                };
                [s, away]
            }
            (Face::Edge, Face::Corner) => {
                let away = from.at[1];
                if self.is_chord() {
                    [0.0, away]
                } else if from.index == index {
                    [away * self.turn(index), 0.0]
                } else {
                    [0.0, away * self.turn(index)]
                }
            }
            (Face::Corner, Face::Edge) => {
                let [first, second] = from.at;
                let starts_here = from.index == index;
                let away = if self.is_chord() {
                    second
                } else {
                    (if starts_here { first } else { second }) / self.turn(from.index)
                };
                [if starts_here { 0.0 } else { self.edge(index).length }, away]
            }
            (Face::Interior, Face::Edge) => {
                let edge = self.edge(index);
                let s = edge.along(edge.relative(from.at));
                [clamp(s, 0.0, edge.length), 0.0]
            }
            _ => from.at,
        };
        *point = Point { face, index, at };
    }

    /// The edges that end and start at the corner of `index`.
    #[inline]
    fn borders(&self, index: u8) -> (u8, u8) {
        if self.is_chord() {
            (0, 0)
        } else {
            (self.before(index), index)
        }
    }

    /// The sine of the angle by which the border turns at the corner of `index`.
    #[inline]
    fn turn(&self, index: u8) -> f32 {
        let (ending, starting) = self.borders(index);
        self.edge(starting).beyond(self.edge(ending).along)
    }

    /// The heights of the way `from_corner` above the borders of the corner's region.
    #[inline]
    fn heights(&self, index: u8, from_corner: [f32; 2]) -> [f32; 2] {
        let (ending, starting) = self.borders(index);
        let (ending, starting) = (self.edge(ending), self.edge(starting));
        if self.is_chord() {
            let s = ending.along(from_corner);
            [if index == 0 { -s } else { s }, ending.beyond(from_corner)]
        } else {
            [ending.along(from_corner), -starting.along(from_corner)]
        }
    }

    fn at_corner(&self, index: u8, from_corner: [f32; 2]) -> Point {
        Point {
            face: Face::Corner,
            index,
            at: self.heights(index, from_corner),
        }
    }
}

#[cfg(test)]
mod tests;
