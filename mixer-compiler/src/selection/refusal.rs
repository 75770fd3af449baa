//! What a user is told whose tolerance no evaluator meets. What is offered as a mend has been tried.

use super::{Best, choose};
use crate::airframe::{Airframe, Method};
use crate::diagnostic::rounded_up;
use crate::diagnostic::{Code, Diagnostic, number};
use crate::model::effectiveness::Effectiveness;
use crate::tables::VoltageTable;

/// Factors on the bounds that were reached: with other tolerances fits weigh thrust and torque differently, and may
/// come out a little worse.
const FACTORS: [f64; 5] = [1.02, 1.06, 1.15, 1.4, 2.0];

/// The refusal; `best` came closest.
pub(super) fn diagnostic(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    voltage: Option<&VoltageTable>,
    best: Best,
) -> Diagnostic {
    let inverse = &airframe.inverse;
    let Some((evaluator, certificate)) = best else {
        let message = "no evaluator of this name";
        return airframe.diagnostic(
            Code::Tolerance,
            "inverse.method",
            message,
            "",
            "use method = \"auto\"",
        );
    };
    let reached = certificate.stated;
    if !reached.iter().all(|bound| bound.is_finite()) {
        return airframe.diagnostic(
            Code::Tolerance,
            "inverse",
            format!("nothing can be proven of the {}", evaluator.description()),
            "",
            "the map almost folds at the edge of the throttle range: raise throttle.min a little",
        );
    }
    let stated = [inverse.thrust_tolerance_n, inverse.torque_tolerance_nm];
    let (key, missed) = if reached[0] > stated[0] {
        ("inverse.thrust_tolerance_n", format!("{} N", number(stated[0])))
    } else {
        (
            "inverse.torque_tolerance_nm",
            format!("{} N m", number(stated[1])),
        )
    };
    let works = |tolerance: [f64; 2], method: &Method| {
        let mut other = airframe.clone();
        [
            other.inverse.thrust_tolerance_n,
            other.inverse.torque_tolerance_nm,
        ] = tolerance;
        other.inverse.method = method.clone();
        choose(&other, effectiveness, voltage).is_ok()
    };
    let mut mends = Vec::new();
    let offered = FACTORS.into_iter().find_map(|factor| {
        let offered = [0, 1].map(|k| {
            let enough = rounded_up(factor * reached[k]).parse().unwrap_or(f64::INFINITY);
            if reached[k] > stated[k] { enough } else { stated[k] }
        });
        works(offered, &inverse.method).then_some(offered)
    });
    if let Some(offered) = offered {
        let keys = ["thrust_tolerance_n", "torque_tolerance_nm"];
        let raised: Vec<String> = (0..2)
            .filter(|&k| offered[k] != stated[k])
            .map(|k| format!("{} = {:?}", keys[k], offered[k]))
            .collect();
        mends.push(format!("{} would do", raised.join(" with ")));
    }
    let message = match &inverse.method {
        Method::Auto => format!("no evaluator meets a tolerance of {missed}"),
        _ => {
            if works(stated, &Method::Auto) {
                mends.push("method = \"auto\" would do".to_owned());
            }
            format!("`inverse.method` does not meet a tolerance of {missed}")
        }
    };
    if mends.is_empty() {
        mends.push("raise throttle.min a little: the map almost folds, or raise both tolerances".to_owned());
    }
    let [reached_f, reached_q] = reached.map(rounded_up);
    airframe.diagnostic(
        Code::Tolerance,
        key,
        message,
        format!(
            "{} is proven within {reached_f} N and {reached_q} N m",
            evaluator.description()
        ),
        mends.join("; "),
    )
}
