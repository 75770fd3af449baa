//! Tables with their seams, and what a linear model misses, against exact rational arithmetic.

use mixer_rt::{Scalar, TableSeed};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};

use super::bend::Bend;
use super::enclosure_tests::{exact, numbers};
use super::expansion::{Expansion, Monomials};
use super::taylor::Taylor;
use crate::airframe::Basis;

fn small(n: i64) -> BigRational {
    BigRational::from_integer(n.into())
}

/// Bilinear interpolation between the knots, in exact arithmetic.
fn interpolated(table: &TableSeed, place: [&BigRational; 2], k: usize) -> BigRational {
    let cell = place.map(|x| x.floor().to_integer().to_i64().unwrap_or(0).clamp(0, 2));
    let [i, j] = cell.map(|index| index as usize);
    let [a, b] = [0, 1].map(|axis: usize| place[axis] - small(cell[axis]));
    let knot = |i: usize, j: usize| exact(f64::from(table.knots[i][j][k]));
    let mix = |from: BigRational, to: BigRational, share: &BigRational| &from + (to - &from) * share;
    let along = |j: usize| mix(knot(i, j), knot(i + 1, j), &a);
    mix(along(j), along(j + 1), &b)
}

/// Places in and around the table, cells over several seams included: the exact value within the enclosure, the f32
/// result within the error bound, and near the bound often enough that it is of use.
#[test]
fn tables_are_enclosed_across_their_seams() {
    let mut next = numbers();
    let mut tightest = [0.0f64; 2];
    let mut seams = 0;
    for round in 0..3000 {
        let table = TableSeed {
            offset: [0.0; 2],
            knots: std::array::from_fn(|_| std::array::from_fn(|_| [next() as f32, next() as f32])),
        };
        let centre = [0, 1].map(|_| 1.5 + 1.9 * next());
        let half = if round % 3 == 0 { 1.2 } else { 0.05 };
        let slope = 0.3 * half;
        let cell = |k: usize| {
            let own = Taylor::coordinate(centre[k], half, k == 1);
            own.plus(&Taylor::coordinate(0.0, slope, k == 0))
        };
        let places = [0, 1].map(cell);
        let at = [next(), next()].map(|x| (x * 64.0).round() / 64.0);
        let truth = [0, 1]
            .map(|k: usize| exact(centre[k]) + exact(half) * exact(at[k]) + exact(slope) * exact(at[1 - k]));
        // What the runtime has in place of the truth: its rounding is the error so far.
        let computed = [0, 1].map(|k: usize| truth[k].to_f64().unwrap() as f32);
        let error = 3e-7;
        let enclosed = Taylor::interpolate(&table, places.map(|place| place.with_error(error)));
        let found = table.at(computed);
        for k in 0..2 {
            let exactly = interpolated(&table, [&truth[0], &truth[1]], k);
            let [c, ca, cb, caa, cab, cbb] = enclosed[k].coefficients().map(exact);
            let [a, b] = at.map(exact);
            let value = c + ca * &a + cb * &b + caa * &a * &a + cab * &a * &b + cbb * &b * &b;
            let off = (&exactly - value).abs();
            assert!(
                off <= exact(enclosed[k].remainder()),
                "{round}: {off} {enclosed:?}"
            );
            let wrong = (exact(f64::from(found[k])) - exactly).abs();
            assert!(
                wrong <= exact(enclosed[k].error()),
                "{round}: {wrong} {enclosed:?}"
            );
            if enclosed[k].remainder() > 1e-9 {
                seams += 1;
                tightest[0] = tightest[0].max(off.to_f64().unwrap() / enclosed[k].remainder());
            }
            tightest[1] = tightest[1].max(wrong.to_f64().unwrap() / enclosed[k].error());
        }
    }
    assert!(seams > 1000, "{seams}");
    assert!(tightest[0] > 0.5 && tightest[1] > 0.1, "{tightest:?}");
}

/// G(t; v) = F(t + v) - F(t) - J(t) v, small steps (bounds of the second derivatives) and large ones (functions).
#[test]
fn what_a_linear_model_misses_is_enclosed() {
    let mut next = numbers();
    let power = |x: &BigRational, exponent: u8| (0..exponent).fold(small(1), |product, _| product * x);
    let mut functions = 0;
    for basis in Basis::ALL {
        for round in 0..60 {
            let terms: [Vec<f64>; 2] =
                [10.0, 0.1].map(|size| basis.exponents().iter().map(|_| size * next()).collect());
            let centre = [0.5 + 0.3 * next(), 0.5 + 0.3 * next()];
            let width = if round % 2 == 0 { 2e-4 } else { 0.02 };
            let half = [width * (1.0 + next()), width * (1.0 + next())];
            let expansions =
                [0, 1].map(|k: usize| Expansion::new(&Monomials::new(basis, &terms[k]), centre, half));
            let size = if round % 2 == 0 { 1e-3 } else { 0.1 };
            let mut function = |size: f64| {
                let coefficients = [size * next(), 0.1 * size * next(), 0.1 * size * next()];
                let [c, a, b] = coefficients;
                (Taylor::new([c, a, b, 0.0, 0.0, 0.0], 0.0), coefficients)
            };
            let [d, v] = [size, size].map(|size| [function(size), function(size)]);
            let bend = Bend::new(&expansions, half, &[d[0].0, d[1].0]);
            functions += u32::from(matches!(bend, Bend::Functions(_)));
            let remainders = bend.remainders(&[v[0].0, v[1].0]);

            let at = [next(), next()].map(exact);
            let value = |[c, a, b]: [f64; 3]| exact(c) + exact(a) * &at[0] + exact(b) * &at[1];
            let t = [0, 1].map(|k: usize| exact(centre[k]) + exact(half[k]) * &at[k] + value(d[k].1));
            let step = [0, 1].map(|k: usize| value(v[k].1));
            let after = [0, 1].map(|k: usize| &t[k] + &step[k]);
            for k in 0..2 {
                let mut missed = small(0);
                for (&(i, j), &term) in basis.exponents().iter().zip(&terms[k]) {
                    let [u, l] = &t;
                    let mut g = power(&after[0], i) * power(&after[1], j) - power(u, i) * power(l, j);
                    if i > 0 {
                        g -= small(i64::from(i)) * power(u, i - 1) * power(l, j) * &step[0];
                    }
                    if j > 0 {
                        g -= small(i64::from(j)) * power(u, i) * power(l, j - 1) * &step[1];
                    }
                    missed += exact(term) * g;
                }
                let [c, ca, cb, caa, cab, cbb] = remainders[k].coefficients().map(exact);
                let [a, b] = &at;
                let value = c + ca * a + cb * b + caa * a * a + cab * a * b + cbb * b * b;
                assert!(
                    (missed - value).abs() <= exact(remainders[k].remainder()),
                    "{basis:?} {round} {remainders:?}"
                );
            }
        }
    }
    assert!(
        (60..150).contains(&functions),
        "both kinds are tested: {functions}"
    );
}
