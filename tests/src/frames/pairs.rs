//! Pairs of rotors for the zoo. Coefficients at random fold nearly always, so each pair is made of
//! those that benches gave: mixed, scaled, altered a little, over other throttles. The build script
//! of `tests/firmware` includes this file.

use mixer_compiler::Source;
use mixer_compiler::airframe::{Airframe, Basis};
use mixer_compiler::model::injectivity::EnclosedPairMap;
use mixer_setpoints::Random;

/// Thrust (N) and torque (N m) of one rotor alone: coefficients of x, x² and x³.
type Alone = [[f64; 3]; 2];

/// A pair of rotors.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Terms of both polynomials.
    pub basis: Basis,
    /// Coefficients of thrust (N) and of torque (N m).
    pub coefficients: [Vec<f64>; 2],
    /// Least and largest throttle.
    pub throttle: [f64; 2],
    /// What is left without the lower and without the upper rotor, where the file says it.
    pub alone: Option<[Alone; 2]>,
}

/// The idle above the least one without a fold, as a factor: closer to the fold no evaluator of the
/// inverse is exact enough.
const ABOVE_FOLD: f64 = 1.03;

/// Least idle and least range of throttle that are drawn.
const LEAST_IDLE: f64 = 0.02;
const LEAST_RANGE: f64 = 0.15;

/// Full thrust of a pair, N: from a toy to a crewed vehicle.
const THRUSTS_N: [f64; 2] = [1.0, 3000.0];

/// Largest relative change of a coefficient.
const CHANGE: f64 = 0.02;

/// Draws before a real pair is taken as it is.
const ATTEMPTS: usize = 8;

impl Pair {
    /// Whether an airframe file has one pair: several are those of other files.
    pub fn is_alone(source: &Source) -> bool {
        !source.text.contains("[[pair]]")
    }

    /// The pair of an airframe file, whose upper rotor is taken to turn clockwise on the bench.
    ///
    /// # Errors
    /// The file's faults.
    pub fn of_airframe(source: &Source) -> Result<Pair, String> {
        let Airframe { pairs, throttle, .. } = Airframe::read(source).map_err(|faults| faults.to_string())?;
        let pair = pairs.first().ok_or("no pair")?;
        let alone = pair.lower_out.as_ref().zip(pair.upper_out.as_ref());
        Ok(Pair {
            basis: pair.basis,
            coefficients: [pair.thrust_n.clone(), pair.torque_nm.clone()],
            throttle: [throttle.min, throttle.max],
            alone: alone.map(|(lower, upper)| [lower, upper].map(|alone| [alone.thrust_n, alone.torque_nm])),
        })
    }

    /// A pair made of `real` ones.
    pub(super) fn draw(random: &mut Random, real: &[Pair]) -> Pair {
        let first = &real[random.below(real.len())];
        let second = &real[random.below(real.len())];
        let curves = real.iter().find(|pair| pair.alone.is_some());
        for _ in 0..ATTEMPTS {
            let mut pair = if random.below(3) == 0 {
                first.mixed(second, random.uniform(0.2, 0.8))
            } else {
                first.clone()
            };
            if random.below(2) == 0 {
                pair.alter(random);
            }
            if random.below(3) == 0 {
                pair.alone = curves.map(|curves| pair.alone_as(curves));
            }
            pair.scale(random);
            pair.round();
            if pair.draw_throttle(random) {
                return pair;
            }
        }
        first.clone()
    }

    /// One of other propellers for the same throttles: of another size, and altered a little.
    pub(super) fn another(&self, random: &mut Random) -> Pair {
        let mut pair = self.clone();
        pair.alter(random);
        let [low, high] = self.throttle;
        let [thrust, torque] = &pair.coefficients;
        let least = EnclosedPairMap::of(pair.basis, thrust, torque).least_idle(high);
        if least.is_none_or(|least| ABOVE_FOLD * least > low) {
            pair = self.clone();
        }
        let factor = log_uniform(random, [0.5, 2.0]);
        let factors = [factor, factor * factor.sqrt()];
        let alone = pair
            .alone
            .iter_mut()
            .flatten()
            .flat_map(|alone| alone.iter_mut().zip(factors));
        for (list, factor) in alone {
            list.iter_mut().for_each(|c| *c *= factor);
        }
        for (list, factor) in pair.coefficients.iter_mut().zip(factors) {
            list.iter_mut().for_each(|c| *c *= factor);
        }
        pair.round();
        pair
    }

    /// Largest thrust (N) and torque (N m, of either sign).
    pub fn largest(&self) -> [f64; 2] {
        let [low, high] = self.throttle;
        let [f, _] = self.efforts([high, high]);
        let [_, left] = self.efforts([high, low]);
        let [_, right] = self.efforts([low, high]);
        [f, right.max(-left)]
    }

    fn efforts(&self, throttles: [f64; 2]) -> [f64; 2] {
        let power = |x: f64, exponent: u8| (0..exponent).map(|_| x).product::<f64>();
        let terms = self.basis.exponents().iter();
        let terms = terms.map(|&(i, j)| power(throttles[0], i) * power(throttles[1], j));
        let terms: Vec<f64> = terms.collect();
        let sum = |list: &Vec<f64>| terms.iter().zip(list).map(|(term, c)| term * c).sum();
        self.coefficients.each_ref().map(sum)
    }

