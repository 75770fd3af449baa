//! Symmetric positive semidefinite systems of at most four unknowns, singular ones included.

/// A pivot below this share of the unit diagonal counts as zero. Measured: from 3e-6 to 3e-5 a few in a thousand
/// saturated requests on random frames miss the optimum, with smaller ones the steps are so long that rounding turns
/// the wrench.
const LEAST_PIVOT: f32 = 1e-5;

/// A right-hand side that misses the range of J by less than this share of itself, plus [`ROUNDING`], counts as
/// within it.
const CONSISTENT: f32 = 1e-5;

/// Rounding errors of a right-hand side of order one.
const ROUNDING: f32 = 1e-5;

/// What a singular system has instead of a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Solution {
    /// `x` with `J x = b`.
    Regular([f32; 4]),
    /// There is none: `v` with `J v = 0` and `v b > 0`.
    Inconsistent([f32; 4]),
}

/// Solves `J x = b + c` for symmetric positive semidefinite `J` by Gauss-Jordan elimination with diagonal pivots.
/// The largest diagonal first, every factor is at most one, so rounding errors do not grow. Where `J` is singular
/// and `b` in its range the unknowns without a pivot are zero, and what is outside the range of the small
/// correction `c` is dropped. The second value is the smallest pivot.
pub(crate) fn solve(mut j: [[f32; 4]; 4], mut b: [f32; 4], mut c: [f32; 4]) -> (Solution, f32) {
    let outside = CONSISTENT * largest(b) + ROUNDING;
    let mut used = [false; 4];
    let mut least = 1.0;
    for _ in 0..4 {
        let mut pivot = (LEAST_PIVOT, None);
        for (index, (row, used)) in j.iter().zip(used).enumerate() {
            let diagonal = row.get(index).copied().unwrap_or(0.0);
            if !used && diagonal > pivot.0 {
                pivot = (diagonal, Some((index, *row)));
            }
        }
        let (diagonal, Some((at, pivot_row))) = pivot else {
            break;
        };
        least = diagonal;
        let pivot_b = b.get(at).copied().unwrap_or(0.0);
        let pivot_c = c.get(at).copied().unwrap_or(0.0);
        let rows = j
            .iter_mut()
            .zip(b.iter_mut())
            .zip(c.iter_mut())
            .zip(used.iter_mut());
        for (index, (((row, b), c), used)) in rows.enumerate() {
            if index == at {
                *used = true;
                continue;
            }
            let factor = row.get(at).copied().unwrap_or(0.0) / diagonal;
            for (value, pivot) in row.iter_mut().zip(pivot_row) {
                *value -= factor * pivot;
            }
            *b -= factor * pivot_b;
            *c -= factor * pivot_c;
        }
    }
    let mut residual = [0.0; 4];
    let mut consistent = true;
    for ((residual, b), used) in residual.iter_mut().zip(b).zip(used) {
        if !used && b.abs() > outside {
            *residual = b;
            consistent = false;
        }
    }
    // Rows with a pivot: j_pp x_p + sum over the unknowns without one of j_pq x_q = b_p + c_p, or 0.
    let mut x = [0.0; 4];
    for (index, ((((x, row), b), c), used)) in x.iter_mut().zip(j).zip(b).zip(c).zip(used).enumerate() {
        if !used {
            *x = residual.get(index).copied().unwrap_or(0.0);
            continue;
        }
        let mut rest = if consistent { b + c } else { 0.0 };
        for (coefficient, residual) in row.iter().zip(residual) {
            rest -= coefficient * residual;
        }
        *x = rest / row.get(index).copied().unwrap_or(1.0);
    }
    let solution = if consistent {
        Solution::Regular(x)
    } else {
        Solution::Inconsistent(unit_length(x))
    };
    (solution, least)
}

fn largest(v: [f32; 4]) -> f32 {
    v.iter().fold(
        0.0,
        |largest: f32, v| if v.abs() > largest { v.abs() } else { largest },
    )
}

/// `v` divided by its largest component.
fn unit_length(v: [f32; 4]) -> [f32; 4] {
    let largest = largest(v);
    if largest > 0.0 { v.map(|v| v / largest) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGULAR: [[f32; 4]; 4] = [
        [4.0, 1.0, 0.0, 0.5],
        [1.0, 3.0, 0.2, 0.0],
        [0.0, 0.2, 2.0, 0.1],
        [0.5, 0.0, 0.1, 1.0],
    ];

    fn times(j: &[[f32; 4]; 4], x: [f32; 4]) -> [f32; 4] {
        j.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
    }

    #[test]
    fn solves_a_regular_system() {
        let expected = [1.0, -2.0, 3.0, -4.0];
        let (Solution::Regular(x), _) = solve(REGULAR, times(&REGULAR, expected), [0.0; 4]) else {
            panic!("regular")
        };
        for (x, expected) in x.into_iter().zip(expected) {
            assert!((x - expected).abs() < 1e-5, "{x} {expected}");
        }
    }

    #[test]
    fn a_singular_system_gives_a_solution_or_a_direction() {
        // a a^T + b b^T with a = (1, 1, 0, 0), b = (0, 0, 1, 2)
        let j = [
            [1.0, 1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 2.0],
            [0.0, 0.0, 2.0, 4.0],
        ];
        let b = [3.0, 3.0, 1.0, 2.0];
        let (Solution::Regular(x), _) = solve(j, b, [0.0; 4]) else {
            panic!("consistent")
        };
        assert_eq!(times(&j, x), b);
        let b = [1.0, 0.0, 0.0, 0.0];
        let (Solution::Inconsistent(v), _) = solve(j, b, [0.0; 4]) else {
            panic!("inconsistent")
        };
        assert_eq!(times(&j, v), [0.0; 4]);
        assert!(v[0] > 0.0);
    }
}
