//! Fits of the inverse map: efforts (f, Q) to throttles (u, l).
//!
//! Samples are throttles on a grid with the efforts they give, so the whole attainable set is
//! covered, its border included. Fits are least squares with Lawson's weights: after each solution
//! every sample's weight is multiplied by a power of its error in the efforts, *measured after the
//! evaluator's Newton steps*, which drives the fit towards the least possible maximum of what the
//! mixer really misses.

mod coordinates;
mod lawson;
mod sample;

pub(crate) use coordinates::Coordinates;

use super::evaluator::Evaluator;
use super::table::InverseTable;
use crate::model::PairMap;
use coordinates::Start;
use lawson::Lawson;
use sample::{Sample, Sampled, next_to_a_fold};

/// How densely the attainable set is sampled: points per side of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Samples {
    /// Enough for most maps.
    Usual = 21,
    /// For fits that miss more between the samples than they may.
    Fine = 41,
}

/// Points per side of the grid on which coordinates are judged for one form.
const COARSE_GRID: usize = 9;

/// Evaluations of the search for one form.
const EVALUATIONS: usize = 140;

/// Rounds of reweighting in that search.
const SEARCH_ROUNDS: usize = 3;

/// Largest error on the coarse grid for which coordinates are searched for one form.
const WORTH_A_SEARCH: f64 = 2.0;

/// Fits evaluators to one pair; the search for coordinates is shared.
#[derive(Debug)]
pub(crate) struct Inversion<'a> {
    pair: &'a PairMap,
    /// `[N, N m]`: errors are counted in these units.
    tolerance: [f64; 2],
    /// False where evaluators that cannot meet the tolerance need not be fitted well.
    thorough: bool,
    fine: Sampled,
    coarse: Sampled,
    /// Of every start.
    coordinates: [Option<Coordinates>; Start::ALL.len()],
}

impl<'a> Inversion<'a> {
    /// Inversion of `pair` to `tolerance` `[N, N m]`. Unless it is to be `thorough`, a fit that
    /// cannot meet the tolerance is given up early.
    pub(crate) fn new(pair: &'a PairMap, tolerance: [f64; 2], samples: Samples, thorough: bool) -> Self {
        let fold = next_to_a_fold(pair);
        Inversion {
            pair,
            tolerance,
            thorough,
            fine: Sampled::new(pair, samples as usize, fold),
            coarse: Sampled::new(pair, COARSE_GRID, fold),
            coordinates: [None; Start::ALL.len()],
        }
    }

    /// Fits an evaluator. Returns it with its largest error over the samples in units of the
    /// tolerance.
    pub(crate) fn fit(&mut self, evaluator: Evaluator) -> (InverseTable, f64) {
        match evaluator {
            Evaluator::Polynomial { .. } => self.fit_polynomial(evaluator),
            Evaluator::Seed { .. } => self.fit_seed(evaluator),
        }
    }

    /// Fits a seed for its Newton steps, in the best of the starts' coordinates; where not much is
    /// missing then, coordinates are searched for this very form.
    fn fit_seed(&mut self, seed: Evaluator) -> (InverseTable, f64) {
        let mut best = (self.start(0), Start::ALL[0], f64::INFINITY);
        for (index, start) in Start::ALL.into_iter().enumerate() {
            let coordinates = self.start(index);
            let error = self
                .fit_over(&self.coarse, coordinates, seed, lawson::PATIENCE, start.emphasis)
                .1;
            if error <= 1.0 {
                let fitted = self.fit_over(&self.fine, coordinates, seed, lawson::ROUNDS, start.emphasis);
                if fitted.1 <= 1.0 {
                    return fitted;
                }
            }
            if error < best.2 {
                best = (coordinates, start, error);
            }
        }
        let (mut coordinates, Start { emphasis, .. }, error) = best;
        if error < WORTH_A_SEARCH {
            let of = |coordinates: &Coordinates| {
                self.fit_over(&self.coarse, *coordinates, seed, SEARCH_ROUNDS, emphasis)
                    .1
            };
            coordinates = coordinates.improved(self.pair, EVALUATIONS, of);
        } else if !self.thorough {
            return self.fit_over(&self.coarse, coordinates, seed, lawson::PATIENCE, emphasis);
        }
        self.fit_over(&self.fine, coordinates, seed, lawson::ROUNDS, emphasis)
    }

