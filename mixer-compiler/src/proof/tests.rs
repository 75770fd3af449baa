//! The proof against exact arithmetic, against dense sampling, and against sabotage.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

use super::expansion::{Expansion, Monomials};
use super::*;
use crate::airframe::Basis;
use crate::interval::Interval;
use crate::source::Source;
use crate::tables::{InverseTable, SeedTable};
use mixer_rt::{Inverse, Scalar};

/// The float x, exactly.
pub(super) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

/// Numbers in [-1, 1] by a fixed congruential generator.
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

/// Random straight-line programs over random cells, at random points of the cells: values within the enclosures and
/// f32 results within the error bounds, judged in exact rational arithmetic.
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

/// Roots: the square of what is enclosed must enclose the radicand, which exact arithmetic can tell.
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

/// Every derivative that is read from an expansion, against the exact polynomial.
#[test]
fn expansions_enclose_the_polynomial() {
    let mut next = numbers();
    let power = |x: &BigRational, exponent: u8| {
        (0..exponent).fold(BigRational::from(BigInt::from(1)), |product, _| product * x)
    };
    for basis in Basis::ALL {
        for _ in 0..50 {
            let terms: Vec<f64> = basis.exponents().iter().map(|_| 10.0 * next()).collect();
            let centre = [0.5 + 0.4 * next(), 0.5 + 0.4 * next()];
            let half = [0.06 * (1.0 + next()), 0.06 * (1.0 + next())];
            let expansion = Expansion::new(&Monomials::new(basis, &terms), centre, half);
            let at = [next(), next()].map(exact);
            let throttle = [0, 1].map(|k: usize| exact(centre[k]) + exact(half[k]) * &at[k]);
            let sum = |order: [u8; 2]| {
                let mut sum = BigRational::zero();
                for (&(i, j), &term) in basis.exponents().iter().zip(&terms) {
                    if i >= order[0] && j >= order[1] {
                        let factor = if order[0] == 1 { f64::from(i) } else { 1.0 }
                            * if order[1] == 1 { f64::from(j) } else { 1.0 };
                        sum += exact(term)
                            * exact(factor)
                            * power(&throttle[0], i - order[0])
                            * power(&throttle[1], j - order[1]);
                    }
                }
                sum
            };
            let [by_u, by_l] = expansion.gradient();
            for (enclosed, order) in [(expansion.value(), [0, 0]), (by_u, [1, 0]), (by_l, [0, 1])] {
                let (value, remainder) = enclosed.at(&at[0], &at[1]);
                assert!((sum(order) - value).abs() <= remainder, "{basis:?} {order:?}");
            }
        }
    }
}

