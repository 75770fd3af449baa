//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

mod refusal;

use mixer_rt::{Axis, Desaturation, Tolerance};

use crate::airframe::Airframe;
use crate::attainable::{AreaLoss, Polygon};
use crate::diagnostic::Diagnostic;
use crate::effectiveness::Effectiveness;
use crate::evaluator::Evaluator;
use crate::inversion::Inversion;
use crate::model::PairMap;
use crate::proof::{self, Certificate, Correction};
use crate::residual::Residual;
use crate::tables::{self, InverseTable, MixerTables, VoltageTable};
use crate::voltage;

/// An evaluator with its tables and what is known about them.
#[derive(Clone, Debug)]
pub(crate) struct Selected {
    /// The evaluator.
    pub(crate) evaluator: Evaluator,
    /// The tables; a shortcut of desaturation is left open.
    pub(crate) tables: MixerTables,
    /// What the polygon leaves out.
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
    choose(airframe, effectiveness, voltage.as_ref()).map_err(|best| {
        vec![refusal::diagnostic(
            airframe,
            effectiveness,
            voltage.as_ref(),
            best,
        )]
    })
}

/// The evaluator that came closest, and what is proven of it; `None` where there is none of the name asked for.
type Best = Option<(Evaluator, Certificate)>;

fn choose(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    voltage: Option<&VoltageTable>,
) -> Result<Selected, Best> {
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let correction = Correction::new(airframe, voltage);
    let tolerance = tolerance_at_reference(airframe, &correction);
    let candidates = Evaluator::candidates(&airframe.inverse.method, airframe.pair.basis);
    let mut inversion = Inversion::new(&pair, tolerance, candidates.len() == 1);
    let polygon = Polygon::new(&pair);
    let mut best: Option<(Evaluator, MixerTables, f64)> = None;
    for evaluator in candidates {
        let (fitted, fit_error) = inversion.fit(evaluator);
        let inverse = InverseTable::new(&fitted);
        let tables = match &best {
            Some((_, tables, _)) => MixerTables {
                inverse,
                ..tables.clone()
            },
            None => assemble(
                airframe,
                effectiveness,
                &pair,
                &polygon,
                voltage.cloned(),
                inverse,
            ),
        };
        // The grid of the fit is part of the set: what fails there, fails.
        let glance = Residual::at_a_glance(&pair, &tables)
            .ratio(tolerance)
            .max(fit_error);
        if glance <= 1.0 {
            let mut residual = Residual::over_set(&pair, &tables);
            if residual.within(tolerance) {
                let certificate = proof::prove(airframe, &pair, &tables, &correction, &mut residual, false);
                if certificate.holds() && certificate.agrees(&residual) {
                    let tolerance =
                        proven(airframe, effectiveness, &pair, &tables, &correction, &certificate);
                    return Ok(Selected {
                        evaluator,
                        tables: MixerTables { tolerance, ..tables },
                        lost_area: polygon.lost,
                        residual,
                        certificate,
                    });
                }
            }
        }
        if best.as_ref().is_none_or(|(_, _, so_far)| glance < *so_far) {
            best = Some((evaluator, tables, glance));
        }
    }
    let Some((evaluator, tables, _)) = best else {
        return Err(None);
    };
    // Proofs above were given up where they took long.
    let mut residual = Residual::over_set(&pair, &tables);
    let certificate = proof::prove(airframe, &pair, &tables, &correction, &mut residual, true);
    if certificate.holds() && certificate.agrees(&residual) {
        let tolerance = proven(airframe, effectiveness, &pair, &tables, &correction, &certificate);
        return Ok(Selected {
            evaluator,
            tables: MixerTables { tolerance, ..tables },
            lost_area: polygon.lost,
            residual,
            certificate,
        });
    }
    Err(Some((evaluator, certificate)))
}

/// The file's tolerance for one unit, at the reference voltage: what remains of it at the voltage where efforts are
/// largest.
fn tolerance_at_reference(airframe: &Airframe, correction: &Correction) -> [f64; 2] {
    let inverse = &airframe.inverse;
    let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
    std::array::from_fn(|k| stated[k] / correction.largest[k])
}

/// Rounds everything.
fn assemble(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    polygon: &Polygon,
    voltage: Option<VoltageTable>,
    inverse: InverseTable,
) -> MixerTables {
    MixerTables {
        units: tables::unit_tables(airframe, effectiveness),
        pair: tables::pair_table(airframe),
        singles: tables::single_tables(airframe),
        inverse,
        throttle: tables::throttle_table(airframe),
        voltage,
        attainable: polygon.table(),
        rows: rows(airframe, effectiveness, pair),
        level: None,
        desaturation: Desaturation {
            airmode: airframe.allocation.airmode,
            yaw_reserve_nm: airframe.allocation.yaw_reserve_nm as f32,
        },
        shortcut: None,
        tolerance: Tolerance {
            efforts: [0.0; 2],
            wrench: [0.0; 4],
        },
    }
}

/// Units over authority per axis at the reference voltage, roll and pitch alike; 0 on axes that are not served.
fn rows(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> [f32; 4] {
    let scale = pair.scale();
    let n = airframe.units.len();
    let authority: [f64; 4] = std::array::from_fn(|axis| {
        let row = effectiveness.matrix.row(axis);
        let sum: f64 = (0..n)
            .map(|i| row[i].abs() * scale[0] + row[n + i].abs() * scale[1])
            .sum();
        if airframe.allocation.controls(Axis::ALL[axis]) {
            sum
        } else {
            0.0
        }
    });
    let level = authority[0].max(authority[1]);
    std::array::from_fn(|axis| {
        let size = if axis < 2 { level } else { authority[axis] };
        if authority[axis] > 0.0 {
            (n as f64 / size) as f32
        } else {
            0.0
        }
    })
}

/// What the mixer may miss where it delivers: what is proven, not what the file allows, so that every shortage is flagged.
fn proven(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    tables: &MixerTables,
    correction: &Correction,
    certificate: &Certificate,
) -> Tolerance {
    // The mixer compares what it computes, not what is: a request that is delivered must not look missed.
    let rounding = proof::rounding(airframe, tables, correction);
    Tolerance {
        efforts: [0, 1].map(|k| ((certificate.reference[k] + rounding[k]) as f32).next_up()),
        wrench: wrench_tolerance(airframe, effectiveness, pair, certificate.stated),
    }
}

/// What the units' misses `stated` add up to on each axis, with the rounding of f32 sums of full efforts.
fn wrench_tolerance(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    stated: [f64; 2],
) -> [f32; 4] {
    const ROUNDING: f64 = 4e-6;
    let (scale, factors) = (pair.scale(), voltage::largest_factors(airframe));
    let n = airframe.units.len();
    let allowed: [f64; 2] = std::array::from_fn(|k| stated[k] + ROUNDING * scale[k] * factors[k]);
    std::array::from_fn(|axis| {
        let row = effectiveness.matrix.row(axis);
        let sum: f64 = (0..n)
            .map(|i| row[i].abs() * allowed[0] + row[n + i].abs() * allowed[1])
            .sum();
        sum as f32
    })
}
