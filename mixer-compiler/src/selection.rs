//! Choice of the evaluator: the cheapest whose emitted tables are proven to meet the tolerance.

use mixer_rt::{Desaturation, Tolerance};

use crate::airframe::{Airframe, Method};
use crate::attainable::{AreaLoss, ConvexPart};
use crate::diagnostic::{Code, Diagnostic, number};
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
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let correction = Correction::new(airframe, voltage.as_ref());
    let tolerance = tolerance_at_reference(airframe, &correction);
    let candidates = Evaluator::candidates(&airframe.inverse.method, airframe.pair.basis);
    let mut inversion = Inversion::new(&pair, tolerance, candidates.len() == 1);
    let convex = ConvexPart::new(&pair);
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
                &convex,
                voltage.clone(),
                inverse,
                tolerance,
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
                    return Ok(Selected {
                        evaluator,
                        tables,
                        lost_area: convex.lost,
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
    Err(vec![refusal(airframe, &pair, &correction, best)])
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
    convex: &ConvexPart,
    voltage: Option<VoltageTable>,
    inverse: InverseTable,
    tolerance: [f64; 2],
) -> MixerTables {
    let units = tables::unit_tables(airframe, effectiveness);
    MixerTables {
        units,
        pair: tables::pair_table(airframe),
        inverse,
        throttle: tables::throttle_table(airframe),
        voltage,
        attainable: convex.table(),
        desaturation: Desaturation {
            airmode: airframe.allocation.airmode,
            yaw_reserve_nm: airframe.allocation.yaw_reserve_nm as f32,
        },
        shortcut: None,
        tolerance: Tolerance {
            efforts: tolerance.map(|x| x as f32),
            wrench: wrench_tolerance(airframe, effectiveness, pair),
        },
    }
}

/// What the tolerances of all units add up to on each axis, with the rounding of f32 sums of full efforts.
fn wrench_tolerance(airframe: &Airframe, effectiveness: &Effectiveness, pair: &PairMap) -> [f32; 4] {
    const ROUNDING: f64 = 4e-6;
    let (scale, factors) = (pair.scale(), voltage::largest_factors(airframe));
    let n = airframe.units.len();
    let stated = [
        airframe.inverse.thrust_tolerance_n,
        airframe.inverse.torque_tolerance_nm,
    ];
    let allowed: [f64; 2] = std::array::from_fn(|k| stated[k] + ROUNDING * scale[k] * factors[k]);
    std::array::from_fn(|axis| {
        let row = effectiveness.matrix.row(axis);
        let sum: f64 = (0..n)
            .map(|i| row[i].abs() * allowed[0] + row[n + i].abs() * allowed[1])
            .sum();
        sum as f32
    })
}

fn refusal(
    airframe: &Airframe,
    pair: &PairMap,
    correction: &Correction,
    best: Option<(Evaluator, MixerTables, f64)>,
) -> Diagnostic {
    let inverse = &airframe.inverse;
    let Some((evaluator, tables, _)) = best else {
        let message = "no evaluator of this name";
        return airframe.diagnostic(
            Code::Tolerance,
            "inverse.method",
            message,
            "",
            "use method = \"auto\"",
        );
    };
    let mut residual = Residual::over_set(pair, &tables);
    let reached = proof::prove(airframe, pair, &tables, correction, &mut residual, true).stated;
    if !reached.iter().all(|bound| bound.is_finite()) {
        return airframe.diagnostic(
            Code::Tolerance,
            "inverse",
            format!("nothing can be proven of the {}", evaluator.description()),
            "",
            "the map almost folds at the edge of the throttle range: raise throttle.min a little",
        );
    }
    let (key, missed) = if reached[0] > inverse.thrust_tolerance_n {
        (
            "inverse.thrust_tolerance_n",
            format!("{} N", number(inverse.thrust_tolerance_n)),
        )
    } else {
        (
            "inverse.torque_tolerance_nm",
            format!("{} N m", number(inverse.torque_tolerance_nm)),
        )
    };
    // Fits weigh thrust against torque by the tolerances: with both raised alike the same fit is found, but for the
    // rounding of the numbers below.
    let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
    let share = (reached[0] / stated[0]).max(reached[1] / stated[1]) * 1.01;
    let [offered_f, offered_q] = stated.map(|tolerance| crate::report::rounded_up(share * tolerance));
    let [reached_f, reached_q] = reached.map(crate::report::rounded_up);
    let (message, other) = match &inverse.method {
        Method::Auto => (format!("no evaluator meets a tolerance of {missed}"), ""),
        _ => (
            format!("`inverse.method` does not meet a tolerance of {missed}"),
            ", or method = \"auto\"",
        ),
    };
    airframe.diagnostic(
        Code::Tolerance,
        key,
        message,
        format!(
            "{} is proven within {reached_f} N and {reached_q} N m",
            evaluator.description()
        ),
        format!("thrust_tolerance_n = {offered_f} with torque_tolerance_nm = {offered_q} would do{other}"),
    )
}
