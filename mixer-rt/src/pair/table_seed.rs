//! A first guess of the throttles by table: bilinear interpolation between 4 x 4 knots in root coordinates.
//!
//! Polynomials of a few terms follow the inverse everywhere a little wrongly; a table follows it locally. Knots are
//! one unit of the coordinates apart. Beyond the outer ones the outer cells are continued, so the guess is continuous
//! everywhere, at the seams up to rounding.

use crate::{Scalar, Seed};

/// Throttles at 4 x 4 knots of (x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSeed {
    /// What is added to (x, y) for the place in the table, 0 at the first knot, 3 at the last.
    pub offset: [f32; 2],
    /// Throttles `[u, l]` at the knots, by x, then by y.
    pub knots: [[[f32; 2]; 4]; 4],
}

impl TableSeed {
    /// Index of the last cell along each coordinate.
    pub const LAST_CELL: usize = 2;

    /// `[u, l]` by the given cell, at the distances `place` in [0, 1] from its corner.
    ///
    /// A cell beyond [`TableSeed::LAST_CELL`] counts as that one.
    #[inline(always)]
    pub fn within<S: Scalar>(&self, [i, j]: [usize; 2], [a, b]: [S; 2]) -> [S; 2] {
        // Written out: where a closure is not inlined, the compiler does not see that no index is out of range.
        let i = if i < Self::LAST_CELL { i } else { Self::LAST_CELL };
        let j = if j < Self::LAST_CELL { j } else { Self::LAST_CELL };
        let (near, far) = (&self.knots[i], &self.knots[i + 1]);
        let low = between(near[j], far[j], a);
        let high = between(near[j + 1], far[j + 1], a);
        [(high[0] - low[0]) * b + low[0], (high[1] - low[1]) * b + low[1]]
    }

    /// `[u, l]` at the place `[x, y]` in the table.
    #[inline(always)]
    pub fn at(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let (i, j) = (cell(x), cell(y));
        self.within([i, j], [x - i as f32, y - j as f32])
    }
}

/// The cell along one coordinate.
#[inline(always)]
fn cell(x: f32) -> usize {
    // The conversion takes negative numbers and NaN to 0.
    let index = x as u32;
    let last = TableSeed::LAST_CELL as u32;
    (if index < last { index } else { last }) as usize
}

/// The share `share` of the way from one pair of numbers to another.
#[inline(always)]
fn between<S: Scalar>(from: [f32; 2], to: [f32; 2], share: S) -> [S; 2] {
    let one = |from: S, to: S| (to - from) * share + from;
    [
        one(S::constant(from[0]), S::constant(to[0])),
        one(S::constant(from[1]), S::constant(to[1])),
    ]
}

impl Seed for TableSeed {
    #[inline(always)]
    fn guess<S: Scalar>(&self, x: S, y: S) -> [S; 2] {
        S::interpolate(self, [x + self.offset[0], y + self.offset[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u = 1 + 2 x - y + x y / 2, l = x + 3 y with a bend at x = 1.
    fn table() -> TableSeed {
        let knot = |i: usize, j: usize| {
            let (x, y) = (i as f32, j as f32);
            [
                1.0 + 2.0 * x - y + 0.5 * x * y,
                if i > 1 { 2.0 * x - 1.0 } else { x } + 3.0 * y,
            ]
        };
        TableSeed {
            offset: [-0.5, 0.25],
            knots: core::array::from_fn(|i| core::array::from_fn(|j| knot(i, j))),
        }
    }

    #[test]
    fn bilinear_functions_are_met_between_the_knots_and_beyond() {
        for (x, y) in [
            (0.0f32, 0.0f32),
            (0.75, 2.5),
            (1.5, 1.0),
            (2.25, 3.5),
            (-1.0, 0.5),
            (4.0, -2.0),
        ] {
            let [u, l] = table().guess(x + 0.5, y - 0.25);
            assert_eq!(u, 1.0 + 2.0 * x - y + 0.5 * x * y, "{x} {y}");
            assert_eq!(l, if x > 1.0 { 2.0 * x - 1.0 } else { x } + 3.0 * y, "{x} {y}");
        }
        assert!(
            table().at([f32::NAN, 0.0])[0].is_nan(),
            "and is limited to the idle later"
        );
    }

    #[test]
    fn seams_are_continuous_up_to_rounding() {
        for seam in [1.0f32, 2.0] {
            for other in [0.3f32, 1.7, 2.9] {
                for swap in [false, true] {
                    let at = |x: f32| table().at(if swap { [other, x] } else { [x, other] });
                    let (below, above) = (at(seam.next_down()), at(seam));
                    for k in 0..2 {
                        assert!((below[k] - above[k]).abs() < 4e-6, "{seam} {other}");
                    }
                }
            }
        }
    }
}
