//! What holds for any layout and any request.
//!
//! The seed is fixed, so every run checks the same. `PROPTEST_CASES` sets the number of layouts,
//! `PROPTEST_RNG_SEED` another seed. A failure shows the least layout and request that it could be
//! brought to, as an airframe file and a wrench.

use mixer_rt::{Axis, SetpointError};
use mixer_tests::request::{Frame, Request};
use mixer_tests::soundness;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::layout::{Draw, Layout, any_request, layout};
use crate::out;

/// Each layout takes a compilation, about 0.1 s.
const LAYOUTS: u32 = 32;

pub(crate) fn config() -> ProptestConfig {
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
pub(crate) fn many<S: Strategy>(request: S, count: usize) -> impl Strategy<Value = Vec<S::Value>> {
    prop::collection::vec(request, 1..=count)
}

/// Holds every draw for `layout` to `property`; a layout that makes no frame counts for nothing.
pub(crate) fn each<D>(
    layout: &Layout,
    draws: &[D],
    property: impl Fn(&Frame, &D) -> Result<(), TestCaseError>,
) -> Result<(), TestCaseError> {
    let frame = layout.frame().ok_or_else(|| TestCaseError::reject("no frame"))?;
    draws.iter().try_for_each(|draw| property(&frame, draw))
}

/// Throttles in range, the truth about the achieved wrench, flags by axis and side, no axis
/// reversed or exceeded, (roll, pitch) in the direction asked, no thrust raised with airmode
/// disabled.
pub(crate) fn sound(frame: &Frame, draw: &Draw) -> Result<(), TestCaseError> {
    let request = draw.of(frame);
    let answer = request.mix(frame).expect("finite");
    let faults = soundness::faults(frame, &request, &answer);
    let faults =
        faults.map_err(|error| TestCaseError::fail(format!("the oracle on {request:?}: {error}")))?;
    prop_assert_eq!(faults, [], "{:?} -> {:?}", request, answer);
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn answers_are_sound(layout in layout(), draws in many(any_request(0), 200)) {
        each(&layout, &draws, sound)?;
    }

    #[test]
    fn answers_with_a_rotor_out_are_sound(layout in layout(), draws in many(any_request(1), 100)) {
        each(&layout, &draws, sound)?;
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
                density: None,
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
                    let fault = soundness::faults_of_form(frame, &request, &answer).next();
                    prop_assert_eq!(fault, None, "{:?} -> {:?}", request, answer);
                }
                Err(error) => prop_assert_eq!(Some(error), refusal),
            }
            Ok(())
        })?;
    }
}
