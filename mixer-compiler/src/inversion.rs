//! Fits of the inverse map: efforts (f, Q) to throttles (u, l).
//!
//! Samples are throttles on a grid with the efforts they give, so the whole attainable set is covered, its border
//! included. Fits are least squares with Lawson's weights: after each solution every sample's weight is multiplied
//! by a power of its error, *measured as the residual after the evaluator's Newton steps*, which drives the fit
//! towards the least possible maximum of what the mixer really misses.

mod coordinates;
mod lawson;

pub use coordinates::Coordinates;

use crate::evaluator::{Evaluator, Refinement, SeedForm};
use crate::model::PairMap;
use lawson::Lawson;

/// Points per side of the sample grid.
const GRID: usize = 21;

/// Points per side of the grid on which coordinates are judged for one form.
const COARSE_GRID: usize = 9;

/// Evaluations of the search for one form.
const EVALUATIONS: usize = 140;

/// Largest error, in units of the tolerance, for which coordinates are searched for one form.
const WORTH_A_SEARCH: f64 = 3.0;

/// Emphasis on small det J of both starts.
const EMPHASES: [f64; 2] = [0.0, 0.75];

/// A fitted inverse, in f64.
#[derive(Clone, Debug, PartialEq)]
pub enum FittedInverse {
    /// Coefficients of a polynomial in scaled (f, Q).
    Polynomial {
        /// Total degree.
        degree: u8,
        /// Scale and offset of f to [-1, 1].
        thrust: [f64; 2],
        /// Scale and offset of Q to [-1, 1].
        torque: [f64; 2],
        /// Coefficients of u and of l, in the order of `mixer_rt::PolynomialInverse`.
        coefficients: [Vec<f64>; 2],
    },
    /// Coefficients of a seed.
    Seeded {
        /// The seed's form.
        seed: SeedForm,
        /// Newton steps.
        steps: u8,
        /// Residuals per step.
        residuals: u8,
        /// The root coordinates.
        coordinates: Coordinates,
        /// Coefficients of u and of l.
        coefficients: [Vec<f64>; 2],
    },
}

/// One throttle pair with its efforts.
#[derive(Clone, Copy, Debug)]
struct Sample {
    throttles: [f64; 2],
    efforts: [f64; 2],
}

/// Fits evaluators to one pair; the search for coordinates is shared.
#[derive(Debug)]
pub struct Inversion<'a> {
    pair: &'a PairMap,
    /// `[N, N m]`: errors are counted in these units.
    tolerance: [f64; 2],
    samples: Vec<Sample>,
    /// For ordinary pairs, and for pairs next to a fold.
    coordinates: [Option<Coordinates>; 2],
}

impl<'a> Inversion<'a> {
    /// Inversion of `pair` to `tolerance` `[N, N m]`.
    pub fn new(pair: &'a PairMap, tolerance: [f64; 2]) -> Self {
        Inversion {
            pair,
            tolerance,
            samples: samples(pair, GRID),
            coordinates: [None; 2],
        }
    }

    /// Fits an evaluator. Returns it with its largest error over the samples in units of the tolerance.
    pub fn fit(&mut self, evaluator: Evaluator) -> (FittedInverse, f64) {
        match evaluator {
            Evaluator::Polynomial { degree } => self.fit_polynomial(degree),
            Evaluator::Seeded { seed, refinement } => self.fit_seed(seed, refinement),
        }
    }

    /// Fits in the coordinates for ordinary pairs. Where that is not enough, those for pairs next to a fold are
    /// tried, and where not much is missing, coordinates are searched for this very form.
    fn fit_seed(&mut self, seed: SeedForm, refinement: Refinement) -> (FittedInverse, f64) {
        let start = self.start(0);
        let mut best = self.fit_seed_in(start, seed, refinement);
        if best.1 > 1.0 && refinement != Refinement::None {
            let start = self.start(1);
            let other = self.fit_seed_in(start, seed, refinement);
            if other.1 < best.1 {
                best = other;
            }
        }
        if best.1 > 1.0
            && best.1 < WORTH_A_SEARCH
            && let FittedInverse::Seeded { coordinates, .. } = best.0
        {
            let coarse = samples(self.pair, COARSE_GRID);
            let error = |coordinates: &Coordinates| {
                let rows = rows(&coarse, coordinates, seed);
                self.lawson(&coarse, &rows, refinement, 3).1
            };
            let searched = coordinates.improved(self.pair, EVALUATIONS, error);
            let other = self.fit_seed_in(searched, seed, refinement);
            if other.1 < best.1 {
                best = other;
            }
        }
        best
    }

