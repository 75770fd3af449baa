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
    pub fn within<S: Scalar>(&self, cell: [usize; 2], place: [S; 2]) -> [S; 2] {
        let [i, j] = cell.map(|index| {
            if index < Self::LAST_CELL {
                index
            } else {
                Self::LAST_CELL
            }
        });
        let ([near, far], [a, b]) = ([&self.knots[i], &self.knots[i + 1]], place);
        let mix = |from: S, to: S, share: S| (to - from) * share + from;
        let along = |j: usize, k: usize| mix(S::constant(near[j][k]), S::constant(far[j][k]), a);
        [0, 1].map(|k| mix(along(j, k), along(j + 1, k), b))
    }

    /// `[u, l]` at the place `[x, y]` in the table.
    #[inline(always)]
    pub fn at(&self, place: [f32; 2]) -> [f32; 2] {
        // The conversion takes negative numbers and NaN to 0.
        let cell = place.map(|x| {
            let index = x as usize;
            if index < Self::LAST_CELL {
                index
            } else {
                Self::LAST_CELL
            }
        });
        self.within(cell, [0, 1].map(|k| place[k] - cell[k] as f32))
    }
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
