//! The attainable torques of a unit at its thrust: [Q_min(f), Q_max(f)].
//!
//! Two descriptions. The fine one limits what a unit gives: the middle and half the width of the
//! range, both linear in cells of thrust, so that one look-up without a loop gives both sides. Its
//! chords lie inside the attainable set. The cells are equal between the idle corner, the two
//! corners of the set where one rotor idles and the other is at full throttle, and the full corner,
//! since the sides bend sharply there and hardly anywhere else.
//!
//! The coarse one tells at which thrusts yaw reaches furthest: each side's concave hull in a few
//! straight lines, of which only the slopes matter.

use crate::arithmetic::Scalar;

/// Beyond all cells, and within all integers.
const MOST_PLACE: f32 = 1_073_741_824.0;

/// How far out of reach every torque is beyond the cells: more than is asked, and nothing overflows
/// by it.
const BEYOND_NM: f32 = 1e9;

/// Middle and half the width of the attainable torques at the thrusts of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// `(Q_max + Q_min) / 2` at the cell's start, N m, and by how much more it is at its end.
    pub middle: [f32; 2],
    /// `(Q_max - Q_min) / 2` likewise.
    pub half: [f32; 2],
}

/// Equal cells: thrust f is in cell `offset + per_n f`, rounded down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Place of zero thrust in cells, extrapolated; cells are counted through all grids.
    pub offset: f32,
    /// Cells per N.
    pub per_n: f32,
}

/// A thrust at which a side bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// N.
    pub thrust_n: f32,
    /// Decrease of the side's slope at this thrust, N m per N, >= 0.
    pub drop: f32,
}

/// A coarse concave description of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// Slope of the side before the first knot, N m per N.
    pub slope: f32,
    /// In the order of the thrust.
    pub knots: [Knot; Outline::KNOTS],
}

impl Outline {
    /// Knots of a side.
    pub const KNOTS: usize = 3;
}

/// The border of a unit's attainable set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Border<'a> {
    /// Thrusts at which the second and the third grid begin, N.
    pub corners_n: [f32; 2],
    /// Grids of cells before, between and beyond these.
    pub grids: [Grid; 3],
    /// Their cells, in the order of the thrust, and one more from the largest thrust on.
    pub cells: &'a [Cell],
    /// Coarse Q_max(f), and -Q_min(f).
    pub outlines: [Outline; 2],
    /// The most that attainable torques are beyond the cells' ranges, N m.
    pub lost_nm: f32,
}

impl Border<'_> {
    /// Middle and half the width of the attainable torques at the thrust `f`, N m; the latter is
    /// negative where `f` is not attainable.
    #[inline(always)]
    pub fn torques(&self, f: f32) -> [f32; 2] {
        let [first, second] = self.corners_n;
        let [below, between, above] = &self.grids;
        let mut grid = if f < first { below } else { between };
        if f >= second {
            grid = above;
        }
        let place = grid.offset + f * grid.per_n;
        // Made an integer, what is negative or too large would be an invalid operation on a Cortex-M.
        let index = place.within_positive(0.0, MOST_PLACE) as u32;
        let Some(cell) = self.cells.get(index as usize) else {
            return [0.0, -BEYOND_NM];
        };
        let part = place - index as f32;
        let [middle, half] = [cell.middle, cell.half].map(|[start, more]| start + part * more);
        [middle, half]
    }
}
