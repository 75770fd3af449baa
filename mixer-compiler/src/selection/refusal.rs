//! The refusal of a tolerance that no evaluator meets, with what is proven.

use crate::airframe::{Method, Pair};
use crate::diagnostic::{Code, Diagnostic, number, rounded_up};
use crate::inverse::evaluator::Evaluator;
use crate::model::injectivity::EnclosedPairMap;
use crate::proof::Certificate;
use crate::view::View;

/// An idle below this many times the least at which the map can be inverted is near the fold, where
/// the inverse is steep. Real maps compile from 1.03 times on.
const NEAR_FOLD: f64 = 1.1;

/// The refusal of a tolerance. `evaluator` came closest, with what is proven of it.
pub(super) fn tolerance(
    view: &View<'_, &Pair>,
    evaluator: Evaluator,
    certificate: &Certificate,
) -> Diagnostic {
    let inverse = &view.inverse;
    let reached = certificate.stated;
    let stated = inverse.tolerances();
    let least = EnclosedPairMap::new(view.of).least_idle(view.throttle.max);
    let idle = least
        .filter(|least| view.throttle.min < NEAR_FOLD * least)
        .map(|least| {
            format!(
                "the map folds just below this idle, at {}: raise throttle.min to {} or more",
                number((1e4 * least).ceil() / 1e4),
                number((1e3 * NEAR_FOLD * least).ceil() / 1e3)
            )
        });
    let missed = match reached[0] > stated[0] {
        true => ("inverse.thrust_tolerance_n", format!("{} N", number(stated[0]))),
        false => (
            "inverse.torque_tolerance_nm",
            format!("{} N m", number(stated[1])),
        ),
    };
    let key = match &idle {
        Some(_) if !view.states(missed.0) => "throttle.min",
        _ => missed.0,
    };
    if !reached.iter().all(|bound| bound.is_finite()) {
        return view.diagnostic(
            Code::Tolerance,
            "throttle.min",
            format!("nothing can be proven of the {}", evaluator.description()),
            "",
            idle.unwrap_or_else(|| {
                "the map almost folds at the edge of the throttle range: raise throttle.min or lower throttle.max".to_owned()
            }),
        );
    }
    let (message, other) = match inverse.method {
        Method::Auto => ("no evaluator meets", "raise the tolerance above what is proven"),
        _ => (
            "`inverse.method` does not meet",
            "method = \"auto\", or a tolerance above what is proven",
        ),
    };
    let [reached_f, reached_q] = reached.map(rounded_up);
    view.diagnostic(
        Code::Tolerance,
        key,
        format!("{message} a tolerance of {}", missed.1),
        format!(
            "{} is proven within {reached_f} N and {reached_q} N m",
            evaluator.description()
        ),
        idle.unwrap_or_else(|| other.to_owned()),
    )
}
