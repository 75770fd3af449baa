//! Fits of the inverse map: efforts (f, Q) to throttles (u, l).
//!
//! Samples are throttles on a grid with the efforts they give, so the whole attainable set is covered, its border
//! included. Fits are least squares with Lawson's weights: after each solution every sample's weight is multiplied
//! by a power of its error in the efforts, *measured after the evaluator's Newton steps*, which drives the fit
//! towards the least possible maximum of what the mixer really misses. Evaluators without a step are fitted to the
//! efforts at once (`joint.rs`), seeds for Newton steps to the throttles (`lawson.rs`).

mod coordinates;
mod fit_efforts;
mod fit_throttles;
mod form;
mod sample;

pub(crate) use coordinates::Coordinates;

use crate::inverse::evaluator::{Evaluator, Refinement, SeedForm};
use crate::model::PairMap;
use coordinates::Start;
use fit_efforts::Joint;
use fit_throttles::Lawson;
use form::Form;
use sample::{Sample, Sampled, next_to_a_fold};

/// Points per side of the sample grid.
const GRID: usize = 21;

/// Points per side of the grid on which coordinates are judged for one form.
const COARSE_GRID: usize = 9;

/// Points per side of the grid on which evaluators without a step are found hopeless.
const GLANCE_GRID: usize = 11;

/// Evaluations of the search for one form.
const EVALUATIONS: usize = 140;

/// Evaluations of the search for one form without a step, which takes longer each.
const DIRECT_EVALUATIONS: usize = 90;

/// Rounds of reweighting in that search.
const SEARCH_ROUNDS: usize = 3;

/// Largest error on the coarse grid for which coordinates are searched for one form.
const WORTH_A_SEARCH: f64 = 2.0;

/// Likewise without a step, where errors are linear in what the search changes.
const DIRECT_WORTH_A_SEARCH: f64 = 1.3;

/// Rounds of reweighting without a step, and in the search.
const DIRECT_ROUNDS: [usize; 2] = [24, 8];

/// A lower bound of the error above which an evaluator without a step is given up: the bound is that of a linear
/// model.
const HOPELESS: f64 = 1.2;

/// Largest degree of polynomials that are fitted to the efforts: beyond, it takes too long.
const JOINT_DEGREE: u8 = 7;

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
        /// What is added to (x, y) for the place in a table; 0 for other seeds.
        offset: [f64; 2],
        /// Coefficients of u and of l.
        coefficients: [Vec<f64>; 2],
    },
}

/// Fits evaluators to one pair; the search for coordinates is shared.
#[derive(Debug)]
pub(crate) struct Inversion<'a> {
    pair: &'a PairMap,
    /// `[N, N m]`: errors are counted in these units.
    tolerance: [f64; 2],
    /// False where evaluators that cannot meet the tolerance need not be fitted well.
    thorough: bool,
    fine: Sampled,
    glance: Sampled,
    coarse: Sampled,
    /// Of every start.
    coordinates: [Option<Coordinates>; Start::ALL.len()],
}

impl<'a> Inversion<'a> {
    /// Inversion of `pair` to `tolerance` `[N, N m]`. Unless it is to be `thorough`, a fit that cannot meet the
    /// tolerance is given up early.
    pub(crate) fn new(pair: &'a PairMap, tolerance: [f64; 2], thorough: bool) -> Self {
        let fold = next_to_a_fold(pair);
        Inversion {
            pair,
            tolerance,
            thorough,
            fine: Sampled::new(pair, GRID, fold, tolerance),
            glance: Sampled::new(pair, GLANCE_GRID, false, tolerance),
            coarse: Sampled::new(pair, COARSE_GRID, fold, tolerance),
            coordinates: [None; Start::ALL.len()],
        }
    }

    /// Fits an evaluator. Returns it with its largest error over the samples in units of the tolerance.
    pub(crate) fn fit(&mut self, evaluator: Evaluator) -> (FittedInverse, f64) {
        match evaluator {
            Evaluator::Polynomial { degree } => self.fit_polynomial(degree),
            Evaluator::Seeded {
                seed,
                refinement: Refinement::None,
            } => self.fit_direct(seed),
            Evaluator::Seeded { seed, refinement } => self.fit_seed(seed, refinement),
        }
    }

