//! The Gram matrix of a set of vectors in R^4, factorised while they are added one by one.
//!
//! `J = sum g g^T = L D L^T` with L unit lower triangular. Adding `a g g^T` is a rank-one update of the factors (Gill,
//! Golub, Murray, Saunders 1974), which is a Givens rotation of `sqrt(D) L^T` without its square roots. So J itself
//! is never formed, which would square its condition number: a vector is told from a combination of others down to an
//! angle of [`LEAST_ANGLE`], where the entries of J would hide angles below the root of the rounding error.

use core::hint::black_box;

use crate::sqrt;

/// A vector that differs from a combination of the others by less than this (vectors are of order one) adds nothing. It could
/// move the wrench by as little only; but one priority given up by so little may have led the next to another end, so the angle
/// is no larger than rounding asks for: smaller ones give multipliers, their inverse square, whose rounding errors are larger
/// than what they multiply.
const LEAST_ANGLE: f32 = 1.5e-6;

/// A right-hand side that misses the range of J by less than this share of what it is made of counts as within it.
const CONSISTENT: f32 = 4e-5;

/// With a determinant beyond this (the diagonal of J is at most one) no angle is below 0.03.
const FAR_FROM_SINGULAR: f32 = 1e-3;

/// A pivot that is a smaller share of its diagonal entry is left to the factors that are updated vector by vector.
const LEAST_PIVOT: f32 = 1e-3;

/// The same of all pivots so far together: what a small one leaves of the next is known the less.
const LEAST_PIVOTS: f32 = 1e-4;

/// J itself: enough where it is far from singular, which most often is so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    /// The lower triangle, by rows; other entries are not used.
    rows: [[f32; 4]; 4],
}

/// L D L^T = J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Factors {
    /// L below its diagonal, by rows.
    rows: [[f32; 4]; 4],
    /// 1 / D; 0 for rows that are not active.
    per_pivot: [f32; 4],
}

impl Moments {
    /// Adds `g g^T`.
    #[inline(always)]
    pub(crate) fn add(&mut self, g: &[f32; 4]) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            for (entry, factor) in row.iter_mut().zip(g).take(i + 1) {
                *entry += g[i] * factor;
            }
        }
    }

    /// Which rows any vector has a part in.
    #[inline(always)]
    pub(crate) fn spanned(&self) -> [bool; 4] {
        let [[first, ..], [_, second, ..], [_, _, third, _], [_, _, _, fourth]] = self.rows;
        [first, second, third, fourth].map(|square| square > 0.0)
    }

    /// The factors for the `active` rows; `None` where these are nearly dependent.
    #[inline(always)]
    pub(crate) fn factors(self, active: [bool; 4]) -> Option<Factors> {
        let mut rows = self.rows;
        let diagonals = [rows[0][0], rows[1][1], rows[2][2], rows[3][3]];
        let mut per_pivot = [0.0; 4];
        let (mut pivots, mut least) = (1.0, LEAST_PIVOTS);
        for i in 0..4 {
            if !active[i] {
                rows[i] = [0.0; 4];
                continue;
            }
            // Row i of L D, then of L.
            let mut pivot = rows[i][i];
            for j in 0..i {
                let mut entry = rows[i][j];
                for (own, other) in rows[i].iter().zip(&rows[j]).take(j) {
                    entry -= own * other;
                }
                rows[i][j] = entry;
            }
            for j in 0..i {
                let entry = rows[i][j];
                rows[i][j] = entry * per_pivot[j];
                pivot -= entry * rows[i][j];
            }
            let diagonal = diagonals[i];
            (pivots, least) = (pivots * pivot, least * diagonal);
            if pivot <= LEAST_PIVOT * diagonal || pivots <= least {
                return None;
            }
            per_pivot[i] = 1.0 / pivot;
        }
        Some(Factors { rows, per_pivot })
    }
}

impl Factors {
    /// Solves `J x = b`; 0 for rows that are not active.
    #[inline]
    pub(crate) fn solve(&self, mut x: [f32; 4]) -> [f32; 4] {
        for i in 1..4 {
            for j in 0..i {
                x[i] -= self.rows[i][j] * x[j];
            }
        }
        for (x, per_pivot) in x.iter_mut().zip(self.per_pivot) {
            *x *= per_pivot;
        }
        for i in (0..3).rev() {
            for j in i + 1..4 {
                x[i] -= self.rows[j][i] * x[j];
            }
        }
        x
    }
}

/// What a system has for a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Solution {
    /// `x` with `J x = b`.
    Regular([f32; 4]),
    /// There is none: `v` with `J v = 0` and `v b > 0`.
    Inconsistent([f32; 4]),
}

