//! What holds for any layout and any request.
//!
//! The seed is fixed, so every run checks the same. `PROPTEST_CASES` sets the number of layouts, `PROPTEST_RNG_SEED`
//! another seed. A failure shows the least layout and request that it could be brought to, as an airframe file and a
//! wrench.

use mixer_rt::{Axis, Health, SetpointError};
use mixer_tests::optimum::Oracle;
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::shortfall::Shortfall;
use mixer_tests::soundness;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::continuity::place;
use crate::jumps::{self, Motion, neighbours};
use crate::layout::{Draw, Layout, any_request, attainable_request, layout, moderate_request};
use crate::{compile, out};

/// Share by which a barely attainable wrench is drawn inside to be attainable to the mixer, too, whose polygons leave out a
/// little at the border.
const INSIDE: f32 = 0.01;

/// Share of the authority by which an answer may miss the optimum over the mixer's own polygons: rounding.
const OWN: f64 = 1e-3;

/// Each layout takes a compilation, about 0.1 s.
const LAYOUTS: u32 = 32;

fn config() -> ProptestConfig {
    let default = ProptestConfig::default();
    let is_set = |variable: &str| std::env::var_os(variable).is_some();
    ProptestConfig {
        cases: if is_set("PROPTEST_CASES") {
            default.cases
        } else {
            LAYOUTS
        },
        rng_seed: if is_set("PROPTEST_RNG_SEED") {
            default.rng_seed
        } else {
            RngSeed::Fixed(1)
        },
        failure_persistence: None,
        max_shrink_iters: 4000,
        // Milliseconds.
        max_shrink_time: 60_000,
        ..default
    }
}

/// `count` requests for one layout.
fn many<S: Strategy>(request: S, count: usize) -> impl Strategy<Value = Vec<S::Value>> {
    prop::collection::vec(request, 1..=count)
}

/// Holds every draw for `layout` to `property`; a layout that makes no frame counts for nothing.
fn each<D>(
    layout: &Layout,
    draws: &[D],
    property: impl Fn(&Frame, &D) -> Result<(), TestCaseError>,
) -> Result<(), TestCaseError> {
    let frame = layout.frame().ok_or_else(|| TestCaseError::reject("no frame"))?;
    draws.iter().try_for_each(|draw| property(&frame, draw))
}

/// Throttles in range, the truth about the achieved wrench, flags by axis and side, no axis reversed or exceeded,
/// (roll, pitch) in the direction asked, no thrust raised with airmode disabled.
fn sound(frame: &Frame, draw: &Draw) -> Result<(), TestCaseError> {
    let request = draw.of(frame);
    let answer = request.mix(frame).expect("finite");
    let fault = soundness::fault(frame, &request, &answer);
    let fault = fault.map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))?;
    prop_assert_eq!(fault, None, "{:?} -> {:?}", request, answer);
    Ok(())
}

