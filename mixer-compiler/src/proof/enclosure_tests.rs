//! Taylor models and expansions against exact arithmetic.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::expansion::{Expansion, Monomials};
use super::*;
use crate::airframe::Basis;
use crate::bounds::interval::Interval;
use mixer_rt::tables::Scalar;

/// The float x, exactly.
pub(super) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

/// Numbers in [-1, 1) by xorshift64, the same in every run.
pub(super) fn numbers() -> impl FnMut() -> f64 {
    let mut state = 0x2545_f491_4f6c_dd1du64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A function of (a, b) three times over: enclosed, exactly, and in f32 as the runtime computes it.
#[derive(Clone)]
struct Thrice {
    enclosed: Taylor,
    exact: BigRational,
    computed: f32,
}

impl Thrice {
    fn check(&self, a: &BigRational, b: &BigRational, what: &str) {
        let (centre, radius) = self.enclosed.at(a, b);
        let off = (&self.exact - centre).abs();
        assert!(
            off <= radius,
            "{what}: {self:?} is {:?} off",
            off.to_f64(),
            self = self.enclosed
        );
        let error = (exact(f64::from(self.computed)) - &self.exact).abs();
        assert!(
            error <= exact(self.enclosed.error()),
            "{what}: error {:?} > {:?}",
            error.to_f64(),
            self.enclosed.error()
        );
        let range = self.enclosed.range();
        assert!(
            exact(range.low) <= self.exact && self.exact <= exact(range.high),
            "{what}"
        );
    }
}

impl Taylor {
    /// The polynomial part at (a, b), and the remainder.
    fn at(&self, a: &BigRational, b: &BigRational) -> (BigRational, BigRational) {
        let [c, ca, cb, caa, cab, cbb] = self.coefficients().map(exact);
        let value = c + ca * a + cb * b + caa * a * a + cab * a * b + cbb * b * b;
        (value, exact(self.remainder()))
    }
}

/// Random straight-line programs over random cells, at random points of the cells: values within
/// the enclosures and f32 results within the error bounds, judged in exact rational arithmetic.
#[test]
fn taylor_models_enclose_exact_and_f32_results() {
    let mut next = numbers();
    let mut pick = numbers();
    let (mut tightest, mut steps) = (0.0f64, 0);
    for _ in 0..300 {
        // The point is one that f32 can hold, as are the coordinates of the runtime.
        let (a, b) = (
            exact((next() * 64.0).round() / 64.0),
            exact((next() * 64.0).round() / 64.0),
        );
        let half = 1.0 / 64.0;
        let mut stack: Vec<Thrice> = [false, true]
            .into_iter()
            .map(|second| {
                let centre = (next() * 32.0).round() / 32.0 + 2.0;
                let at = exact(centre) + exact(half) * if second { &b } else { &a };
                Thrice {
                    enclosed: Taylor::coordinate(centre, half, second),
                    computed: at.to_f64().unwrap() as f32,
                    exact: at,
                }
            })
            .collect();
        for _ in 0..8 {
            let index = |x: f64| ((x + 1.0) * 0.5 * stack.len() as f64) as usize % stack.len();
            let (x, y) = (stack[index(pick())].clone(), stack[index(pick())].clone());
            let constant = next() as f32;
            let (what, result) = match ((pick() + 1.0) * 4.0) as u32 {
                0 => (
                    "x + y",
                    (
                        x.enclosed + y.enclosed,
                        &x.exact + &y.exact,
                        x.computed + y.computed,
                    ),
                ),
                1 => (
                    "x - y",
                    (
                        x.enclosed - y.enclosed,
                        &x.exact - &y.exact,
                        x.computed - y.computed,
                    ),
                ),
                2 => (
                    "x y",
                    (
                        x.enclosed * y.enclosed,
                        &x.exact * &y.exact,
                        x.computed * y.computed,
                    ),
                ),
                3 => {
                    let exact = &x.exact + exact(f64::from(constant));
                    ("x + c", (x.enclosed + constant, exact, x.computed + constant))
                }
                4 => {
                    let exact = &x.exact * exact(f64::from(constant));
                    ("c x", (x.enclosed * constant, exact, x.computed * constant))
                }
                5 => {
                    let exact = &x.exact / exact(f64::from(constant));
                    ("x / c", (x.enclosed / constant, exact, x.computed / constant))
                }
                _ => {
                    let Interval { low, high } = x.enclosed.range();
                    if low <= 0.0 && high >= 0.0 || x.exact.is_zero() {
                        continue;
                    }
                    (
                        "1 / x",
                        (x.enclosed.reciprocal(), x.exact.recip(), 1.0 / x.computed),
                    )
                }
            };
            let (enclosed, exact, computed) = result;
            if !enclosed.is_bounded() {
                continue;
            }
            let result = Thrice {
                enclosed,
                exact,
                computed,
            };
            result.check(&a, &b, what);
            let error = (f64::from(result.computed) - result.exact.to_f64().unwrap()).abs();
            tightest = tightest.max(error / result.enclosed.error());
            steps += 1;
            stack.push(result);
        }
    }
    // Bounds that are never nearly met would hold by being useless.
    assert!(tightest > 0.5, "{tightest}");
    assert!(steps > 1500, "{steps}");
}

/// Roots: the square of what is enclosed must enclose the radicand, which exact arithmetic can
/// tell.
#[test]
fn roots_are_enclosed() {
    let mut next = numbers();
    for _ in 0..2000 {
        let centre = 0.07 + (next() + 1.0) * 0.6;
        let radicand = Taylor::coordinate(centre, 0.05, false) * Taylor::coordinate(1.0, 0.03, true);
        let root = radicand.root();
        let (a, b) = (exact(next()), exact(next()));
        let truth = (exact(centre) + exact(0.05) * &a) * (exact(1.0) + exact(0.03) * &b);
        let (value, remainder) = root.at(&a, &b);
        let (low, high) = (&value - &remainder, &value + &remainder);
        assert!(low.is_negative() || &low * &low <= truth);
        assert!(&high * &high >= truth);
        assert!(root.range().high - root.range().low < 1.0, "{root:?}");
    }
    // A radicand that may be negative counts as zero.
    let root = Taylor::coordinate(0.01, 0.02, false).root();
    assert!(root.range().low <= 0.0 && root.range().high * root.range().high >= 0.03);
}

/// F(t + v) in full, without F(t), and without what a linear model has of it; steps small and large.
#[test]
fn expansions_enclose_the_polynomial() {
    let mut next = numbers();
    let one = || BigRational::from(BigInt::from(1));
    let power = |x: &BigRational, exponent: u8| (0..exponent).fold(one(), |product, _| product * x);
    for basis in Basis::ALL {
        for round in 0..16 {
            let terms = [10.0, 0.1].map(|size| {
                basis
                    .exponents()
                    .iter()
                    .map(|_| size * next())
                    .collect::<Vec<f64>>()
            });
            let truth = [0, 1].map(|k| Taylor::coordinate(0.5 + 0.3 * next(), 0.02 * (1.0 + next()), k == 1));
            let size = if round % 2 == 0 { 1e-3 } else { 0.1 };
            let v = [0, 1].map(|_| {
                let linear = [size * next(), 0.1 * size * next(), 0.1 * size * next()];
                Taylor::new([linear[0], linear[1], linear[2], 0.0, 0.0, 0.0], 0.0)
            });
            let monomials = terms.each_ref().map(|terms| Monomials::new(basis, terms));
            let expansion = Expansion::new(&monomials, truth.each_ref().map(Taylor::range));
            let [a, b] = [next(), next()].map(exact);
            let [t, step] =
                [&truth, &v].map(|functions| functions.each_ref().map(|function| function.at(&a, &b).0));
            let after = [0, 1].map(|k: usize| &t[k] + &step[k]);
            for least in 0..3 {
                let sums = expansion.sums(&v, least);
                for k in 0..2 {
                    let mut sought = BigRational::zero();
                    for (&(i, j), &term) in basis.exponents().iter().zip(&terms[k]) {
                        let mut value = power(&after[0], i) * power(&after[1], j);
                        if least >= 1 {
                            value -= power(&t[0], i) * power(&t[1], j);
                        }
                        if least == 2 && i > 0 {
                            value -= exact(f64::from(i)) * power(&t[0], i - 1) * power(&t[1], j) * &step[0];
                        }
                        if least == 2 && j > 0 {
                            value -= exact(f64::from(j)) * power(&t[0], i) * power(&t[1], j - 1) * &step[1];
                        }
                        sought += exact(term) * value;
                    }
                    let (value, remainder) = sums[k].at(&a, &b);
                    assert!((sought - value).abs() <= remainder, "{basis:?} {round} {least}");
                }
            }
            for (k, axis) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                // The largest slope is no less than that of any point.
                let mut slope = BigRational::zero();
                for (&(i, j), &term) in basis.exponents().iter().zip(&terms[k]) {
                    let exponents = [i, j];
                    if exponents[axis] > 0 {
                        let mut lowered = exponents;
                        lowered[axis] -= 1;
                        slope += exact(term)
                            * exact(f64::from(exponents[axis]))
                            * power(&t[0], lowered[0])
                            * power(&t[1], lowered[1]);
                    }
                }
                assert!(
                    slope.abs() <= exact(expansion.along(k, axis, 1)),
                    "{basis:?} {round}"
                );
            }
        }
    }
}
