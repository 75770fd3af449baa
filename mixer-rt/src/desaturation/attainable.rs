//! The attainable set of one unit as a small convex polygon in (f, Q), which the general path
//! allocates over.

/// A corner of a unit's polygon with the edge that leaves it, anticlockwise, in scaled efforts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// `[f, Q]`, scaled.
    pub at: [f32; 2],
    /// From here to the next corner.
    pub edge: [f32; 2],
    /// From here to the corner before.
    pub back: [f32; 2],
    /// Points `[f, q]` on this edge's inner side have `edge[1] f - edge[0] q <= bound`.
    pub bound: f32,
}

impl Corner {
    /// The corner at `at` between two others of its polygon.
    #[inline]
    pub fn between(before: [f32; 2], at: [f32; 2], next: [f32; 2]) -> Corner {
        let edge = [next[0] - at[0], next[1] - at[1]];
        Corner {
            at,
            edge,
            back: [before[0] - at[0], before[1] - at[1]],
            bound: edge[1] * at[0] - edge[0] * at[1],
        }
    }

    /// How far `[f, q]` is beyond the edge, times the edge's length; negative inside.
    #[inline(always)]
    pub(crate) fn beyond(&self, [f, q]: [f32; 2]) -> f32 {
        self.outward([f, q]) - self.bound
    }

    /// The part of a direction that leads out across the edge, times the edge's length.
    #[inline(always)]
    pub(crate) fn outward(&self, [f, q]: [f32; 2]) -> f32 {
        self.edge[1] * f - self.edge[0] * q
    }
}

/// A convex polygon inside the attainable set of a unit with both rotors, at the reference voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttainableSet<'a> {
    /// Newtons and newton metres per unit of the scaled efforts.
    pub scale: [f32; 2],
    /// A point well inside, scaled.
    pub centre: [f32; 2],
    /// The corners, anticlockwise, three to eight.
    pub corners: &'a [Corner],
}

/// Level flight with all rotors, which the general path retreats to where its pivots do not
/// suffice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelFlight<'a> {
    /// Least and largest thrust, N at the reference voltage.
    pub thrust_n: [f32; 2],
    /// Every unit's efforts at these two, scaled, inside its polygon. Empty where there is a closed
    /// form.
    pub efforts: &'a [[[f32; 2]; 2]],
}