/// Fails where an axis is missed by more than the mixer's tolerance.
fn delivered(frame: &Frame, request: &Request) -> Result<(), TestCaseError> {
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

/// Fails where more than [`INSIDE`] is missing of what is attainable, or more is given up for that than the priorities
/// demand: where units have little to spare, half a percent of one axis may be worth a tenth of another. So the wrench
/// that much nearer to that of half throttles must be delivered, and the answer be the optimum over the mixer's own
/// polygons.
fn little_is_missed(frame: &Frame, request: &Request, answer: &Answer) -> Result<(), TestCaseError> {
    let halves = frame.physics.throttles(std::iter::repeat(0.5), request.health);
    let middle = frame.physics.wrench(&halves, request.volts);
    let mut inside = *request;
    for (value, middle) in inside.wrench.iter_mut().zip(middle) {
        *value += INSIDE * (middle as f32 - *value);
    }
    delivered(frame, &inside)?;
    let of = |oracle: Oracle| {
        Shortfall::of(answer, request, frame, &oracle)
            .map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))
    };
    let is_optimal =
        |shortfall: Option<Shortfall>| shortfall.is_none_or(|shortfall| shortfall.largest() <= OWN);
    let mut shortfall = of(Oracle::of_polygons(frame, request.volts, request.health))?;
    if !is_optimal(shortfall) {
        // Perhaps not of the polygons, but only of their convex hulls.
        shortfall = of(Oracle::of_exact_polygons(frame, request.volts, request.health))?;
    }
    prop_assert!(
        is_optimal(shortfall),
        "{:?} of the polygons': {:?} -> {:?}",
        shortfall,
        request,
        answer
    );
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn answers_are_sound(layout in layout(), draws in many(any_request(0), 200)) {
        each(&layout, &draws, sound)?;
    }

    #[test]
    fn answers_with_rotors_out_are_sound(layout in layout(), draws in many(any_request(2), 100)) {
        each(&layout, &draws, sound)?;
    }

    /// No priority is short by more than 1 % of its authority, whichever of the rotors work.
    #[test]
    fn answers_reach_the_optimum(layout in layout(), draws in many(moderate_request(2), 20)) {
        each(&layout, &draws, |frame, draw| {
            let request = draw.of(frame);
            let answer = request.mix(frame).expect("finite");
            let factors = frame.physics.factors(request.volts);
            let oracle = Oracle::new(&frame.physics, frame.allocation(), factors, request.health);
            let of = |oracle: &Oracle| {
                Shortfall::of(&answer, &request, frame, oracle)
                    .map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))
            };
            let mut shortfall = of(&oracle)?;
            if shortfall.is_some_and(|shortfall| shortfall.misses()) {
                // Perhaps not of what is attainable, but only of its convex hull.
                shortfall = of(&Oracle::exact(&frame.physics, frame.allocation(), factors, request.health))?;
            }
            prop_assert!(
                shortfall.is_none_or(|shortfall| !shortfall.misses()),
                "{:?}: {:?} -> {:?}", shortfall, request, answer
            );
            Ok(())
        })?;
    }

    /// The wrench of throttles that keep 2 % off the ends of their range.
    #[test]
    fn attainable_wrenches_are_delivered(layout in layout(), draws in many(attainable_request(0.02, 0), 150)) {
        each(&layout, &draws, |frame, draw| {
            let request = draw.of(frame);
            delivered(frame, &request)
        })?;
    }

    /// The wrench of throttles at the ends of their range: the border of what is attainable. Where more than half a percent
    /// of an axis is missed, the priorities have made that of less: see [`little_is_missed`].
    #[test]
    fn barely_attainable_wrenches_are_delivered_but_for_half_a_percent(
        layout in layout(),
        draws in many(attainable_request(0.0, 0), 150),
    ) {
        each(&layout, &draws, |frame, draw| {
            let request = draw.of(frame);
            let answer = request.mix(frame).expect("finite");
            let misses = (0..4).any(|axis| {
                let missed = (request.asked()[axis] - answer.achieved[axis]).abs();
                frame.served()[axis] && missed > 0.005 * frame.authority[axis]
            });
            if misses {
                little_is_missed(frame, &request, &answer)?;
            }
            Ok(())
        })?;
    }

    /// A relative change of 1e-4 of one axis, or of all, moves no throttle by more than 0.02, but where it must: [`Motion`].
    #[test]
    fn throttles_are_continuous_in_the_request(layout in layout(), pairs in many(neighbours(), 300)) {
        each(&layout, &pairs, |frame, pair| {
            let [request, near] = jumps::of(frame, pair);
            let motion = Motion::between(frame, &request, &near)
                .map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))?;
            match motion {
                Motion::Small | Motion::Forced | Motion::Parted => Ok(()),
                Motion::Jump(said) => Err(TestCaseError::fail(said)),
            }
        })?;
    }

    /// A refusal exactly for what is not finite, whatever the bits and whichever rotors are out.
    #[test]
    fn any_bits_give_throttles_in_range_or_a_refusal(
        layout in layout(),
        draws in many((any::<[u32; 5]>(), any::<[u8; 3]>()), 200),
    ) {
        each(&layout, &draws, |frame, (bits, failed)| {
            let [volts, wrench @ ..] = bits.map(f32::from_bits);
            let request = Request {
                wrench,
                volts,
                // Channels beyond the frame's are no one's.
                health: out(failed),
            };
            let first_bad = Axis::ALL.into_iter().zip(wrench).find(|(_, value)| !value.is_finite());
            let refusal = match first_bad {
                Some((axis, _)) => Some(SetpointError::NonFinite(axis)),
                None => (!volts.is_finite()).then_some(SetpointError::NonFiniteVoltage),
            };
            match request.mix(frame) {
                Ok(answer) => {
                    prop_assert_eq!(refusal, None);
                    let fault = soundness::fault_of_form(frame, &request, &answer);
                    prop_assert_eq!(fault, None, "{:?} -> {:?}", request, answer);
                }
                Err(error) => prop_assert_eq!(Some(error), refusal),
            }
            Ok(())
        })?;
    }
}

/// Barely attainable, where what the polygons leave out is little of yaw or of (roll, pitch) and worth a percent of thrust, and
/// where their convex hulls leave out less: the answer is the optimum over the polygons, which are what the mixer has.
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
        let request = Request {
            wrench: frame.physics.wrench(&throttles, volts).map(|value| value as f32),
            volts,
            health: Health::GOOD,
        };
        let answer = request.mix(&frame).expect("finite");
        little_is_missed(&frame, &request, &answer).unwrap_or_else(|fault| panic!("{fault}"));
    }
}