    /// Fits a seed in the given coordinates.
    fn fit_over(
        &self,
        sampled: &Sampled,
        coordinates: Coordinates,
        seed: Evaluator,
        rounds: usize,
        emphasis: f64,
    ) -> (InverseTable, f64) {
        let row = |sample: &Sample| {
            let [x, y] = coordinates.at(sample.efforts);
            monomials(seed.degree(), x, y)
        };
        let rows: Vec<Vec<f64>> = sampled.samples.iter().map(row).collect();
        let (coefficients, error) = self.fit_throttles(sampled, &rows, seed.steps(), rounds, emphasis);
        let Coordinates { x, y } = coordinates;
        (InverseTable::new(seed, [x, y], coefficients), error)
    }

    /// The coordinates of a start, searched once.
    fn start(&mut self, index: usize) -> Coordinates {
        let pair = self.pair;
        *self.coordinates[index].get_or_insert_with(|| Coordinates::search(pair, Start::ALL[index]))
    }

    fn fit_polynomial(&self, polynomial: Evaluator) -> (InverseTable, f64) {
        let samples = &self.fine.samples;
        let range = |index: usize| {
            let values = samples.iter().map(|sample| sample.efforts[index]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            let high = values.fold(f64::NEG_INFINITY, f64::max);
            [2.0 / (high - low), -(high + low) / (high - low)]
        };
        let (thrust, torque) = (range(0), range(1));
        let row = |sample: &Sample| {
            let [f, q] = sample.efforts;
            monomials(
                polynomial.degree(),
                thrust[0] * f + thrust[1],
                torque[0] * q + torque[1],
            )
        };
        let rows: Vec<Vec<f64>> = samples.iter().map(row).collect();
        let (coefficients, error) = self.fit_throttles(&self.fine, &rows, 0, lawson::ROUNDS, 0.0);
        let forms = [[thrust[0], 0.0, thrust[1]], [0.0, torque[0], torque[1]]];
        (InverseTable::new(polynomial, forms, coefficients), error)
    }

    /// The minimax fit of both throttles in the given terms, and its error after the Newton steps.
    fn fit_throttles(
        &self,
        sampled: &Sampled,
        rows: &[Vec<f64>],
        steps: u8,
        rounds: usize,
        emphasis: f64,
    ) -> ([Vec<f64>; 2], f64) {
        let samples = &sampled.samples;
        let targets: Vec<[f64; 2]> = samples.iter().map(|sample| sample.throttles).collect();
        let error = |index: usize, guess: [f64; 2]| {
            let efforts = samples[index].efforts;
            let mut throttles = guess.map(|throttle| self.pair.clamp(throttle));
            for _ in 0..steps {
                throttles = self.pair.newton(throttles, efforts);
            }
            let given = self.pair.efforts(throttles);
            let [f, q] = [0, 1].map(|k| (given[k] - efforts[k]).abs() / self.tolerance[k]);
            f.max(q)
        };
        let hopeless = if self.thorough {
            f64::INFINITY
        } else {
            WORTH_A_SEARCH
        };
        Lawson {
            rows,
            targets: &targets,
            weights: sampled.weights(self.pair, emphasis),
            is_refined: steps > 0,
        }
        .fit(rounds, hopeless, &error)
    }
}

/// The terms x^(d-i) y^(i-j) in the order of `mixer_rt::tables::PolynomialInverse`.
fn monomials(degree: u8, x: f64, y: f64) -> Vec<f64> {
    let d = usize::from(degree);
    let (mut of_x, mut of_y) = (vec![1.0; d + 1], vec![1.0; d + 1]);
    // Plain loops: the search runs through here thousands of times in builds without optimisation.
    let mut k = 1;
    while k <= d {
        of_x[k] = of_x[k - 1] * x;
        of_y[k] = of_y[k - 1] * y;
        k += 1;
    }
    let mut terms = Vec::with_capacity((d + 1) * (d + 2) / 2);
    let mut i = 0;
    while i <= d {
        let mut j = 0;
        while j <= i {
            terms.push(of_x[d - i] * of_y[i - j]);
            j += 1;
        }
        i += 1;
    }
    terms
}
