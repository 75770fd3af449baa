//! The remainder of a linear model, against exact rational arithmetic.

use num_rational::BigRational;
use num_traits::Signed;

use super::bend::Bend;
use super::enclosure_tests::{exact, numbers};
use super::expansion::{Expansion, Monomials};
use super::taylor::Taylor;
use crate::airframe::Basis;

fn small(n: i64) -> BigRational {
    BigRational::from_integer(n.into())
}

/// G(t; v) = F(t + v) - F(t) - J(t) v, small steps (bounds of the second derivatives) and large
/// ones (functions).
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