    /// The same polynomials in the basis that has all terms.
    fn as_quartic(&self) -> Pair {
        let own = self.basis.exponents();
        let lift = |list: &Vec<f64>| {
            let terms = Basis::Quartic.exponents().iter();
            let at = terms.map(|term| own.iter().position(|own| own == term));
            at.map(|at| at.map_or(0.0, |at| list[at])).collect()
        };
        Pair {
            basis: Basis::Quartic,
            coefficients: self.coefficients.each_ref().map(lift),
            ..self.clone()
        }
    }

    /// This pair by `share`, the rest another one of the same size.
    fn mixed(&self, other: &Pair, share: f64) -> Pair {
        let (mut own, other) = if self.basis == other.basis {
            (self.clone(), other.clone())
        } else {
            (self.as_quartic(), other.as_quartic())
        };
        let sizes = own.largest().into_iter().zip(other.largest());
        let factors: Vec<f64> = sizes.map(|(own, other)| own / other).collect();
        for ((list, others), factor) in own.coefficients.iter_mut().zip(&other.coefficients).zip(factors) {
            for (own, other) in list.iter_mut().zip(others) {
                *own = share * *own + (1.0 - share) * factor * other;
            }
        }
        own.throttle = [0, 1].map(|end| share * self.throttle[end] + (1.0 - share) * other.throttle[end]);
        own.alone = None;
        own
    }

    fn alter(&mut self, random: &mut Random) {
        for coefficient in self.coefficients.iter_mut().flatten() {
            *coefficient *= 1.0 + random.uniform(-CHANGE, CHANGE);
        }
    }

    /// The curves of another pair's single rotors, of this one's size.
    fn alone_as(&self, other: &Pair) -> [Alone; 2] {
        let (own, others) = (self.largest(), other.largest());
        let curves = other.alone.unwrap_or_default();
        curves.map(|[thrust, torque]| {
            [
                thrust.map(|c| c * own[0] / others[0]),
                torque.map(|c| c * own[1] / others[1]),
            ]
        })
    }

    /// To another full thrust. Thrust grows with the square of the diameter at one tip speed, torque
    /// with its third power.
    fn scale(&mut self, random: &mut Random) {
        let [f, _] = self.largest();
        let factor = if random.below(3) == 0 {
            log_uniform(random, THRUSTS_N) / f
        } else {
            log_uniform(random, [0.5, 2.0])
        };
        let factors = [factor, factor * factor.sqrt() * random.uniform(0.7, 1.4)];
        for (list, factor) in self.coefficients.iter_mut().zip(factors) {
            list.iter_mut().for_each(|c| *c *= factor);
        }
        for (list, factor) in self
            .alone
            .iter_mut()
            .flatten()
            .flat_map(|a| a.iter_mut().zip(factors))
        {
            list.iter_mut().for_each(|c| *c *= factor);
        }
    }

    /// To seven digits, as files have them.
    fn round(&mut self) {
        let alone = self.alone.iter_mut().flatten().flatten().flatten();
        for coefficient in self.coefficients.iter_mut().flatten().chain(alone) {
            let digits = format!("{coefficient:.6e}");
            *coefficient = digits.parse().unwrap_or(*coefficient);
        }
    }

    /// Those of the bench, a wide range or a narrow one; false where the pair folds in nearly all
    /// of it or gives no thrust at idle.
    fn draw_throttle(&mut self, random: &mut Random) -> bool {
        let [bench_min, bench_max] = self.throttle;
        let max = match random.below(4) {
            0 => random.uniform(0.6, 1.0),
            1 => 1.0,
            _ => bench_max,
        };
        let max = hundredth(max);
        let [thrust, torque] = &self.coefficients;
        let Some(least) = EnclosedPairMap::of(self.basis, thrust, torque).least_idle(max) else {
            return false;
        };
        let low = (ABOVE_FOLD * least).max(LEAST_IDLE);
        let high = max - LEAST_RANGE;
        if low > high {
            return false;
        }
        let min = match random.below(4) {
            0 => random.uniform(low, low.midpoint(high)),
            1 => low,
            _ => bench_min.clamp(low, high),
        };
        // Up to a ten thousandth, to stay above the fold.
        self.throttle = [((min * 1e4).ceil() / 1e4).min(high), max];
        let [idle, _] = self.efforts([self.throttle[0]; 2]);
        idle > 0.0
    }
}

fn hundredth(x: f64) -> f64 {
    (100.0 * x).round() / 100.0
}

/// Between the limits, of which every octave is as likely as any other, to a thousandth of the
/// range. By square roots, which are the same on every machine.
pub(super) fn log_uniform(random: &mut Random, [low, high]: [f64; 2]) -> f64 {
    let (mut value, mut ratio) = (low, high / low);
    for _ in 0..10 {
        ratio = ratio.sqrt();
        if random.below(2) == 1 {
            value *= ratio;
        }
    }
    value
}
