//! The edges of an attainable set.

/// One edge of an [`AttainableSet`](crate::AttainableSet), in the set's own units: see its `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The corner where it starts.
    pub start: [f32; 2],
    /// Unit vector towards its end.
    pub along: [f32; 2],
    /// Its length.
    pub length: f32,
}

pub(super) const NO_EDGE: Edge = Edge {
    start: [0.0; 2],
    along: [1.0, 0.0],
    length: 0.0,
};

impl Edge {
    #[inline]
    pub(super) fn relative(&self, point: [f32; 2]) -> [f32; 2] {
        [point[0] - self.start[0], point[1] - self.start[1]]
    }

    /// The part of `vector` along the edge.
    #[inline]
    pub(super) fn along(&self, vector: [f32; 2]) -> f32 {
        vector[0] * self.along[0] + vector[1] * self.along[1]
    }

    /// The part of `vector` along the outward normal: the interior lies to the edge's left.
    #[inline]
    pub(super) fn beyond(&self, vector: [f32; 2]) -> f32 {
        vector[0] * self.along[1] - vector[1] * self.along[0]
    }

    /// The point at distance `s` from the start.
    #[inline]
    pub(crate) fn at(&self, s: f32) -> [f32; 2] {
        [
            self.start[0] + s * self.along[0],
            self.start[1] + s * self.along[1],
        ]
    }
}
