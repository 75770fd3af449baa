//! Tolerances that are wide or absurd, and rotors of absurd authority.

use mixer_rt::tables::REQUEST_LIMIT;

use super::rule::{KindFacts, Rule};
use crate::airframe::{Airframe, Axis, Kind};
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::model::effectiveness::Effectiveness;
use crate::model::{PairMap, law, scales};
use crate::view::View;

/// Share of a unit's largest effort above which a tolerance is a mistake.
const WIDE: f64 = 0.01;

/// Share above which one that the file states is refused. The evaluators are fitted to the tolerance;
/// nothing is left to fit to here.
const ABSURD: f64 = 0.1;

/// Rules on the tolerances beside the largest efforts of a unit, N and N m.
fn tolerances(airframe: &Airframe, scale: [f64; 2]) -> impl Iterator<Item = Rule> {
    let inverse = &airframe.inverse;
    let stated = [
        ("inverse.thrust_tolerance_n", "N", inverse.thrust_tolerance_n),
        ("inverse.torque_tolerance_nm", "N m", inverse.torque_tolerance_nm),
    ];
    stated.into_iter().zip(scale).map(|((key, unit, stated), largest)| {
        let is_absurd = largest > 0.0 && stated > ABSURD * largest && airframe.states(key);
        let (code, most) = match is_absurd {
            true => (Code::ToleranceAbsurd, ABSURD),
            false => (Code::WideTolerance, WIDE),
        };
        // A percentage beyond the largest float is written as a bound.
        let percent = match 100.0 * (stated / largest) {
            percent if percent.is_finite() => format!("{} %", rounded(percent)),
            _ => "more than 1e308 %".to_owned(),
        };
        let [stated_as, largest_as] = [number(stated), rounded(largest)];
        Rule::at_most(code, key, stated, most * largest).says(
            format!("a tolerance of {stated_as} {unit} is {percent} of a unit's largest effort, {largest_as} {unit}"),
            format!("expected at most {} %", number(100.0 * most)),
            "the defaults are 0.01 N and 0.0001 N m",
        )
    })
}

/// Tolerances above a hundredth of the largest effort that are no errors.
pub(super) fn wide_tolerances(facts: &KindFacts<'_>) -> Vec<Rule> {
    let rules = tolerances(&facts.view, facts.scale);
    rules.filter(|rule| rule.code == Code::WideTolerance).collect()
}

/// Refuses tolerances that are too wide to mean anything.
///
/// # Errors
/// A tolerance above a tenth of a unit's largest effort.
pub(crate) fn check_tolerances(view: &View<'_, Kind<'_>>) -> Result<(), Vec<Diagnostic>> {
    let rules = tolerances(view, PairMap::of_kind(view.of, &view.throttle).scale());
    let absurd = rules.filter(|rule| rule.code == Code::ToleranceAbsurd);
    let faults: Vec<Diagnostic> = absurd.filter_map(|rule| rule.told_of(view)).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Refuses rotors that give more of an axis, under the conditions where they give most, than requests are
/// limited to: what is beyond would be attainable and never be given.
///
/// # Errors
/// The first such axis.
pub(crate) fn check_authority(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
) -> Result<(), Vec<Diagnostic>> {
    let limit = f64::from(REQUEST_LIMIT);
    let efforts = scales(airframe, law::largest_factors(airframe));
    let most = |axis: Axis| effectiveness.largest(axis as usize, &efforts);
    let Some(axis) = Axis::ALL.into_iter().rev().find(|axis| most(*axis) > limit) else {
        return Ok(());
    };
    let unit = if axis == Axis::Thrust { "N" } else { "N m" };
    let key = if axis == Axis::Yaw {
        "torque_nm"
    } else {
        "thrust_n"
    };
    let word = if airframe.pairs.is_empty() {
        "rotor[0]"
    } else {
        "pair"
    };
    let key = format!("{word}.{key}");
    Err(vec![airframe.diagnostic(
        Code::Authority,
        &key,
        format!(
            "the rotors give {} {unit} of {axis}; requests are limited to {} {unit}",
            rounded(most(axis)),
            number(limit)
        ),
        "",
        "expected thrusts in newtons, torques in newton metres and positions in metres",
    )])
}