fn airframe_text(name: &str) -> String {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder.join("..").join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn compiled(text: String) -> crate::Compiled {
    crate::compile(&Source::new("test.toml", text)).unwrap_or_else(|faults| panic!("{faults}"))
}

fn prove_again(compiled: &crate::Compiled, tables: &MixerTables) -> Certificate {
    let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
    let correction = Correction::new(&compiled.airframe, tables.voltage.as_ref());
    let mut observed = compiled.residual;
    prove(
        &compiled.airframe,
        &pair,
        tables,
        &correction,
        &mut observed,
        true,
    )
}

/// Every basis and every kind of evaluator: no residual at any of 40,000 throttles and voltages, as the mixer
/// corrects for them, is above the proven bound, and the bound is not far above the residuals.
#[test]
fn nothing_is_observed_beyond_the_bound() {
    let isae = airframe_text("airframes/isae-x8.toml");
    let loose = |text: &str, method: &str| {
        text.replace("thrust_tolerance_n = 0.01", "thrust_tolerance_n = 3.0")
            .replace(
                "torque_tolerance_nm = 1e-4",
                &format!("torque_tolerance_nm = 0.03\nmethod = {method}"),
            )
    };
    let mut texts: Vec<(String, String)> = crate::airframe::EVALUATORS
        .iter()
        .map(|name| ((*name).to_owned(), loose(&isae, &format!("\"{name}\""))))
        .collect();
    texts.push(("polynomial 5".into(), loose(&isae, "\"polynomial\"\ndegree = 5")));
    for fixture in ["cubic-tilted-x8", "polynomial-x10", "quartic-y6"] {
        texts.push((
            fixture.into(),
            airframe_text(&format!("tests/fixtures/{fixture}.toml")),
        ));
    }
    for (name, text) in texts {
        let compiled = compiled(text);
        let (airframe, tables) = (&compiled.airframe, &compiled.tables);
        let certificate = &compiled.certificate;
        assert!(certificate.agrees(&compiled.residual), "{name}");
        let mut next = numbers();
        let mut worst = [0.0f64; 2];
        let pair = PairMap::new(&airframe.pair, &airframe.throttle);
        let view = tables.view();
        for index in 0..40_000 {
            // Half of the points on the border and close to it.
            let throttles = [0, 1].map(|_| {
                let near = if index % 2 == 0 { 1.0 } else { 1.1 };
                pair.clamp(
                    0.5 * (airframe.throttle.min + airframe.throttle.max)
                        + 0.5 * near * (airframe.throttle.max - airframe.throttle.min) * next(),
                )
            });
            let efforts = pair.efforts(throttles);
            let (k, per) = match (&airframe.voltage, &view.voltage) {
                (Some(voltage), Some(table)) => {
                    let [low, high] = table.range_v;
                    let volts = low + (high - low) * (0.5 + 0.5 * next() as f32);
                    let v = f64::from(volts);
                    (
                        [voltage.thrust_factor(v), voltage.torque_factor(v)],
                        [table.thrust.factor(volts), table.torque.factor(volts)].map(|k| 1.0 / k),
                    )
                }
                _ => ([1.0; 2], [1.0; 2]),
            };
            let asked = [0, 1].map(|m: usize| (k[m] * efforts[m]) as f32 * per[m]);
            let found = (&tables.inverse).throttles(&tables.pair, &tables.throttle, asked);
            for throttle in found {
                assert!(throttle >= tables.throttle.min && throttle <= tables.throttle.max);
            }
            let given = pair.efforts(found.map(f64::from));
            for m in 0..2 {
                worst[m] = worst[m].max(k[m] * (given[m] - efforts[m]).abs());
            }
        }
        for m in 0..2 {
            assert!(
                worst[m] <= certificate.stated[m],
                "{name}: {worst:?} {certificate:?}"
            );
            assert!(certificate.stated[m] <= airframe_tolerance(airframe)[m], "{name}");
        }
        // Rounding, the voltage table's included, is some 2e-5 N: where the bound is well above, it is within a
        // quarter of what was seen.
        let sharp = compiled.residual.efforts[0] > 2e-4;
        let ratio = certificate.over_observed(&compiled.residual);
        assert!(
            !sharp || ratio.iter().all(|&ratio| ratio <= 1.25),
            "{name}: {ratio:?}"
        );
    }
}

fn airframe_tolerance(airframe: &Airframe) -> [f64; 2] {
    [
        airframe.inverse.thrust_tolerance_n,
        airframe.inverse.torque_tolerance_nm,
    ]
}

/// Any bit of any number of the inverse and of the forward map: either the flip changes next to nothing, or the
/// proof fails, and it never claims less than what the flipped tables really do.
#[test]
fn flipped_bits_are_refused_where_they_matter() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    let pair = PairMap::new(&compiled.airframe.pair, &compiled.airframe.throttle);
    let (mut refused, mut harmless) = (0, 0);
    for place in 0..14 {
        for bit in [30, 26, 23, 22, 20, 17, 8, 0] {
            let mut tables = compiled.tables.clone();
            let InverseTable::Seeded {
                coordinates,
                seed: SeedTable::Bilinear(seed),
                ..
            } = &mut tables.inverse
            else {
                panic!("{:?}", tables.inverse)
            };
            let slots = coordinates
                .x
                .iter_mut()
                .chain(&mut coordinates.y)
                .chain(&mut seed.upper)
                .chain(&mut seed.lower);
            let slot = slots.into_iter().nth(place).unwrap();
            *slot = f32::from_bits(slot.to_bits() ^ (1 << bit));
            let certificate = prove_again(&compiled, &tables);
            let observed = Residual::over_set(&pair, &tables);
            if certificate.holds() {
                assert!(
                    certificate.agrees(&observed),
                    "{place} {bit}: {observed:?} {certificate:?}"
                );
                harmless += 1;
            } else {
                refused += 1;
            }
            if bit >= 23 {
                assert!(!certificate.holds(), "{place} {bit}: {certificate:?}");
            }
            if bit == 0 {
                assert!(certificate.holds(), "{place}: {certificate:?}");
            }
        }
    }
    assert!(refused >= 14 * 3 && harmless >= 14, "{refused} {harmless}");
}

