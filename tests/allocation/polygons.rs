//! What the mixer's own polygons allow: answers are the optimum over them where what the polygons
//! leave out decides.

use mixer_rt::{Axis, Health};
use mixer_tests::optimum::Oracle;
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::shortfall::Shortfall;
use proptest::prelude::*;

/// Share by which a barely attainable wrench is drawn inside to be attainable to the mixer, too,
/// whose polygons leave out a little at the border.
const INSIDE: f32 = 0.01;

/// Share of the authority by which an answer may miss the optimum over the mixer's own polygons,
/// rounding, or where the polygons leave out nothing that counts.
const OWN: f64 = 1e-3;

/// Fails where an axis is missed by more than the mixer's tolerance.
pub(crate) fn delivered(frame: &Frame, request: &Request) -> Result<(), TestCaseError> {
    let answer = request.mix(frame).expect("finite");
    let served = frame.served();
    for (index, axis) in Axis::ALL
        .into_iter()
        .enumerate()
        .filter(|(index, _)| served[*index])
    {
        let missed = request.asked()[index] - answer.achieved[index];
        let tolerance = frame.compiled.tables.tolerance.wrench[index];
        prop_assert!(
            missed.abs() <= f64::from(tolerance) * (1.0 + 1e-6),
            "{} misses by {}: {:?} -> {:?}",
            axis.name(),
            missed,
            request,
            answer
        );
    }
    Ok(())
}

/// Fails where more than [`INSIDE`] is missing of what is attainable, or more is given up for that
/// than the priorities demand: where units have little to spare, half a percent of one axis may be
/// worth a tenth of another. So the wrench that much nearer to that of half throttles must be
/// delivered, and the answer be the optimum over the mixer's own polygons.
pub(crate) fn little_is_missed(
    frame: &Frame,
    request: &Request,
    answer: &Answer,
) -> Result<(), TestCaseError> {
    let halves = frame.physics.throttles(std::iter::repeat(0.5), request.health);
    let middle = frame.physics.wrench(&halves, request.volts);
    let mut inside = *request;
    for (value, middle) in inside.wrench.iter_mut().zip(middle) {
        *value += INSIDE * (middle as f32 - *value);
    }
    delivered(frame, &inside)?;
    let [hulls, exact] = [Oracle::of_polygons, Oracle::of_exact_polygons]
        .map(|oracle| move || oracle(frame, request.volts, request.health));
    let shortfall = Shortfall::beyond_hulls(answer, request, frame, OWN, &hulls(), exact)
        .map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))?;
    prop_assert!(
        shortfall.is_none_or(|shortfall| shortfall.largest() <= OWN),
        "{:?} of the polygons': {:?} -> {:?}",
        shortfall,
        request,
        answer
    );
    Ok(())
}

/// Holds the answer to the optimum by `oracle`: over the mixer's own polygons, or, which is more,
/// over their convex hulls or what is physically attainable.
pub(crate) fn assert_is_optimal(frame: &Frame, request: &Request, oracle: fn(&Frame, f32, Health) -> Oracle) {
    let answer = request.mix(frame).expect("finite");
    let oracle = oracle(frame, request.volts, request.health);
    let shortfall = Shortfall::of(&answer, request, frame, &oracle).expect("solved");
    assert!(
        shortfall.is_some_and(|shortfall| shortfall.largest() < OWN),
        "{shortfall:?}: {answer:?}"
    );
}
