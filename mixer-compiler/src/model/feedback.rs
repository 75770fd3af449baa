//! A bound of what least norm misses on a frame with single rotors, after all its passes.
//!
//! M+ takes kappa f for the torque of a single rotor, which is Q(f). With a the wrench that M+ is given, in newtons
//! and newton metres over k_f, p a row of M+, B a column of M and r = k_Q / k_f, a pass is
//!
//! ```text
//! a  <-  w - sum B (r Q(p a) - kappa p a)          from a = w
//! ```
//!
//! over the single rotors. At its fixed point a* the efforts M+ a* of the pairs and p a*, Q(p a*) of the single rotors
//! give w. On the way there
//!
//! ```text
//! |a - a*|  <=  sum |B| max |r Q - kappa f|                               at first
//! |a - a*|  <=  sum |B| (max |r dQ/df - kappa| |p| |a - a*| + r e)        after each pass
//! ```
//!
//! A pass moves the throttle t of every single rotor by the step d to where the parabola of its thrust f at t has the
//! thrust asked, and takes that of its torque there. f and Q are cubics, so that these differ by a3 d^3 and b3 d^3. A
//! parabola without the thrust asked, which lies `off` from f(t), is followed to d = 2 off / f', which misses
//! |off| (-1 - 4 off f'' / 2 f'^2) more. What the parabola lacks of the thrust, also by the ends of the range, has torque in
//! proportion to it by the slope dQ/df at t. So d is at most the greatest distance of two throttles whose thrusts are as far
//! apart as those before and after the step. All bounds are enclosed over parts of the throttle range in interval
//! arithmetic. A frame has as many passes as its file's tolerances need. Rounding in f32 comes on top, where the tolerances
//! are made.

use super::effectiveness::Effectiveness;
use super::law;
use crate::airframe::single_rotor::torque_per_thrust;
use crate::airframe::{Airframe, RotorAlone};
use crate::bounds::interval::Interval;
use crate::diagnostic::{Code, Diagnostic, number, rounded_up};

/// Parts of the throttle range over which a curve is enclosed.
const PARTS: usize = 256;

/// Most passes that a frame may have.
const MOST_PASSES: u8 = 8;

/// Errors that are left after all passes, at the reference voltage.
#[derive(Clone, Debug)]
pub(crate) struct Feedback {
    /// Passes over the single rotors.
    pub(crate) passes: u8,
    /// Of each unit's efforts at the fixed point, N and N m, beside what the inverse of a pair misses.
    pub(crate) missed: Vec<[f64; 2]>,
    /// Of the thrust that a single rotor is asked for last, N.
    pub(crate) thrust_n: f64,
    /// Of any unit under all conditions with what the inverse of a pair misses, N and N m.
    pub(crate) stated: [f64; 2],
}

/// Bounds over a part of a curve.
struct Part {
    /// Least and largest thrust, N.
    thrust_n: [f64; 2],
    /// min f', N.
    rise: f64,
    /// f'' / 2, N.
    half: Interval,
}

/// Bounds along a curve.
struct Curve {
    parts: Vec<Part>,
    /// Of a part, 1.
    width: f64,
    /// From the thrust at which the first pass begins to the one asked, N.
    start: f64,
    /// |a3|, N, and max |a3 dQ/df - b3|, N m.
    remainder: [f64; 2],
    /// dQ/df, m.
    slope: Interval,
    /// max |r Q - kappa f|, N m.
    deviation: f64,
    /// max |r dQ/df - kappa|, m.
    lipschitz: f64,
    /// |p|, N per N m and N over k_f, and |B|.
    allocation: [f64; 4],
    effect: [f64; 4],
}

