//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

mod refusal;

use mixer_rt::tables::Tolerance;

use crate::airframe::Airframe;
use crate::diagnostic::Diagnostic;
use crate::inverse::evaluator::Evaluator;
use crate::inverse::fit::{Inversion, Samples};
use crate::model::effectiveness::Effectiveness;
use crate::model::feedback::Feedback;
use crate::model::law::{self, CorrectionTables};
use crate::model::{PairMap, scales};
use crate::proof::residual::Residual;
use crate::proof::{self, Certificate, CorrectionBounds, Patience};
use crate::tables::{self, UnitMap};

/// An evaluator with its table and what is known about it.
#[derive(Clone, Debug)]
pub(crate) struct Selected {
    /// The map of a unit with the evaluator's inverse.
    pub(crate) map: UnitMap,
    /// What was observed.
    pub(crate) residual: Residual,
    /// What is proven.
    pub(crate) certificate: Certificate,
}

/// An evaluator that was fitted.
struct Attempt {
    map: UnitMap,
    /// Largest error over a coarse grid, in units of the tolerance.
    error: f64,
}

/// Bounds within this factor of the largest observed residual are sharp enough.
const SHARP: f64 = 1.15;

/// The cheapest evaluator that is proven to meet the file's tolerance at every voltage and density, for each of these
/// airframes of one pair: the same one for all, with a table of its own for each.
///
/// # Errors
/// No evaluator meets the tolerance; the best bound that could be proven.
pub(crate) fn select(
    airframes: &[Airframe],
    corrections: &CorrectionTables,
) -> Result<Vec<Selected>, Vec<Diagnostic>> {
    let place = |selected: &Selected| selected.map.inverse.evaluator.place();
    let mut least = 0;
    loop {
        let selected = airframes.iter().map(|airframe| {
            let chosen = choose(
                airframe,
                &PairMap::new(&airframe.pair, &airframe.throttle),
                corrections,
                least,
            );
            if chosen.holds() {
                return Ok(chosen);
            }
            let evaluator = chosen.map.inverse.evaluator;
            Err(vec![refusal::tolerance(airframe, evaluator, &chosen.certificate)])
        });
        let selected = selected.collect::<Result<Vec<Selected>, _>>()?;
        let most = selected.iter().map(place).max().unwrap_or_default();
        if selected.iter().all(|selected| place(selected) == most) {
            return Ok(selected);
        }
        least = most;
    }
}

impl Selected {
    /// True where the tolerance is proven, and nothing was observed beyond what is proven.
    fn holds(&self) -> bool {
        self.certificate.holds() && self.certificate.agrees(&self.residual)
    }
}

/// The first evaluator, by cost, that holds, fitted to finer samples where none does; else the one that
/// came closest.
fn choose(airframe: &Airframe, pair: &PairMap, corrections: &CorrectionTables, least: usize) -> Selected {
    let usual = choose_by(Samples::Usual, airframe, pair, corrections, least);
    if usual.holds() {
        return usual;
    }
    choose_by(Samples::Fine, airframe, pair, corrections, least)
}

/// The first evaluator, by cost, that holds. Where none does, the one that came closest, with a
/// thorough proof: others are given up where they take long.
fn choose_by(
    samples: Samples,
    airframe: &Airframe,
    pair: &PairMap,
    corrections: &CorrectionTables,
    least: usize,
) -> Selected {
    let correction = CorrectionBounds::new(airframe, corrections);
    let tolerance = correction.tolerance_at_reference(airframe);
    let (cheapest, others) = Evaluator::candidates(airframe.inverse.method, least);
    let mut inversion = Inversion::new(pair, tolerance, samples, others.is_empty());
    let mut attempt = |evaluator: Evaluator| {
        let (inverse, fit_error) = inversion.fit(evaluator);
        let map = UnitMap::new(airframe, inverse);
        // The grid of the fit is part of the set: what fails there, fails.
        let error = Residual::coarse_check(pair, &map).ratio(tolerance).max(fit_error);
        Attempt { map, error }
    };
    let proven = |attempt: &Attempt, patience: Patience| {
        let map = &attempt.map;
        let mut residual = Residual::over_set(pair, map);
        let aim = [0, 1].map(|k| (SHARP * residual.efforts[k]).min(tolerance[k]));
        let certificate = proof::prove(airframe, map, &correction, aim, patience);
        // Where the proof found it hardest, more may be missed than on the grid.
        for throttles in certificate.at {
            residual.look(pair, map, throttles.map(|throttle| pair.clamp(throttle)));
        }
        Selected {
            map: map.clone(),
            residual,
            certificate,
        }
    };
    let quick = |attempt: &Attempt| {
        let selected = (attempt.error <= 1.0).then(|| proven(attempt, Patience::Quick));
        selected.filter(Selected::holds)
    };
    let mut closest = attempt(cheapest);
    if let Some(selected) = quick(&closest) {
        return selected;
    }
    for &evaluator in others {
        let next = attempt(evaluator);
        if let Some(selected) = quick(&next) {
            return selected;
        }
        if next.error < closest.error {
            closest = next;
        }
    }
    proven(&closest, Patience::Thorough)
}

/// Error below which a request counts as delivered: the proven bound, not what the file allows, so that
/// any larger shortfall is flagged. `selected` are those of `airframes`, the airframe's of each pair.
pub(crate) fn tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    corrections: &CorrectionTables,
    airframes: &[Airframe],
    selected: &[Selected],
    feedback: &Feedback,
) -> Tolerance {
    // The mixer compares what it computes, not what is: a request that is delivered must not look
    // missed.
    let correction = CorrectionBounds::new(airframe, corrections);
    let (mut efforts, mut stated) = ([0.0f64; 2], [0.0f64; 2]);
    let of_pairs = airframes.iter().zip(selected).filter(|_| airframe.has_pairs());
    for (of_pair, Selected { map, certificate, .. }) in of_pairs {
        let rounding = proof::rounding(of_pair, map, &correction);
        efforts = [0, 1].map(|k| efforts[k].max(certificate.reference[k] + rounding[k]));
        stated = [0, 1].map(|k| stated[k].max(certificate.stated[k]));
    }
    if !airframe.single_rotors.is_empty() {
        efforts[0] = efforts[0].max(feedback.thrust_n + ROUNDING * largest_thrust(airframe));
    }
    let wrench = wrench_tolerance(airframe, effectiveness, stated, feedback);
    tables::tolerance_table(efforts, wrench)
}

/// Rounding of sums in f32 as a share of full efforts.
const ROUNDING: f64 = 4e-6;

/// Of any unit, N.
fn largest_thrust(airframe: &Airframe) -> f64 {
    let scales = scales(airframe, [1.0; 2]);
    scales.iter().fold(0.0, |most, scale| most.max(scale[0]))
}

/// What the units' misses `stated` add up to on each axis, with the rounding of f32 sums of full
/// efforts.
fn wrench_tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    stated: [f64; 2],
    feedback: &Feedback,
) -> [f64; 4] {
    let factors = law::largest_factors(airframe);
    let sizes = scales(airframe, [1.0; 2]).into_iter();
    let units = airframe.units.iter().zip(&feedback.missed).zip(sizes);
    let allowed = units.map(|((unit, missed), scale)| {
        [0, 1].map(|k: usize| {
            let own = if unit.lower_channel.is_some() {
                stated[k]
            } else {
                0.0
            };
            own + (missed[k] + ROUNDING * scale[k]) * factors[k]
        })
    });
    let allowed: Vec<[f64; 2]> = allowed.collect();
    std::array::from_fn(|axis| effectiveness.largest(axis, &allowed))
}
