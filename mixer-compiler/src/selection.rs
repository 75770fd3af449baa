//! Choice of the evaluator: the cheapest whose emitted tables meet the tolerance.

use mixer_rt::{Airmode, Desaturation, Tolerance};

use crate::airframe::Airframe;
use crate::attainable;
use crate::diagnostic::{Code, Diagnostic};
use crate::effectiveness::Effectiveness;
use crate::evaluator::Evaluator;
use crate::inversion::Inversion;
use crate::model::PairMap;
use crate::residual::Residual;
use crate::tables::{self, InverseTable, MixerTables, VoltageTable};
use crate::voltage;

/// The tables with the cheapest evaluator that meets the file's tolerance at every voltage. Desaturation's limits
/// are left open.
///
/// # Errors
/// No evaluator meets the tolerance; the best residual reached.
pub(crate) fn select(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    voltage: Option<VoltageTable>,
) -> Result<(MixerTables, Evaluator, Residual), Vec<Diagnostic>> {
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    let tolerance = tolerance_at_reference(airframe, &pair);
    let mut inversion = Inversion::new(&pair, tolerance);
    let mut best: Option<(Evaluator, Residual)> = None;
    let mut tables: Option<MixerTables> = None;
    for evaluator in Evaluator::candidates(&airframe.inverse.method) {
        let (fitted, fit_error) = inversion.fit(evaluator);
        let inverse = InverseTable::new(&fitted);
        let tables = match &mut tables {
            Some(tables) => {
                tables.inverse = inverse;
                tables
            }
            None => tables.insert(assemble(
                airframe,
                effectiveness,
                &pair,
                voltage.clone(),
                inverse,
                tolerance,
            )),
        };
        // The grid of the fit is part of the set: what fails there, fails.
        let mut residual = Residual::at_a_glance(&pair, tables);
        if fit_error <= 1.0 && residual.within(tolerance) {
            residual = Residual::over_set(&pair, tables);
            if residual.within(tolerance) {
                return Ok((tables.clone(), evaluator, residual));
            }
        }
        if best.is_none_or(|(_, so_far)| residual.ratio(tolerance) < so_far.ratio(tolerance)) {
            best = Some((evaluator, residual));
        }
    }
    Err(vec![refusal(airframe, best)])
}

/// The file's tolerance for one unit, at the reference voltage: what remains of it at the voltage where efforts are
/// largest, after the error of the voltage table.
fn tolerance_at_reference(airframe: &Airframe, pair: &PairMap) -> [f64; 2] {
    let factors = voltage::largest_factors(airframe);
    let scale = pair.scale();
    let inverse = &airframe.inverse;
    let table = if airframe.voltage.is_some() {
        voltage::FIT_TOLERANCE
    } else {
        0.0
    };
    let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
    std::array::from_fn(|k| stated[k] / factors[k] - table * scale[k])
}

/// Rounds everything but desaturation's limits.
fn assemble(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
    voltage: Option<VoltageTable>,
    inverse: InverseTable,
    tolerance: [f64; 2],
) -> MixerTables {
    let units = tables::unit_tables(airframe, effectiveness);
    let attainable = attainable::polygon(pair)
        .into_iter()
        .map(|vertex| vertex.map(|x| x as f32))
        .collect();
    MixerTables {
        units,
        pair: tables::pair_table(airframe),
        inverse,
        throttle: tables::throttle_table(airframe),
        voltage,
        attainable,
        desaturation: Desaturation {
            airmode: Airmode::Disabled,
            thrust_floor_n: 0.0,
            thrust_anchor_n: 0.0,
            thrust_ceiling_n: 0.0,
            yaw_reserve_nm: 0.0,
        },
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

fn refusal(airframe: &Airframe, best: Option<(Evaluator, Residual)>) -> Diagnostic {
    let inverse = &airframe.inverse;
    let (f, q) = (inverse.thrust_tolerance_n, inverse.torque_tolerance_nm);
    let Some((evaluator, residual)) = best else {
        return airframe.diagnostic(
            Code::Tolerance,
            "inverse.method",
            "no evaluator to try".to_owned(),
            "",
            "",
        );
    };
    let factors = voltage::largest_factors(airframe);
    let reached: [f64; 2] = std::array::from_fn(|k| residual.efforts[k] * factors[k]);
    let (key, missed) = if reached[0] > f {
        (
            "inverse.thrust_tolerance_n",
            format!("thrust_tolerance_n = {f:?} N"),
        )
    } else {
        (
            "inverse.torque_tolerance_nm",
            format!("torque_tolerance_nm = {q:?} N m"),
        )
    };
    let [reached_f, reached_q] = reached.map(crate::report::rounded_up);
    airframe.diagnostic(
        Code::Tolerance,
        key,
        format!("no evaluator that inverse.method allows meets {missed}"),
        format!("{} leaves {reached_f} N, {reached_q} N m", evaluator.description()),
        format!(
            "thrust_tolerance_n = {reached_f} and torque_tolerance_nm = {reached_q} would do; method = \"auto\" has the most choice"
        ),
    )
}