impl Curve {
    fn new(
        curve: &RotorAlone,
        [low, high]: [f64; 2],
        ratio: Interval,
        kappa: f64,
        [allocation, effect]: [[f64; 4]; 2],
    ) -> Self {
        let horner = |terms: [f64; 3], x: Interval| {
            let of = |sum: Interval, term: f64| sum * x + Interval::exact(term);
            terms.into_iter().fold(Interval::ZERO, of)
        };
        let thrust = |t: f64| curve.efforts(t)[0];
        let begins = |t: f64| (high * (thrust(t) / thrust(high)).max(0.0).sqrt()).clamp(low, high);
        let kappa = Interval::exact(kappa);
        let (mut start, mut deviation) = (0.0f64, 0.0f64);
        let mut slope = Interval {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        let width = (high - low) / PARTS as f64;
        let part = |k: usize| {
            let [from, to] = [k, k + 1].map(|k| low + width * k as f64);
            let x = Interval { low: from, high: to };
            let terms = [curve.thrust_n, curve.torque_nm];
            let [f, q] = terms.map(|[a1, a2, a3]| horner([a3, a2, a1], x) * x);
            let [by_f, by_q] = [0, 1].map(|k| {
                let [from, to] = [from, to].map(|t| curve.slopes(t)[k]);
                let bend =
                    Interval { low: -1.0, high: 1.0 } * Interval::exact(0.75 * terms[k][2] * width * width);
                Interval {
                    low: from.min(to),
                    high: from.max(to),
                } + bend
            });
            let own = by_q
                * Interval {
                    low: 1.0 / by_f.high,
                    high: 1.0 / by_f.low.max(0.0),
                };
            slope.low = slope.low.min(own.low);
            slope.high = slope.high.max(own.high);
            deviation = deviation.max((ratio * q - kappa * f).magnitude());
            // Both the curve and where the first pass begins rise.
            start = start
                .max(thrust(begins(to)) - thrust(from))
                .max(thrust(to) - thrust(begins(from)));
            let [_, a2, a3] = curve.thrust_n;
            Part {
                thrust_n: [thrust(from), thrust(to)],
                rise: by_f.low,
                half: horner([0.0, 3.0 * a3, a2], x),
            }
        };
        let parts = (0..PARTS).map(part).collect();
        let [a3, b3] = [curve.thrust_n[2], curve.torque_nm[2]];
        Curve {
            parts,
            width,
            start,
            remainder: [
                a3.abs(),
                (Interval::exact(a3) * slope - Interval::exact(b3)).magnitude(),
            ],
            slope,
            deviation,
            lipschitz: (ratio * slope - kappa).magnitude(),
            allocation,
            effect,
        }
    }

    /// The most that two throttles are apart whose thrusts are `thrust_n` apart.
    fn apart(&self, thrust_n: f64) -> f64 {
        let last = |part: &Part| {
            let most = part.thrust_n[1] + thrust_n;
            self.parts.partition_point(|part| part.thrust_n[0] <= most)
        };
        let count = self.parts.iter().enumerate().map(|(k, part)| last(part) - k);
        count.max().unwrap_or(0) as f64 * self.width
    }

    /// A step from thrusts that are at most `off` N from the ones asked, or from the nearest ones: what is missed of these,
    /// N, and of their torques, N m.
    fn step(&self, off: f64) -> [f64; 2] {
        let (mut short, ends) = (0.0f64, [0, PARTS - 1].map(|k| self.parts[k].thrust_n));
        for part in &self.parts {
            let off = Interval {
                low: (-off).max(ends[0][0] - part.thrust_n[1]),
                high: off.min(ends[1][1] - part.thrust_n[0]),
            };
            let share = -1.0 - 4.0 * (part.half * off).low / (part.rise * part.rise);
            short = short.max(off.magnitude() * share);
        }
        let [of_thrust, of_torque] = self.remainder;
        let cube = |step: f64| step * step * step;
        let missed = |step: f64| short + of_thrust * cube(step);
        let mut step = 0.0;
        loop {
            let next = self.apart(off + missed(step));
            if next <= step {
                break;
            }
            step = next;
        }
        let spread = self.slope.high - self.slope.low;
        [missed(step), of_torque * cube(step) + spread * missed(step)]
    }

    /// The thrust that an error of the wrench moves, N.
    fn moved(&self, error: &[f64; 4]) -> f64 {
        moved(&self.allocation, error)
    }
}

/// What an error of the wrench moves by a row |p| of M+.
fn moved(row: &[f64; 4], error: &[f64; 4]) -> f64 {
    row.iter().zip(error).map(|(share, error)| share * error).sum()
}

/// Largest errors of any unit under all conditions, N and N m, of what the units miss beside the inverses of pairs, which
/// miss `of_pairs`.
fn with_pairs(airframe: &Airframe, missed: &[[f64; 2]], of_pairs: [f64; 2]) -> [f64; 2] {
    let factors = law::largest_factors(airframe);
    let units = || airframe.units.iter().zip(missed);
    [0, 1].map(|k| {
        units().fold(0.0, |most: f64, (unit, missed)| {
            let own = if unit.lower_channel.is_some() {
                of_pairs[k]
            } else {
                0.0
            };
            most.max(own + factors[k] * missed[k])
        })
    })
}

impl Feedback {
    /// Of an airframe with single rotors or without, where the inverses of pairs miss `of_pairs` at most under all
    /// conditions, N and N m.
    pub(crate) fn new(airframe: &Airframe, effectiveness: &Effectiveness, of_pairs: [f64; 2]) -> Feedback {
        let n = airframe.units.len();
        let [low, high] = law::torque_over_thrust(airframe);
        let ratio = Interval { low, high };
        let range = [airframe.throttle.min, airframe.throttle.max];
        let row = |i: usize| -> [f64; 4] {
            std::array::from_fn(|axis| effectiveness.pseudo_inverse[(i, axis)].abs())
        };
        let column =
            |i: usize| -> [f64; 4] { std::array::from_fn(|axis| effectiveness.matrix[(axis, i)].abs()) };
        let curves: Vec<Option<Curve>> = (airframe.units.iter().enumerate())
            .map(|(i, unit)| {
                let curve = airframe.curve_of(unit)?;
                let kappa = torque_per_thrust(curve, &airframe.throttle);
                Some(Curve::new(curve, range, ratio, kappa, [row(i), column(n + i)]))
            })
            .collect();
        let single = || curves.iter().flatten();
        let sum = |of: &dyn Fn(usize, &Curve) -> f64| -> [f64; 4] {
            let mut sum = [0.0; 4];
            for (i, curve) in single().enumerate() {
                let size = of(i, curve);
                for (sum, effect) in sum.iter_mut().zip(curve.effect) {
                    *sum += effect * size;
                }
            }
            sum
        };
        // |a - a*| before a pass and before the one before it, and what the throttles miss of the thrusts.
        let mut error = sum(&|_, curve| curve.deviation);
        let mut before = error;
        let mut thrusts: Vec<f64> = single().map(|curve| curve.start).collect();
        let mut passes = 0;
        loop {
            let mut torques = Vec::new();
            for (missed, curve) in thrusts.iter_mut().zip(single()) {
                if passes > 0 {
                    *missed += curve.moved(&error) + curve.moved(&before);
                }
                let torque;
                [*missed, torque] = curve.step(*missed);
                torques.push(high * torque);
            }
            let next = sum(&|i, curve| curve.lipschitz * curve.moved(&error) + torques[i]);
            (before, error) = (error, next);
            passes += 1;
            let mut left = thrusts.iter();
            let mut thrust_n = 0.0f64;
            let missed = curves.iter().enumerate().map(|(i, curve)| {
                let Some(curve) = curve else {
                    let of = |row: [f64; 4]| moved(&row, &error);
                    return [of(row(i)), of(row(n + i)) / low];
                };
                let own = left.next().copied().unwrap_or_default() + curve.moved(&before);
                thrust_n = thrust_n.max(own + curve.moved(&error));
                [own, curve.slope.magnitude() * own]
            });
            let missed: Vec<[f64; 2]> = missed.collect();
            let stated = with_pairs(airframe, &missed, of_pairs);
            let feedback = Feedback {
                passes,
                missed,
                thrust_n,
                stated,
            };
            if passes == MOST_PASSES || feedback.excess(airframe).is_none() {
                return feedback;
            }
        }
    }