/// The units that are not at corners can together give all but the same wrenches: what roll and pitch gain by telling them apart is
/// as little as rounding, what yaw loses where they are not told apart is more than a percent.
#[test]
fn yaw_is_served_where_units_are_all_but_dependent() {
    let five = [
        place(
            [-0.05765831, -0.25156966, -0.04199732],
            [0.07774938, 0.03916135],
            true,
        ),
        place(
            [0.25997197, -0.16623774, -0.02521311],
            [-0.01667376, -0.07180378],
            false,
        ),
        place(
            [0.41603721, 0.20852045, 0.01564486],
            [-0.01331326, -0.02349470],
            true,
        ),
        place(
            [-0.05483321, 0.45301068, 0.01359283],
            [0.06630826, -0.07497497],
            true,
        ),
        place(
            [-0.49935372, 0.16076363, -0.01812808],
            [-0.07605438, -0.03041751],
            false,
        ),
    ];
    let eight = [
        place(
            [0.28638235, 0.51017202, -0.02616863],
            [0.05606949, 0.04446046],
            true,
        ),
        place(
            [-0.08540948, 0.30771637, 0.02352849],
            [0.03775874, 0.05813704],
            false,
        ),
        place(
            [-0.29181423, 0.12800551, -0.04772641],
            [-0.00306600, 0.00096930],
            true,
        ),
        place(
            [-0.66178603, -0.08149608, 0.03182107],
            [-0.01386754, 0.06534881],
            false,
        ),
        place(
            [-0.09983987, -0.33462786, -0.04088692],
            [-0.02963568, 0.04582441],
            false,
        ),
        place(
            [0.04523658, -0.38500399, 0.04694180],
            [0.05724209, -0.04516663],
            true,
        ),
        place(
            [0.50855832, -0.23916334, 0.00066031],
            [-0.03729668, -0.07629784],
            true,
        ),
        place(
            [0.40893997, 0.10214931, 0.03488488],
            [0.01401430, -0.05654245],
            true,
        ),
    ];
    for (frame, wrench, volts) in [
        (
            compile(&five, "disabled", 0.03),
            [-5.018_381_6, 2.208_331, -0.604_422_75, 10.451_086],
            14.8,
        ),
        (
            compile(&eight, "disabled", 0.0),
            [25.043_081, 15.385_539, -1.829_544_4, 94.597_56],
            14.766_66,
        ),
    ] {
        let request = Request {
            wrench,
            volts,
            health: Health::GOOD,
        };
        let answer = request.mix(&frame).expect("finite");
        let oracle = Oracle::of_polygons(&frame, volts, request.health);
        let shortfall = Shortfall::of(&answer, &request, &frame, &oracle).expect("solved");
        assert!(
            shortfall.is_some_and(|shortfall| shortfall.largest() <= OWN),
            "{shortfall:?}: {answer:?}"
        );
    }
}

/// A ten-millionth of roll and pitch is worth a tenth of a percent of thrust here, which is not for the oracle to take.
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
    let request = Request {
        wrench: [3.393_982_6, -5.685_069, -0.801_756_44, 44.120_895],
        volts: 13.055_011,
        health: Health::GOOD,
    };
    let answer = request.mix(&frame).expect("finite");
    little_is_missed(&frame, &request, &answer).unwrap_or_else(|fault| panic!("{fault}"));
}

/// The unit that ends at one end of its hollow belongs to the other, from which the border falls before it rises: for a few
/// ten-thousandths of roll and pitch a quarter of the thrust was missed.
#[test]
fn the_other_end_of_a_hollow_is_tried_from_its_end() {
    let four = [
        place(
            [-0.671_477_571, 0.227_954_642, 0.017_448_347],
            [-0.116_466_185, 0.008_262_063],
            true,
        ),
        place(
            [-0.344_040_99, -0.538_300_101, -0.021_609_81],
            [-0.086_409_99, 0.122_695_464],
            false,
        ),
        place(
            [0.389_190_901, -0.270_162_919, -0.039_520_476],
            [0.089_721_348, 0.058_907_859],
            true,
        ),
        place(
            [0.348_173_863, 0.284_630_237, 0.045_686_548],
            [0.102_883_957, -0.107_042_018],
            false,
        ),
    ];
    let frame = compile(&four, "roll-pitch", 0.0);
    let request = Request {
        wrench: [-76.422_33, 38.121_5, 17.874_983, 33.795_4],
        volts: 13.684_681,
        health: Health::GOOD,
    };
    let answer = request.mix(&frame).expect("finite");
    let oracle = Oracle::of_exact_polygons(&frame, request.volts, request.health);
    let shortfall = Shortfall::of(&answer, &request, &frame, &oracle).expect("solved");
    assert!(
        shortfall.is_some_and(|shortfall| shortfall.largest() <= OWN),
        "{shortfall:?}: {answer:?}"
    );
}