/// A Newton step corrects the seed whatever the forward table says of it: a wrong forward table must show.
#[test]
fn a_wrong_forward_map_is_refused() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    for bit in [23, 20, 16] {
        let mut tables = compiled.tables.clone();
        let crate::tables::QuantityTable::Biquadratic(mixer_rt::Biquadratic(terms)) = &mut tables.pair.thrust
        else {
            panic!("{:?}", tables.pair)
        };
        terms[2] = f32::from_bits(terms[2].to_bits() ^ (1 << bit));
        assert!(!prove_again(&compiled, &tables).holds(), "bit {bit}");
    }
}

/// A voltage table that is off must show in full; off by more than the tolerance leaves, it is refused.
#[test]
fn a_wrong_voltage_table_is_refused() {
    let compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    let bound = |factor: f32| {
        let mut tables = compiled.tables.clone();
        let Some(crate::tables::LawTable::Polynomial { coefficients, .. }) =
            tables.voltage.as_mut().map(|voltage| &mut voltage.laws[0])
        else {
            panic!("{:?}", tables.voltage)
        };
        *coefficients.last_mut().unwrap() *= factor;
        prove_again(&compiled, &tables)
    };
    let (right, off, wrong) = (bound(1.0), bound(1.0 + 5e-5), bound(1.001));
    assert!(off.holds() && off.stated[0] > right.stated[0] + 5e-4, "{off:?}");
    assert!(!wrong.holds(), "{wrong:?}");
}

/// Tolerances below what f32 can do are refused with a bound that was proven.
#[test]
fn too_small_a_tolerance_is_refused() {
    let text = airframe_text("airframes/isae-x8.toml").replace("tolerance_n = 0.01", "tolerance_n = 1e-6");
    let faults = crate::compile(&Source::new("test.toml", text)).unwrap_err();
    assert!(faults.to_string().contains("is proven within"), "{faults}");
}

/// Where the map folds, no Newton step can be bounded: the proof itself notices, not only the stage before it.
#[test]
fn a_fold_cannot_be_proven() {
    let mut compiled = compiled(airframe_text("airframes/isae-x8.toml"));
    compiled.airframe.throttle.min = 0.05;
    compiled.tables.throttle.min = 0.05;
    let certificate = prove_again(&compiled, &compiled.tables.clone());
    assert!(!certificate.holds(), "{certificate:?}");
}

/// At a tolerance near rounding level: what the runtime computes of its own throttles is off by no more than it allows
/// for, and it allows for little more.
#[test]
fn delivered_efforts_do_not_look_missed() {
    let text = airframe_text("airframes/isae-x8.toml")
        .replace("tolerance_n = 0.01", "tolerance_n = 3e-5")
        .replace("tolerance_nm = 1e-4", "tolerance_nm = 4e-7");
    let compiled = compiled(text);
    let (airframe, tables) = (&compiled.airframe, &compiled.tables);
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let correction = Correction::new(airframe, tables.voltage.as_ref());
    let stated = airframe_tolerance(airframe);
    let slack = [0, 1].map(|k| f64::from(tables.tolerance.efforts[k]) - stated[k] / correction.largest[k]);
    let mut next = numbers();
    let mut largest = [0.0f64; 2];
    for _ in 0..20_000 {
        let throttles = [0, 1].map(|_| (0.55 + 0.45 * next()) as f32);
        let (computed, exactly) = (
            tables.pair.efforts(throttles),
            pair.efforts(throttles.map(|throttle| pair.clamp(f64::from(throttle)))),
        );
        let asked = exactly.map(|effort| effort as f32);
        for k in 0..2 {
            largest[k] = largest[k].max((f64::from(computed[k]) - f64::from(asked[k])).abs());
        }
    }
    for k in 0..2 {
        assert!(
            largest[k] > 0.05 * slack[k] && largest[k] <= slack[k],
            "{largest:?} {slack:?}"
        );
    }
}
