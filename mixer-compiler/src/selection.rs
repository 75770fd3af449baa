//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

mod refusal;

use mixer_rt::tables::Tolerance;

use crate::airframe::{Airframe, Pair, Unit};
use crate::diagnostic::Diagnostic;
use crate::inverse::evaluator::Evaluator;
use crate::inverse::fit::{Inversion, Samples};
use crate::model::effectiveness::Effectiveness;
use crate::model::law::{self, CorrectionTables};
use crate::model::{PairMap, scales};
use crate::proof::residual::Residual;
use crate::proof::{self, Certificate, CorrectionBounds, Patience};
use crate::tables::{self, UnitMap};
use crate::view::View;

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
/// pairs: the same one for all, with a table of its own for each.
///
/// # Errors
/// No evaluator meets the tolerance; the best bound that could be proven.
pub(crate) fn select(
    views: &[View<'_, &Pair>],
    corrections: &CorrectionTables,
) -> Result<Vec<Selected>, Vec<Diagnostic>> {
    let place = |selected: &Selected| selected.map.inverse.evaluator.place();
    let mut least = 0;
    loop {
        let selected = views.iter().map(|view| {
            let chosen = choose(view, &PairMap::new(view.of, &view.throttle), corrections, least);
            if chosen.holds() {
                return Ok(chosen);
            }
            let evaluator = chosen.map.inverse.evaluator;
            Err(vec![refusal::tolerance(view, evaluator, &chosen.certificate)])
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
fn choose(view: &View<'_, &Pair>, pair: &PairMap, corrections: &CorrectionTables, least: usize) -> Selected {
    let usual = choose_by(Samples::Usual, view, pair, corrections, least);
    if usual.holds() {
        return usual;
    }
    choose_by(Samples::Fine, view, pair, corrections, least)
}

/// The first evaluator, by cost, that holds. Where none does, the one that came closest, with a
/// thorough proof: others are given up where they take long.
fn choose_by(
    samples: Samples,
    view: &View<'_, &Pair>,
    pair: &PairMap,
    corrections: &CorrectionTables,
    least: usize,
) -> Selected {
    let correction = CorrectionBounds::new(view, corrections);
    let tolerance = correction.tolerance_at_reference(view);
    let (cheapest, others) = Evaluator::candidates(view.inverse.method, least);
    let mut inversion = Inversion::new(pair, tolerance, samples, others.is_empty());
    let mut attempt = |evaluator: Evaluator| {
        let (inverse, fit_error) = inversion.fit(evaluator);
        let map = UnitMap::new(view, inverse);
        // The grid of the fit is part of the set: what fails there, fails.
        let error = Residual::coarse_check(pair, &map).ratio(tolerance).max(fit_error);
        Attempt { map, error }
    };
    let proven = |attempt: &Attempt, patience: Patience| {
        let map = &attempt.map;
        let mut residual = Residual::over_set(pair, map);
        let aim = [0, 1].map(|k| (SHARP * residual.efforts[k]).min(tolerance[k]));
        let certificate = proof::prove(view, map, &correction, aim, patience);
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

/// Error below which a request counts as delivered: the proven bound, not what the file allows, so that any larger
/// shortfall is flagged. With it what thrust and torque of any unit may miss under all conditions, `[N, N m]`.
///
/// A single rotor is compared at run time with what is asked of it, by the same bound as pairs, or by what the file allows
/// where no unit is a pair. `selected` are those of `views`.
pub(crate) fn tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    corrections: &CorrectionTables,
    views: &[View<'_, &Pair>],
    selected: &[Selected],
) -> (Tolerance, [f64; 2]) {
    // The mixer compares what it computes, not what is: a request that is delivered must not look
    // missed.
    let correction = CorrectionBounds::new(airframe, corrections);
    let sizes = scales(airframe, [1.0; 2]);
    let (mut efforts, mut of_pairs) = ([0.0f64; 2], [0.0f64; 2]);
    for (view, Selected { map, certificate, .. }) in views.iter().zip(selected) {
        let rounding = proof::rounding(view, map, &correction);
        efforts = [0, 1].map(|k| efforts[k].max(certificate.reference[k] + rounding[k]));
        of_pairs = [0, 1].map(|k| of_pairs[k].max(certificate.stated[k]));
    }
    if airframe.pairs.is_empty() {
        efforts = correction.tolerance_at_reference(airframe);
    }
    let factors = law::largest_factors(airframe);
    let of_singles = [0, 1].map(|k| efforts[k] * factors[k]);
    let units = || {
        let stated = |unit: &Unit| {
            if unit.lower_channel.is_some() {
                of_pairs
            } else {
                of_singles
            }
        };
        airframe.units.iter().map(stated)
    };
    let rounded =
        |(stated, size): ([f64; 2], &[f64; 2])| [0, 1].map(|k| stated[k] + ROUNDING * size[k] * factors[k]);
    let allowed: Vec<[f64; 2]> = units().zip(&sizes).map(rounded).collect();
    let wrench = std::array::from_fn(|axis| effectiveness.largest(axis, &allowed));
    let stated = [0, 1].map(|k| units().fold(0.0, |most: f64, stated| most.max(stated[k])));
    (tables::tolerance_table(efforts, wrench), stated)
}

/// Rounding of sums in f32 as a share of full efforts.
const ROUNDING: f64 = 4e-6;
