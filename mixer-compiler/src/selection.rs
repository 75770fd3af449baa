//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

mod refusal;

use mixer_rt::tables::Tolerance;

use crate::airframe::Airframe;
use crate::desaturation::attainable::{AreaLoss, Polygon};
use crate::diagnostic::Diagnostic;
use crate::inverse::evaluator::Evaluator;
use crate::inverse::fit::Inversion;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::voltage;
use crate::proof::residual::Residual;
use crate::proof::{self, Certificate, CorrectionBounds};
use crate::tables::{self, InverseTable, MixerTables, VoltageTable};

/// An evaluator with its tables and what is known about them.
#[derive(Clone, Debug)]
pub(crate) struct Selected {
    /// The evaluator.
    pub(crate) evaluator: Evaluator,
    /// The tables; a closed form of desaturation is left open.
    pub(crate) tables: MixerTables,
    /// Share of the attainable set's area that the polygon loses.
    pub(crate) lost_area: AreaLoss,
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
    effectiveness: &Effectiveness,
    voltage: Option<VoltageTable>,
) -> Result<Selected, Vec<Diagnostic>> {
    let voltage = voltage.as_ref();
    choose(airframe, effectiveness, voltage).map_err(|best| {
        let meets = |airframe: &Airframe| choose(airframe, effectiveness, voltage).is_ok();
        vec![match best {
            Some((evaluator, certificate)) => refusal::tolerance(airframe, evaluator, &certificate, meets),
            None => refusal::name(airframe),
        }]
    })
}

/// The evaluator that came closest, and what is proven of it; `None` where there is none of the
/// name asked for.
type Best = Option<(Evaluator, Certificate)>;

/// What the tables of an evaluator are judged by.
struct Judge<'a> {
    airframe: &'a Airframe,
    effectiveness: &'a Effectiveness,
    pair: &'a PairMap,
    polygon: &'a Polygon,
    correction: CorrectionBounds,
}

impl Judge<'_> {
    /// The evaluator with its tables, where they are proven to meet the tolerance. Else what is
    /// proven of them: a proof that is not `thorough` is given up where it takes long.
    fn accept(
        &self,
        evaluator: Evaluator,
        tables: &MixerTables,
        thorough: bool,
        mut residual: Residual,
    ) -> Result<Selected, Certificate> {
        let Judge {
            airframe,
            effectiveness,
            pair,
            polygon,
            correction,
        } = self;
        let certificate = proof::prove(airframe, pair, tables, correction, &mut residual, thorough);
        if !(certificate.holds() && certificate.agrees(&residual)) {
            return Err(certificate);
        }
        Ok(Selected {
            evaluator,
            tables: MixerTables {
                tolerance: proven(airframe, effectiveness, pair, tables, correction, &certificate),
                ..tables.clone()
            },
            lost_area: polygon.lost,
            residual,
            certificate,
        })
    }
}

/// Tries the evaluators by their cost. Where none is proven at once, the one that came closest gets
/// a thorough proof.
fn choose(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    voltage: Option<&VoltageTable>,
) -> Result<Selected, Best> {
    let pair = &PairMap::new(&airframe.pair, &airframe.throttle);
    let polygon = &Polygon::new(pair);
    let correction = CorrectionBounds::new(airframe, voltage);
    let tolerance = tolerance_at_reference(airframe, &correction);
    let judge = Judge {
        airframe,
        effectiveness,
        pair,
        polygon,
        correction,
    };
    let candidates = Evaluator::candidates(&airframe.inverse.method);
    let mut inversion = Inversion::new(pair, tolerance, candidates.len() == 1);
    let mut best: Option<(Evaluator, MixerTables, f64)> = None;
    for evaluator in candidates {
        let (fitted, fit_error) = inversion.fit(evaluator);
        let inverse = InverseTable::new(&fitted);
        let tables = match &best {
            Some((_, tables, _)) => MixerTables {
                inverse,
                ..tables.clone()
            },
            None => MixerTables::new(
                airframe,
                effectiveness,
                pair,
                polygon.table(),
                voltage.cloned(),
                inverse,
            ),
        };
        // The grid of the fit is part of the set: what fails there, fails.
        let error = Residual::coarse_check(pair, &tables)
            .ratio(tolerance)
            .max(fit_error);
        if error <= 1.0 {
            let residual = Residual::over_set(pair, &tables);
            if residual.within(tolerance)
                && let Ok(selected) = judge.accept(evaluator, &tables, false, residual)
            {
                return Ok(selected);
            }
        }
        if best.as_ref().is_none_or(|(_, _, so_far)| error < *so_far) {
            best = Some((evaluator, tables, error));
        }
    }
    let Some((evaluator, tables, _)) = best else {
        return Err(None);
    };
    judge
        .accept(evaluator, &tables, true, Residual::over_set(pair, &tables))
        .map_err(|certificate| Some((evaluator, certificate)))
}

/// The file's tolerance for one unit, at the reference voltage: what remains of it at the voltage
/// where efforts are largest.
fn tolerance_at_reference(airframe: &Airframe, correction: &CorrectionBounds) -> [f64; 2] {
    let inverse = &airframe.inverse;
    let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
    std::array::from_fn(|k| stated[k] / correction.largest[k])
}

/// What the mixer may miss where it delivers: what is proven, not what the file allows, so that
/// every shortage is flagged.
fn proven(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    tables: &MixerTables,
    correction: &CorrectionBounds,
    certificate: &Certificate,
) -> Tolerance {
    // The mixer compares what it computes, not what is: a request that is delivered must not look
    // missed.
    let rounding = proof::rounding(airframe, tables, correction);
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