/// The factors of J; zero before the first vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gram {
    /// D.
    diagonal: [f32; 4],
    /// L below its diagonal, by columns; other entries are not used. A column is zero where D is.
    columns: [[f32; 4]; 4],
}

impl Gram {
    /// Of no vectors.
    pub(crate) fn new() -> Self {
        let zero = unknown_zero();
        Gram {
            diagonal: [zero; 4],
            columns: [[zero; 4]; 4],
        }
    }

    /// Adds `g g^T`.
    pub(crate) fn add(&mut self, mut g: [f32; 4]) {
        let mut weight = 1.0;
        for k in 0..4 {
            let entry = g[k];
            if entry == 0.0 {
                continue;
            }
            let grown = self.diagonal[k] + weight * entry * entry;
            if grown <= LEAST_ANGLE * LEAST_ANGLE {
                continue;
            }
            let per_grown = 1.0 / grown;
            let kept = self.diagonal[k] * per_grown;
            let added = weight * entry * per_grown;
            self.diagonal[k] = grown;
            weight *= kept;
            for (value, g) in self.columns[k].iter_mut().zip(&mut g).skip(k + 1) {
                let old = *value;
                *value = kept * old + added * *g;
                *g -= entry * old;
            }
            if weight == 0.0 {
                break;
            }
        }
    }

    /// Solves `J x = b`. Where `J` is singular and `b` in its range, unknowns without a pivot are zero. `terms`
    /// gives the size of the numbers that `b` is a difference of, which have left rounding errors in it; 0 where it is
    /// exact. The factors may be used up.
    pub(crate) fn solve(&mut self, b: [f32; 4], terms: impl FnOnce() -> f32) -> Solution {
        self.substitute(b)
            .map_or_else(|| self.orthogonalise(b, terms()), Solution::Regular)
    }

    /// The solution where J is far from singular on the rows that have a part in it, which most often is so.
    fn substitute(&self, b: [f32; 4]) -> Option<[f32; 4]> {
        let mut determinant = 1.0;
        for diagonal in self.diagonal {
            if diagonal > 0.0 {
                determinant *= diagonal;
            }
        }
        if determinant < FAR_FROM_SINGULAR {
            return None;
        }
        let mut x = b;
        for k in 0..3 {
            let value = x[k];
            for (x, factor) in x.iter_mut().zip(self.columns[k]).skip(k + 1) {
                *x -= factor * value;
            }
        }
        for (x, diagonal) in x.iter_mut().zip(self.diagonal) {
            if diagonal > 0.0 {
                *x /= diagonal;
            } else if *x != 0.0 {
                return None;
            }
        }
        for k in (0..3).rev() {
            let mut value = x[k];
            for (x, factor) in x.iter().zip(self.columns[k]).skip(k + 1) {
                value -= factor * x;
            }
            x[k] = value;
        }
        Some(x)
    }

    /// `J = C^T C` with `C = sqrt(D) L^T`, whose columns are orthogonalised, the longest that is left first: so a
    /// column that is a combination of others shows as one, however the rows of the wrench are ordered.
    fn orthogonalise(&mut self, b: [f32; 4], terms: f32) -> Solution {
        // Of C, in the place of L.
        let Gram { diagonal, columns } = self;
        for k in 0..4 {
            let root = sqrt(diagonal[k]);
            columns[k][k] = root;
            #[expect(clippy::needless_range_loop, reason = "an entry of two columns")]
            for j in k + 1..4 {
                columns[j][k] = root * columns[k][j];
                columns[k][j] = 0.0;
            }
        }
        let largest = b
            .iter()
            .fold(0.0, |most: f32, b| if b.abs() > most { b.abs() } else { most });
        let mut pivots = [NO_PIVOT; 4];
        let mut left = [true; 4];
        let (mut rest, mut size) = (b, [largest + terms; 4]);
        // One after the other: four copies of the loop would be hardly faster.
        for pivot in black_box(pivots.as_mut_slice()) {
            let mut longest = (LEAST_ANGLE * LEAST_ANGLE, 4);
            for (index, (column, left)) in columns.iter().zip(left).enumerate() {
                let square = dot(column, column);
                if left && square > longest.0 {
                    longest = (square, index);
                }
            }
            let (square, index) = longest;
            if index > 3 {
                break;
            }
            let length = sqrt(square);
            let direction = columns[index & 3].map(|part| part / length);
            left[index & 3] = false;
            let value = rest[index & 3] / length;
            *pivot = Pivot {
                index,
                length,
                value,
                parts: [0.0; 4],
            };
            for k in 0..4 {
                if left[k] {
                    let part = dot(&direction, &columns[k]);
                    pivot.parts[k] = part;
                    for (entry, direction) in columns[k].iter_mut().zip(direction) {
                        *entry -= part * direction;
                    }
                    rest[k] -= part * value;
                    size[k] += (part * value).abs();
                }
            }
        }
        let mut consistent = true;
        let mut x = [0.0; 4];
        for k in 0..4 {
            if left[k] && rest[k].abs() > CONSISTENT * size[k] {
                consistent = false;
                x[k] = rest[k];
            }
        }
        for pivot in pivots.iter().rev() {
            if pivot.index < 4 {
                let value = if consistent { pivot.value } else { 0.0 };
                x[pivot.index & 3] = (value - dot(&pivot.parts, &x)) / pivot.length;
            }
        }
        if consistent {
            Solution::Regular(x)
        } else {
            Solution::Inconsistent(unit_length(x))
        }
    }
}