    /// Fits a seed that no step follows.
    fn fit_direct(&mut self, seed: SeedForm) -> (FittedInverse, f64) {
        let start = self.start(0);
        let found = |form: Form, (coefficients, error): ([Vec<f64>; 2], f64)| {
            (form.fitted(Refinement::None, coefficients), error)
        };
        let form = Form::new(start, seed, &self.glance.samples);
        let glance = self.fit_efforts(&self.glance, &form, 2);
        if glance.1 > HOPELESS && !self.thorough {
            return found(form, (glance.0.0, glance.0.1.max(glance.1)));
        }
        let form = Form::new(start, seed, &self.fine.samples);
        let best = self.fit_efforts(&self.fine, &form, DIRECT_ROUNDS[0]).0;
        if best.1 <= 1.0 || best.1 > DIRECT_WORTH_A_SEARCH {
            return found(form, best);
        }
        let error = |coordinates: &Coordinates| {
            let form = Form::new(*coordinates, seed, &self.coarse.samples);
            self.fit_efforts(&self.coarse, &form, DIRECT_ROUNDS[1]).0.1
        };
        let searched = start.improved(self.pair, DIRECT_EVALUATIONS, error);
        let other_form = Form::new(searched, seed, &self.fine.samples);
        let other = self.fit_efforts(&self.fine, &other_form, DIRECT_ROUNDS[0]).0;
        if other.1 < best.1 {
            found(other_form, other)
        } else {
            found(form, best)
        }
    }

    /// Fits a seed for Newton steps, in the best of the starts' coordinates; where not much is missing then,
    /// coordinates are searched for this very form.
    fn fit_seed(&mut self, seed: SeedForm, refinement: Refinement) -> (FittedInverse, f64) {
        let mut best = (self.start(0), Start::ALL[0], f64::INFINITY);
        for (index, start) in Start::ALL.into_iter().enumerate() {
            let coordinates = self.start(index);
            let error = self.coarse_error(
                &coordinates,
                seed,
                refinement,
                start.emphasis,
                fit_throttles::PATIENCE,
            );
            if error <= 1.0 {
                let fitted = self.fit_seed_in(coordinates, seed, refinement, start.emphasis);
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
                self.coarse_error(coordinates, seed, refinement, emphasis, SEARCH_ROUNDS)
            };
            coordinates = coordinates.improved(self.pair, EVALUATIONS, of);
        } else if !self.thorough {
            let form = Form::new(coordinates, seed, &self.coarse.samples);
            let (coefficients, error) =
                self.fit_throttles(&self.coarse, &form, refinement, fit_throttles::PATIENCE, emphasis);
            return (form.fitted(refinement, coefficients), error);
        }
        self.fit_seed_in(coordinates, seed, refinement, emphasis)
    }

    fn fit_seed_in(
        &self,
        coordinates: Coordinates,
        seed: SeedForm,
        refinement: Refinement,
        emphasis: f64,
    ) -> (FittedInverse, f64) {
        let form = Form::new(coordinates, seed, &self.fine.samples);
        let (coefficients, error) =
            self.fit_throttles(&self.fine, &form, refinement, fit_throttles::ROUNDS, emphasis);
        (form.fitted(refinement, coefficients), error)
    }

    fn coarse_error(
        &self,
        coordinates: &Coordinates,
        seed: SeedForm,
        refinement: Refinement,
        emphasis: f64,
        rounds: usize,
    ) -> f64 {
        let form = Form::new(*coordinates, seed, &self.coarse.samples);
        self.fit_throttles(&self.coarse, &form, refinement, rounds, emphasis)
            .1
    }

    /// The coordinates of a start, searched once.
    fn start(&mut self, index: usize) -> Coordinates {
        let pair = self.pair;
        *self.coordinates[index].get_or_insert_with(|| Coordinates::search(pair, Start::ALL[index]))
    }

