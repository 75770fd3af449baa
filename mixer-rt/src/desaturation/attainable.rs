//! The attainable set of one unit as a small convex polygon in (f, Q), which the general path
//! allocates over.

/// Length of a table of corners: a power of two, so that an index is masked and not compared.
pub const CORNERS: usize = 16;

/// A corner of a convex set in scaled efforts with the ways that leave it. A set of two corners is a
/// segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Corner {
    /// `[f, Q]`, scaled.
    pub at: [f32; 2],
    /// From here to the next corner, anticlockwise, and to the one before.
    pub ways: [[f32; 2]; 2],
    /// Points `[f, q]` on the inner side of the edge to the next corner have `outward <= bound`.
    pub bound: f32,
    /// Where the ways lead: indices of corners.
    pub links: [u8; 2],
}

impl Corner {
    /// The corner at `at` between two others of its set, which have these indices.
    #[inline]
    pub fn between(before: [f32; 2], at: [f32; 2], next: [f32; 2], [to_next, to_before]: [u8; 2]) -> Corner {
        let edge = [next[0] - at[0], next[1] - at[1]];
        Corner {
            at,
            ways: [edge, [before[0] - at[0], before[1] - at[1]]],
            bound: edge[1] * at[0] - edge[0] * at[1],
            links: [to_next, to_before],
        }
    }

    /// How far `[f, q]` is beyond the edge, times the edge's length; negative inside.
    #[inline(always)]
    pub(crate) fn beyond(&self, efforts: [f32; 2]) -> f32 {
        self.outward(efforts) - self.bound
    }

    /// The part of a direction that leads out across the edge, times the edge's length.
    #[inline(always)]
    pub(crate) fn outward(&self, [f, q]: [f32; 2]) -> f32 {
        let [[e0, e1], _] = self.ways;
        e1 * f - e0 * q
    }
}

/// What a unit attains at the reference voltage: with both rotors a convex polygon inside its set,
/// with one the chord of the rotor's curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttainableSet<'a> {
    /// Newtons and newton metres per unit of the scaled efforts.
    pub scale: [f32; 2],
    /// A point well inside the polygon, scaled.
    pub centre: [f32; 2],
    /// The corners of the polygon from 0, anticlockwise, three to eight; from [`Self::UPPER`] and
    /// [`Self::LOWER`] the ends of the rotors' chords.
    pub corners: &'a [Corner; CORNERS],
    /// How many corners the polygon has.
    pub count: u8,
}

impl<'a> AttainableSet<'a> {
    /// Index of the two corners of the upper rotor alone: at its least throttle, then at its largest.
    pub const UPPER: u8 = 8;
    /// Index of the two corners of the lower rotor alone.
    pub const LOWER: u8 = 10;

    /// The corners of the polygon.
    #[inline(always)]
    pub(crate) fn polygon(&self) -> &'a [Corner] {
        self.corners.get(..usize::from(self.count)).unwrap_or_default()
    }
}

/// Level flight with all rotors, from which the general path sets out where its pivots do not
/// suffice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelFlight<'a> {
    /// Least and largest thrust, N at the reference voltage.
    pub thrust_n: [f32; 2],
    /// Every unit's efforts at these two, scaled, inside its polygon. Empty where there is a closed
    /// form.
    pub efforts: &'a [[[f32; 2]; 2]],
}
