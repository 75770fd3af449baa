//! The refusal of a tolerance that no evaluator meets. Every mend that it offers has been tried.

use crate::airframe::{Airframe, Method};
use crate::diagnostic::{Code, Diagnostic, number, rounded_up};
use crate::inverse::evaluator::Evaluator;
use crate::model::injectivity::EnclosedPairMap;
use crate::proof::Certificate;

/// Factors on the bounds that were reached: with other tolerances fits weigh thrust and torque
/// differently, and may come out a little worse.
const FACTORS: [f64; 5] = [1.02, 1.06, 1.15, 1.4, 2.0];

/// Factors on the least idle at which the map can be inverted. All fits of ten real maps compile at
/// the first; an idle above the last is not near the fold.
const IDLES: [f64; 2] = [1.03, 1.1];

/// The least of [`IDLES`] above the file's own that meets the tolerances, upwards to 1e-4; `None`
/// far from the fold.
fn better_idle(airframe: &Airframe, meets: impl Fn(&Airframe) -> bool) -> Option<f64> {
    let least = EnclosedPairMap::new(&airframe.pair).least_idle(airframe.throttle.max)?;
    IDLES
        .into_iter()
        .map(|factor| (1e4 * factor * least).ceil() / 1e4)
        .filter(|idle| (airframe.throttle.min..airframe.throttle.max).contains(idle))
        .find(|&idle| {
            let mut other = airframe.clone();
            other.throttle.min = idle;
            meets(&other)
        })
}

/// The refusal of a tolerance. `evaluator` came closest, with what is proven of it; `meets` tells
/// whether another airframe would compile.
pub(super) fn tolerance(
    airframe: &Airframe,
    evaluator: Evaluator,
    certificate: &Certificate,
    meets: impl Fn(&Airframe) -> bool,
) -> Diagnostic {
    let inverse = &airframe.inverse;
    let reached = certificate.stated;
    let idle = better_idle(airframe, &meets);
    let idle_mend =
        idle.map(|idle| format!("the map almost folds at this idle: throttle.min = {idle:?} would do"));
    if !reached.iter().all(|bound| bound.is_finite()) {
        return airframe.diagnostic(
            Code::Tolerance,
            "throttle.min",
            format!("nothing can be proven of the {}", evaluator.description()),
            "",
            idle_mend.unwrap_or_else(|| {
                "the map almost folds at the edge of the throttle range: raise throttle.min or lower throttle.max".to_owned()
            }),
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
    let key = if idle.is_some() && !airframe.states(key) {
        "throttle.min"
    } else {
        key
    };
    let works = |tolerance: [f64; 2], method: Method| {
        let mut other = airframe.clone();
        [
            other.inverse.thrust_tolerance_n,
            other.inverse.torque_tolerance_nm,
        ] = tolerance;
        other.inverse.method = method;
        meets(&other)
    };
    let mut mends: Vec<String> = idle_mend.into_iter().collect();
    if idle.is_none() {
        // Where an idle does, the tolerance is not at fault.
        mends.extend(raised_tolerances(stated, reached, |offered| {
            works(offered, inverse.method)
        }));
    }
    let message = match inverse.method {
        Method::Auto => format!("no evaluator meets a tolerance of {missed}"),
        _ => {
            if works(stated, Method::Auto) {
                mends.push("method = \"auto\" would do".to_owned());
            }
            format!("`inverse.method` does not meet a tolerance of {missed}")
        }
    };
    if mends.is_empty() {
        mends.push("raise both tolerances".to_owned());
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

/// The least raise of the tolerances that are missed which `works`, in words.
fn raised_tolerances(
    stated: [f64; 2],
    reached: [f64; 2],
    works: impl Fn([f64; 2]) -> bool,
) -> Option<String> {
    let offered = FACTORS.into_iter().find_map(|factor| {
        let offered = [0, 1].map(|k| {
            let enough = rounded_up(factor * reached[k]).parse().unwrap_or(f64::INFINITY);
            if reached[k] > stated[k] { enough } else { stated[k] }
        });
        works(offered).then_some(offered)
    })?;
    let keys = ["thrust_tolerance_n", "torque_tolerance_nm"];
    let raised: Vec<String> = (0..2)
        .filter(|&k| offered[k] != stated[k])
        .map(|k| format!("{} = {:?}", keys[k], offered[k]))
        .collect();
    Some(format!("{} would do", raised.join(" with ")))
}