    /// The coordinates of a start, searched once.
    fn start(&mut self, index: usize) -> Coordinates {
        let pair = self.pair;
        *self.coordinates[index].get_or_insert_with(|| Coordinates::search(pair, EMPHASES[index]))
    }

    fn fit_seed_in(
        &self,
        coordinates: Coordinates,
        seed: SeedForm,
        refinement: Refinement,
    ) -> (FittedInverse, f64) {
        let rows = rows(&self.samples, &coordinates, seed);
        let (coefficients, error) = self.lawson(&self.samples, &rows, refinement, lawson::ROUNDS);
        let (steps, residuals) = refinement.steps();
        (
            FittedInverse::Seeded {
                seed,
                steps,
                residuals,
                coordinates,
                coefficients,
            },
            error,
        )
    }

    fn fit_polynomial(&self, degree: u8) -> (FittedInverse, f64) {
        let range = |index: usize| {
            let values = self.samples.iter().map(|sample| sample.efforts[index]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            let high = values.fold(f64::NEG_INFINITY, f64::max);
            [2.0 / (high - low), -(high + low) / (high - low)]
        };
        let (thrust, torque) = (range(0), range(1));
        let rows: Vec<Vec<f64>> = self
            .samples
            .iter()
            .map(|Sample { efforts: [f, q], .. }| {
                monomials(degree, thrust[0] * f + thrust[1], torque[0] * q + torque[1])
            })
            .collect();
        let (coefficients, error) = self.lawson(&self.samples, &rows, Refinement::None, lawson::ROUNDS);
        (
            FittedInverse::Polynomial {
                degree,
                thrust,
                torque,
                coefficients,
            },
            error,
        )
    }

    /// The minimax fit of both throttles in the given terms, and its error after the refinement.
    fn lawson(
        &self,
        samples: &[Sample],
        rows: &[Vec<f64>],
        refinement: Refinement,
        rounds: usize,
    ) -> ([Vec<f64>; 2], f64) {
        let targets: Vec<[f64; 2]> = samples.iter().map(|sample| sample.throttles).collect();
        let error = |index: usize, guess: [f64; 2]| {
            let efforts = samples[index].efforts;
            let mut throttles = guess.map(|throttle| self.pair.clamp(throttle));
            let (steps, residuals) = refinement.steps();
            for _ in 0..steps {
                throttles = self.pair.newton(throttles, efforts, residuals);
            }
            let given = self.pair.efforts(throttles);
            let miss = |k: usize| (given[k] - efforts[k]).abs() / self.tolerance[k];
            miss(0).max(miss(1))
        };
        Lawson {
            rows,
            targets: &targets,
            direct: refinement == Refinement::None,
        }
        .fit(rounds, &error)
    }
}

fn samples(pair: &PairMap, points: usize) -> Vec<Sample> {
    let grid = pair.grid(points).into_iter();
    grid.map(|throttles| Sample {
        throttles,
        efforts: pair.efforts(throttles),
    })
    .collect()
}

/// The terms of a seed at every sample.
fn rows(samples: &[Sample], coordinates: &Coordinates, seed: SeedForm) -> Vec<Vec<f64>> {
    samples
        .iter()
        .map(|sample| {
            let [x, y] = coordinates.at(sample.efforts);
            seed.monomials(x, y)[..seed.terms()].to_vec()
        })
        .collect()
}

/// The terms s^(d-i) t^(i-j) in the order of `mixer_rt::PolynomialInverse`.
fn monomials(degree: u8, s: f64, t: f64) -> Vec<f64> {
    let power = |x: f64, exponent: u8| (0..exponent).fold(1.0, |product, _| product * x);
    let mut terms = Vec::new();
    for i in 0..=degree {
        for j in 0..=i {
            terms.push(power(s, degree - i) * power(t, i - j));
        }
    }
    terms
}
