//! Rules on what the mixer is asked to keep: tolerances and the reserve of yaw.

use mixer_rt::tables::REQUEST_LIMIT;

use super::facts::Facts;
use crate::airframe::{Airframe, Axis};
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::model::effectiveness::Effectiveness;
use crate::model::{PairMap, voltage};

/// Share of a unit's largest effort above which a tolerance is a mistake.
const WIDE: f64 = 0.01;

/// Share above which it is refused. The evaluators are fitted to the tolerance; nothing is left to
/// fit to here.
const ABSURD: f64 = 0.1;

/// The tolerances as `[key, unit, tolerance, largest effort]`.
fn each(airframe: &Airframe, scale: [f64; 2]) -> [(&'static str, &'static str, f64, f64); 2] {
    let inverse = &airframe.inverse;
    [
        (
            "inverse.thrust_tolerance_n",
            "N",
            inverse.thrust_tolerance_n,
            scale[0],
        ),
        (
            "inverse.torque_tolerance_nm",
            "N m",
            inverse.torque_tolerance_nm,
            scale[1],
        ),
    ]
}

fn diagnostic(
    airframe: &Airframe,
    code: Code,
    (key, unit, tolerance, largest): (&str, &str, f64, f64),
    most: f64,
) -> Diagnostic {
    // A percentage beyond the largest float is written as a bound.
    let percent = match 100.0 * (tolerance / largest) {
        percent if percent.is_finite() => format!("{} %", rounded(percent)),
        _ => "more than 1e308 %".to_owned(),
    };
    airframe.diagnostic(
        code,
        key,
        format!(
            "a tolerance of {} {unit} is {percent} of a unit's largest effort, {} {unit}",
            number(tolerance),
            rounded(largest)
        ),
        format!("expected at most {} %", number(100.0 * most)),
        "the defaults are 0.01 N and 0.0001 N m",
    )
}

/// Whether the file states a tolerance above a tenth of the largest effort.
fn is_absurd(airframe: &Airframe, (key, _, tolerance, largest): (&str, &str, f64, f64)) -> bool {
    largest > 0.0 && tolerance > ABSURD * largest && airframe.states(key)
}

/// Tolerances above a tenth of the largest effort.
pub(super) fn absurd_tolerances(airframe: &Airframe, pair: &PairMap) -> Vec<Diagnostic> {
    each(airframe, pair.scale())
        .into_iter()
        .filter(|tolerance| is_absurd(airframe, *tolerance))
        .map(|tolerance| diagnostic(airframe, Code::ToleranceAbsurd, tolerance, ABSURD))
        .collect()
}

/// An axis of which the rotors give more, at the voltage where they give most, than requests are
/// limited to.
pub(super) fn authority(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
) -> Option<Diagnostic> {
    let limit = f64::from(REQUEST_LIMIT);
    let (scale, factors) = (pair.scale(), voltage::largest_factors(airframe));
    let efforts = [0, 1].map(|k| factors[k] * scale[k]);
    let most = |axis: Axis| effectiveness.largest(axis as usize, efforts);
    let axis = Axis::ALL.into_iter().rev().find(|axis| most(*axis) > limit)?;
    let unit = if axis == Axis::Thrust { "N" } else { "N m" };
    Some(airframe.diagnostic(
        Code::Authority,
        if axis == Axis::Yaw {
            "pair.torque_nm"
        } else {
            "pair.thrust_n"
        },
        format!(
            "the rotors give {} {unit} of {axis}; requests are limited to {} {unit}",
            rounded(most(axis)),
            number(limit)
        ),
        "",
        "expected thrusts in newtons, torques in newton metres and positions in metres",
    ))
}

/// Tolerances above a hundredth of the largest effort that are no errors.
pub(super) fn tolerances(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let wide = each(facts.airframe, facts.scale)
        .into_iter()
        .filter(|(_, _, tolerance, largest)| *tolerance > WIDE * largest)
        .filter(|tolerance| !is_absurd(facts.airframe, *tolerance));
    found.extend(wide.map(|tolerance| diagnostic(facts.airframe, Code::WideTolerance, tolerance, WIDE)));
}

/// A reserve of yaw that no throttles give, whatever the thrust.
pub(super) fn yaw_reserve(facts: &Facts<'_>, found: &mut Vec<Diagnostic>) {
    let reserve = facts.airframe.allocation.yaw_reserve_nm;
    if reserve == 0.0 {
        return;
    }
    let Some(effectiveness) = facts.effectiveness else {
        return;
    };
    let row = effectiveness.matrix.row(Axis::Yaw as usize);
    let units = facts.airframe.units.len();
    let efforts: Vec<[f64; 2]> = facts
        .map
        .border(32)
        .into_iter()
        .map(|at| facts.map.efforts(at))
        .collect();
    // The furthest that each unit takes yaw to either side, all units together.
    let furthest = |sign: f64| -> f64 {
        (0..units)
            .map(|i| {
                let yaw = efforts
                    .iter()
                    .map(|[f, q]| sign * (row[i] * f + row[units + i] * q));
                yaw.fold(f64::NEG_INFINITY, f64::max)
            })
            .sum()
    };
    let authority = furthest(1.0).min(furthest(-1.0));
    if reserve <= authority {
        return;
    }
    found.push(facts.airframe.diagnostic(
        Code::YawReserveBeyond,
        "allocation.yaw_reserve_nm",
        format!(
            "a yaw reserve of {} N m is beyond the authority of {} N m, at whatever thrust",
            number(reserve),
            rounded(authority.max(0.0))
        ),
        "never available",
        format!(
            "all of yaw then comes before thrust; a tenth of the authority is {} N m",
            rounded(0.1 * authority.max(0.0))
        ),
    ));
}