    /// Largest errors of any unit under all conditions, N and N m, where they are beyond the file's tolerances.
    fn excess(&self, airframe: &Airframe) -> Option<[f64; 2]> {
        let allowed = airframe.inverse.tolerances();
        let [thrust, torque] = self.stated;
        let asked = law::largest_factors(airframe)[0] * self.thrust_n;
        let left = [thrust.max(asked), torque];
        (0..2).any(|k| left[k] > allowed[k]).then_some(left)
    }

    /// Refuses single rotors whose torque the passes do not follow.
    ///
    /// # Errors
    /// An error beyond the file's tolerance.
    pub(crate) fn check(&self, airframe: &Airframe) -> Result<(), Vec<Diagnostic>> {
        let Some(left) = self.excess(airframe) else {
            return Ok(());
        };
        let allowed = airframe.inverse.tolerances();
        let [f, q] = left.map(rounded_up);
        Err(vec![airframe.diagnostic(
            Code::Tolerance,
            "rotor",
            format!("the torques of the single rotors are followed within {f} N and {q} N m alone"),
            format!("{} N and {} N m are allowed", number(allowed[0]), number(allowed[1])),
            "their torque over thrust changes much over the throttle range: check the coefficients, raise throttle.min, or \
             raise the tolerances of [inverse]",
        )])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;
    use crate::airframe::single_rotor::throttle_of;

    fn airframe(name: &str, exponents: [f64; 2]) -> Airframe {
        let path = format!("{}/airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut text = std::fs::read_to_string(path).unwrap();
        for (quantity, exponent) in ["thrust", "torque"].iter().zip(exponents) {
            let key = format!("{quantity}_exponent = ");
            text = text.replace(&format!("{key}1.75"), &format!("{key}{exponent}"));
        }
        Airframe::read(&Source::new(name, text)).unwrap()
    }

    /// Numbers drawn from 0 to 1.
    fn shares(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// A step in f64 from a throttle to a thrust, N, as in the runtime: the throttle, and the torque along the parabola.
    fn parabola(curve: &RotorAlone, at: f64, thrust_n: f64, range: [f64; 2]) -> [f64; 2] {
        let (given, slopes) = (curve.efforts(at), curve.slopes(at));
        let half = [curve.thrust_n, curve.torque_nm].map(|[_, a2, a3]| a2 + 3.0 * a3 * at);
        let off = thrust_n - given[0];
        let root = (slopes[0] * slopes[0] + 4.0 * half[0] * off).max(0.0).sqrt();
        let next = (at + 2.0 * off / (slopes[0] + root)).clamp(range[0], range[1]);
        let step = next - at;
        let [reached, torque] = [0, 1].map(|k| given[k] + (half[k] * step + slopes[k]) * step);
        [next, torque + slopes[1] / slopes[0] * (thrust_n - reached)]
    }

    /// Steps in f64 between throttles drawn, along curves drawn: concave and convex ones, flat at idle.
    #[test]
    fn steps_miss_no_more_than_is_bound() {
        let mut share = shares(5);
        let range = [0.02, 1.0];
        let (mut curves, mut closest) = (0, 0.0f64);
        while curves < 200 {
            let mut cubic = |size: f64| -> [f64; 3] {
                let (linear, bend) = (0.3 * share() - 0.02, 1.6 * share() - 0.6);
                [linear, 1.0 - linear - bend, bend].map(|term| size * term)
            };
            let rotor = RotorAlone {
                thrust_n: cubic(15.0),
                torque_nm: cubic(0.3),
            };
            let rise = |part| rotor.slopes(0.02 + 0.0098 * f64::from(part))[0];
            if !(0..=100).all(|part| rise(part) > 0.01) {
                continue;
            }
            curves += 1;
            let curve = Curve::new(&rotor, range, Interval::exact(1.0), 0.02, [[0.0; 4]; 2]);
            for _ in 0..500 {
                let at = range[0] + (range[1] - range[0]) * share();
                let to = (at + 0.4 * (2.0 * share() - 1.0)).clamp(range[0], range[1]);
                let off = rotor.efforts(to)[0] - rotor.efforts(at)[0];
                let [next, torque] = parabola(&rotor, at, rotor.efforts(to)[0], range);
                let missed = [
                    rotor.efforts(next)[0] - rotor.efforts(to)[0],
                    torque - rotor.efforts(to)[1],
                ];
                let bound = curve.step(off.abs());
                for k in 0..2 {
                    assert!(
                        missed[k].abs() <= bound[k] + 1e-12,
                        "{missed:?} {bound:?} {rotor:?}"
                    );
                    closest = closest.max(missed[k].abs() / bound[k]);
                }
            }
        }
        assert!(closest > 0.1, "{closest}");
    }

    /// The passes in f64 from the wrench of throttles, against the efforts of these throttles.
    #[test]
    fn passes_miss_no_more_than_is_bound() {
        let mut share = shares(9);
        let mut closest = 0.0f64;
        for (name, exponents) in [
            ("y4", [1.75, 1.75]),
            ("hexa-stacked", [1.75, 1.75]),
            ("hexa-stacked", [1.6, 1.9]),
        ] {
            let airframe = airframe(name, exponents);
            let effectiveness = Effectiveness::new(&airframe).unwrap();
            let bound = Feedback::new(&airframe, &effectiveness, [0.0; 2]);
            let n = airframe.units.len();
            let range = [airframe.throttle.min, airframe.throttle.max];
            let (row, column) = (&effectiveness.pseudo_inverse, &effectiveness.matrix);
            let dot = |i: usize, a: &[f64; 4]| (0..4).map(|axis| row[(i, axis)] * a[axis]).sum::<f64>();
            let singles: Vec<(usize, &RotorAlone)> = (0..n)
                .filter_map(|i| Some((i, airframe.curve_of(&airframe.units[i])?)))
                .collect();
            let volts = airframe.voltage.as_ref().unwrap().range;
            for _ in 0..2000 {
                let factors = airframe.factors(volts[0] + share() * (volts[1] - volts[0]), 0.0);
                let ratio = factors[1] / factors[0];
                // A fixed point: any wrench over k_f whose thrusts are within the range of the single rotors.
                let size = [2.0, 2.0, 0.2, 60.0];
                let fixed: [f64; 4] = std::array::from_fn(|axis| {
                    let part = share();
                    size[axis] * if axis < 3 { 2.0 * part - 1.0 } else { 0.6 + part }
                });
                let is_within = |(i, curve): &(usize, &RotorAlone)| {
                    let f = dot(*i, &fixed);
                    (curve.efforts(range[0])[0]..=curve.efforts(range[1])[0]).contains(&f)
                };
                if !singles.iter().all(is_within) {
                    continue;
                }
                let wrench: [f64; 4] = std::array::from_fn(|axis| {
                    let off = singles.iter().map(|(i, curve)| {
                        let torque =
                            curve.efforts(throttle_of(curve, &airframe.throttle, dot(*i, &fixed)))[1];
                        column[(axis, n + i)] * (ratio * torque - dot(n + i, &fixed))
                    });
                    fixed[axis] + off.sum::<f64>()
                });
                let mut asked = wrench;
                let mut throttles: Vec<f64> = Vec::new();
                for pass in 0..bound.passes {
                    let mut next = wrench;
                    for (k, (i, curve)) in singles.iter().enumerate() {
                        let f = dot(*i, &asked);
                        if pass == 0 {
                            let share = (f / curve.efforts(range[1])[0]).clamp(0.0, 1.0);
                            throttles.push((range[1] * share.sqrt()).clamp(range[0], range[1]));
                        }
                        let torque;
                        [throttles[k], torque] = parabola(curve, throttles[k], f, range);
                        for (axis, next) in next.iter_mut().enumerate() {
                            *next -= column[(axis, n + i)] * (ratio * torque - dot(n + i, &asked));
                        }
                    }
                    asked = next;
                }
                for (k, (i, curve)) in singles.iter().enumerate() {
                    let (given, wanted) = (curve.efforts(throttles[k])[0], dot(*i, &fixed));
                    assert!((given - wanted).abs() <= bound.missed[*i][0] + 1e-12, "{name}");
                    assert!(
                        (given - dot(*i, &asked)).abs() <= bound.thrust_n + 1e-12,
                        "{name}"
                    );
                    closest = closest.max((given - wanted).abs() / bound.missed[*i][0]);
                }
                for i in (0..n).filter(|i| airframe.units[*i].lower_channel.is_some()) {
                    let off = (dot(i, &asked) - dot(i, &fixed)).abs();
                    assert!(off <= bound.missed[i][0] + 1e-12, "{name}");
                }
            }
        }
        // Not a bound that holds for being far off.
        assert!(closest > 1e-3, "{closest}");
    }
}