    fn fit_polynomial(&self, degree: u8) -> (FittedInverse, f64) {
        let samples = &self.fine.samples;
        let range = |index: usize| {
            let values = samples.iter().map(|sample| sample.efforts[index]);
            let low = values.clone().fold(f64::INFINITY, f64::min);
            let high = values.fold(f64::NEG_INFINITY, f64::max);
            [2.0 / (high - low), -(high + low) / (high - low)]
        };
        let (thrust, torque) = (range(0), range(1));
        let rows = |samples: &[Sample]| -> Vec<Vec<f64>> {
            let row =
                |[f, q]: [f64; 2]| monomials(degree, thrust[0] * f + thrust[1], torque[0] * q + torque[1]);
            samples.iter().map(|sample| row(sample.efforts)).collect()
        };
        let fitted = |(coefficients, error): ([Vec<f64>; 2], f64)| {
            let polynomial = FittedInverse::Polynomial {
                degree,
                thrust,
                torque,
                coefficients,
            };
            (polynomial, error)
        };
        if degree > JOINT_DEGREE {
            let rows = rows(samples);
            return fitted(self.fit_throttles_of(
                &self.fine,
                &rows,
                &[],
                Refinement::None,
                fit_throttles::ROUNDS,
                0.0,
            ));
        }
        let glance = self.joint_of(&self.glance, &rows(&self.glance.samples), &[], 2);
        if glance.1 > HOPELESS && !self.thorough {
            return fitted((glance.0.0, glance.0.1.max(glance.1)));
        }
        fitted(self.joint_of(&self.fine, &rows(samples), &[], DIRECT_ROUNDS[0]).0)
    }

    fn fit_efforts(&self, sampled: &Sampled, form: &Form, rounds: usize) -> (([Vec<f64>; 2], f64), f64) {
        self.joint_of(sampled, &form.rows(&sampled.samples), &form.smooth(), rounds)
    }

    /// The fit of the efforts, its error, and a lower bound of it.
    fn joint_of(
        &self,
        sampled: &Sampled,
        rows: &[Vec<f64>],
        smooth: &[Vec<f64>],
        rounds: usize,
    ) -> (([Vec<f64>; 2], f64), f64) {
        let error = |index: usize, guess: [f64; 2]| {
            self.missed(
                guess.map(|throttle| self.pair.clamp(throttle)),
                sampled.samples[index].efforts,
            )
        };
        let hopeless = if self.thorough { f64::INFINITY } else { HOPELESS };
        let found = Joint {
            rows,
            samples: &sampled.samples,
            jacobians: &sampled.jacobians,
            smooth,
        }
        .fit(rounds, hopeless, &error);
        ((found.coefficients, found.error), found.floor)
    }

    fn fit_throttles(
        &self,
        sampled: &Sampled,
        form: &Form,
        refinement: Refinement,
        rounds: usize,
        emphasis: f64,
    ) -> ([Vec<f64>; 2], f64) {
        self.fit_throttles_of(
            sampled,
            &form.rows(&sampled.samples),
            &form.smooth(),
            refinement,
            rounds,
            emphasis,
        )
    }

    /// The minimax fit of both throttles in the given terms, and its error after the refinement.
    fn fit_throttles_of(
        &self,
        sampled: &Sampled,
        rows: &[Vec<f64>],
        smooth: &[Vec<f64>],
        refinement: Refinement,
        rounds: usize,
        emphasis: f64,
    ) -> ([Vec<f64>; 2], f64) {
        let samples = &sampled.samples;
        let targets: Vec<[f64; 2]> = samples.iter().map(|sample| sample.throttles).collect();
        let (steps, residuals) = refinement.steps();
        let error = |index: usize, guess: [f64; 2]| {
            let efforts = samples[index].efforts;
            let mut throttles = guess.map(|throttle| self.pair.clamp(throttle));
            for _ in 0..steps {
                throttles = self.pair.newton(throttles, efforts, residuals);
            }
            let [f, q] = self.missed(throttles, efforts);
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
            smooth,
        }
        .fit(rounds, hopeless, &error)
    }

    /// How far throttles are from efforts, in units of the tolerance.
    fn missed(&self, throttles: [f64; 2], efforts: [f64; 2]) -> [f64; 2] {
        let given = self.pair.efforts(throttles);
        [0, 1].map(|k| (given[k] - efforts[k]).abs() / self.tolerance[k])
    }
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
