//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

mod refusal;

use mixer_rt::tables::Tolerance;

use crate::airframe::Airframe;
use crate::diagnostic::Diagnostic;
use crate::inverse::evaluator::Evaluator;
use crate::inverse::fit::Inversion;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::voltage;
use crate::proof::residual::Residual;
use crate::proof::{self, Certificate, CorrectionBounds};
use crate::tables::{self, InverseTable, UnitMap, VoltageTable};

/// An evaluator with its table and what is known about it.
#[derive(Clone, Debug)]
pub(crate) struct Selected {
    /// The evaluator.
    pub(crate) evaluator: Evaluator,
    /// The map of a unit with the evaluator's inverse.
    pub(crate) map: UnitMap,
    /// What was observed.
    pub(crate) residual: Residual,
    /// What is proven.
    pub(crate) certificate: Certificate,
}

/// The cheapest evaluator that is proven to meet the file's tolerance at every voltage.
///
/// # Errors
/// No evaluator meets the tolerance; the best bound that could be proven.
pub(crate) fn select(
    airframe: &Airframe,
    pair: &PairMap,
    voltage: Option<&VoltageTable>,
) -> Result<Selected, Vec<Diagnostic>> {
    choose(airframe, pair, voltage).map_err(|best| {
        let meets = |airframe: &Airframe| {
            let pair = PairMap::new(&airframe.pair, &airframe.throttle);
            choose(airframe, &pair, voltage).is_ok()
        };
        vec![match best {
            Some((evaluator, certificate)) => refusal::tolerance(airframe, evaluator, &certificate, meets),
            None => refusal::name(airframe),
        }]
    })
}

/// The evaluator that came closest, and what is proven of it; `None` where there is none of the
/// name asked for.
type Best = Option<(Evaluator, Certificate)>;

/// Tries the evaluators by their cost. Where none is proven at once, the one that came closest gets
/// a thorough proof: others are given up where they take long.
fn choose(airframe: &Airframe, pair: &PairMap, voltage: Option<&VoltageTable>) -> Result<Selected, Best> {
    let correction = CorrectionBounds::new(airframe, voltage);
    let tolerance = correction.tolerance_at_reference(airframe);
    let accept = |evaluator: Evaluator, map: &UnitMap, mut residual: Residual, thorough: bool| {
        let certificate = proof::prove(airframe, pair, map, &correction, &mut residual, thorough);
        if !(certificate.holds() && certificate.agrees(&residual)) {
            return Err(Some((evaluator, certificate)));
        }
        Ok(Selected {
            evaluator,
            map: map.clone(),
            residual,
            certificate,
        })
    };
    let candidates = Evaluator::candidates(&airframe.inverse.method);
    let mut inversion = Inversion::new(pair, tolerance, candidates.len() == 1);
    let mut best: Option<(Evaluator, UnitMap, f64)> = None;
    for evaluator in candidates {
        let (fitted, fit_error) = inversion.fit(evaluator);
        let map = UnitMap::new(airframe, InverseTable::new(&fitted));
        // The grid of the fit is part of the set: what fails there, fails.
        let error = Residual::coarse_check(pair, &map).ratio(tolerance).max(fit_error);
        if error <= 1.0 {
            let residual = Residual::over_set(pair, &map);
            if residual.within(tolerance)
                && let Ok(selected) = accept(evaluator, &map, residual, false)
            {
                return Ok(selected);
            }
        }
        if best.as_ref().is_none_or(|(_, _, so_far)| error < *so_far) {
            best = Some((evaluator, map, error));
        }
    }
    let Some((evaluator, map, _)) = best else {
        return Err(None);
    };
    accept(evaluator, &map, Residual::over_set(pair, &map), true)
}

/// What the mixer may miss where it delivers: what is proven, not what the file allows, so that
/// every shortage is flagged.
pub(crate) fn tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    voltage: Option<&VoltageTable>,
    selected: &Selected,
) -> Tolerance {
    let certificate = &selected.certificate;
    // The mixer compares what it computes, not what is: a request that is delivered must not look
    // missed.
    let correction = CorrectionBounds::new(airframe, voltage);
    let rounding = proof::rounding(airframe, &selected.map, &correction);
    tables::tolerance_table(
        [0, 1].map(|k| certificate.reference[k] + rounding[k]),
        wrench_tolerance(airframe, effectiveness, pair, certificate.stated),
    )
}

/// What the units' misses `stated` add up to on each axis, with the rounding of f32 sums of full
/// efforts.
fn wrench_tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    stated: [f64; 2],
) -> [f64; 4] {
    const ROUNDING: f64 = 4e-6;
    let (scale, factors) = (pair.scale(), voltage::largest_factors(airframe));
    let allowed: [f64; 2] = std::array::from_fn(|k| stated[k] + ROUNDING * scale[k] * factors[k]);
    std::array::from_fn(|axis| effectiveness.largest(axis, allowed))
}