/// One step of the orthogonalisation: the column, its length, the value found for it, and the parts of the columns
/// after it along its direction.
#[derive(Clone, Copy)]
struct Pivot {
    index: usize,
    length: f32,
    value: f32,
    parts: [f32; 4],
}

const NO_PIVOT: Pivot = Pivot {
    index: 4,
    length: 1.0,
    value: 0.0,
    parts: [0.0; 4],
};

/// 0, without the optimiser knowing: it would call a routine that clears blocks of memory, which images need not link.
#[inline(always)]
pub(crate) fn unknown_zero() -> f32 {
    black_box(0.0)
}

#[inline(always)]
fn dot(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// `v` divided by its largest component.
fn unit_length(v: [f32; 4]) -> [f32; 4] {
    let largest = v
        .iter()
        .fold(0.0, |most: f32, v| if v.abs() > most { v.abs() } else { most });
    if largest > 0.0 { v.map(|v| v / largest) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gram(vectors: &[[f32; 4]]) -> Gram {
        let mut gram = Gram::new();
        for vector in vectors {
            gram.add(*vector);
        }
        gram
    }

    /// `J x`.
    fn times(vectors: &[[f32; 4]], x: [f32; 4]) -> [f32; 4] {
        let mut product = [0.0; 4];
        for g in vectors {
            let along: f32 = g.iter().zip(x).map(|(g, x)| g * x).sum();
            for (product, g) in product.iter_mut().zip(g) {
                *product += g * along;
            }
        }
        product
    }

    #[test]
    fn solves_a_regular_system() {
        let vectors = [
            [2.0, 1.0, 0.0, 0.5],
            [1.0, -1.0, 0.2, 0.0],
            [0.0, 0.2, 2.0, 0.1],
            [0.5, 0.0, 0.1, 1.0],
            [0.3, 0.4, -0.1, 0.2],
        ];
        let expected = [1.0, -2.0, 3.0, -4.0];
        let Solution::Regular(x) = gram(&vectors).solve(times(&vectors, expected), || 0.0) else {
            panic!("regular")
        };
        for (x, expected) in x.into_iter().zip(expected) {
            assert!((x - expected).abs() < 1e-4, "{x} {expected}");
        }
    }

    #[test]
    fn tells_directions_apart_that_the_squares_do_not() {
        let vectors = [[1.0, 0.0, 0.0, 0.0], [1.0, 1e-4, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let b = [0.0, 1e-4, 0.0, 0.0];
        let Solution::Regular(x) = gram(&vectors).solve(b, || 0.0) else {
            panic!("regular")
        };
        // The efforts x g are what counts: -1 and 1.
        let effort = |g: [f32; 4]| g.iter().zip(x).map(|(g, x)| g * x).sum::<f32>();
        assert!((effort(vectors[0]) + 1.0).abs() < 2e-3, "{x:?}");
        assert!((effort(vectors[1]) - 1.0).abs() < 2e-3, "{x:?}");
    }

    #[test]
    fn a_singular_system_gives_a_solution_or_a_direction() {
        let vectors = [[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 2.0]];
        let b = [3.0, 3.0, 1.0, 2.0];
        let Solution::Regular(x) = gram(&vectors).solve(b, || 0.0) else {
            panic!("consistent")
        };
        assert_eq!(times(&vectors, x), b);
        let b = [1.0, 0.0, 0.0, 0.0];
        let Solution::Inconsistent(v) = gram(&vectors).solve(b, || 0.0) else {
            panic!("inconsistent")
        };
        assert_eq!(times(&vectors, v), [0.0; 4]);
        assert!(v[0] > 0.0);
    }

    #[test]
    fn a_short_way_out_of_the_range_is_told_from_rounding_errors() {
        let vectors = [[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 2.0]];
        let b = [1e-6, 0.0, 0.0, 0.0];
        assert!(matches!(
            gram(&vectors).solve(b, || 0.0),
            Solution::Inconsistent(_)
        ));
        assert!(matches!(gram(&vectors).solve(b, || 1.0), Solution::Regular(_)));
    }
}
