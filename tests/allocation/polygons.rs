//! What the mixer's own polygons allow: answers are the optimum over them where what the polygons
//! leave out decides.

use mixer_rt::{Axis, Health};
use mixer_tests::optimum::Oracle;
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::shortfall::Shortfall;
use proptest::prelude::*;

use crate::compile;
use crate::{all_rotors, place};

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

/// [`little_is_missed`] of a request with all rotors.
fn assert_little_is_missed(frame: &Frame, wrench: [f32; 4], volts: f32) {
    let request = all_rotors(wrench, volts);
    let answer = request.mix(frame).expect("finite");
    little_is_missed(frame, &request, &answer).unwrap_or_else(|fault| panic!("{fault}"));
}

/// Barely attainable, where what the polygons leave out is little of yaw or of (roll, pitch) and
/// worth a percent of thrust, and where their convex hulls leave out less: the answer is the
/// optimum over the polygons, which are what the mixer has.
#[test]
fn nothing_is_missed_that_only_the_hulls_of_the_polygons_have() {
    let two = [
        place([-0.63924, -0.14219, 0.0], [0.07334, -0.01800], true),
        place([0.48277, 0.18332, 0.0], [0.0, -0.05576], false),
    ];
    let three = [
        place([-0.15992, -0.02534, 0.0], [-0.03666, -0.07061], true),
        place([0.22541, -0.13412, -0.03095], [-0.13222, -0.05980], false),
        place([0.19395, 0.20133, 0.02447], [-0.10568, 0.14080], false),
    ];
    for (frame, shares) in [
        (
            compile(&two, "roll-pitch-yaw", 0.0),
            vec![0.404_554_188, 0.0, 0.617_469_090, 1.0],
        ),
        (
            compile(&three, "disabled", 0.0),
            vec![1.0, 0.0, 0.0, 0.325_254_902, 0.359_750_873, 1.0],
        ),
    ] {
        let throttles = frame.physics.throttles(shares.into_iter(), Health::GOOD);
        let volts = 12.8;
        let wrench = frame.physics.wrench(&throttles, volts).map(|value| value as f32);
        assert_little_is_missed(&frame, wrench, volts);
    }
}

/// A ten-millionth of roll and pitch is worth a tenth of a percent of thrust here, which is not for
/// the oracle to take.
#[test]
fn the_optimum_gives_up_nothing_of_roll_and_pitch_for_thrust() {
    let three = [
        place(
            [-0.259_897_257_956, -0.417_253_956_1, 0.0],
            [-0.144_622_61, 0.0],
            true,
        ),
        place([0.049_971_994_351, -0.001_673_254_482, 0.0], [0.0, 0.0], false),
        place([-0.094_147_665_147, 0.176_454_575_308, 0.0], [0.0, 0.0], false),
    ];
    let frame = compile(&three, "disabled", 0.0);
    let asked = [3.393_982_6, -5.685_069, -0.801_756_44, 44.120_895];
    assert_little_is_missed(&frame, asked, 13.055_011);
}
