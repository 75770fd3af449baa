//! Throttles that jump from a request to its neighbour: which of them must, and how often others
//! do.
//!
//! `MIXER_SEED=2 PROPTEST_CASES=400 cargo test --release -p mixer-tests --test allocation jumps --
//! --nocapture` counts them on 400 random frames, 250 pairs of neighbours each.

use mixer_tests::motion::{JUMP, Motion};
use mixer_tests::request::{Frame, Request};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use crate::layout::{Draw, layout, moderate_request};
use crate::number;

/// Pairs of neighbours per frame.
const PAIRS: usize = 250;

/// A request with up to `out_most` rotors out, and which axis changes to the next one, by 1e-4 of
/// it: 4 for all.
pub(crate) fn neighbours(out_most: usize) -> impl Strategy<Value = (Draw, usize)> {
    (moderate_request(out_most), 0..5_usize)
}

/// The request and its neighbour.
pub(crate) fn of(frame: &Frame, (draw, moved): &(Draw, usize)) -> [Request; 2] {
    let request = draw.of(frame);
    let mut near = request;
    for (axis, value) in near.wrench.iter_mut().enumerate() {
        if *moved == 4 || *moved == axis {
            *value *= 1.0 + 1e-4;
        }
    }
    [request, near]
}

/// Calls `judge` with pairs of neighbours, up to `out_most` rotors out, and what to say of their
/// frame.
fn for_pairs(out_most: usize, mut judge: impl FnMut(&Frame, [Request; 2], &dyn Fn() -> String)) {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&number("MIXER_SEED", 1).to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    for index in 0..number("PROPTEST_CASES", 32) {
        let layout = layout().new_tree(&mut runner).expect("drawn").current();
        let pairs = prop::collection::vec(neighbours(out_most), PAIRS);
        let pairs = pairs.new_tree(&mut runner).expect("drawn").current();
        let Some(frame) = layout.frame() else { continue };
        for pair in &pairs {
            judge(&frame, of(&frame, pair), &|| format!("frame {index}, {layout:?}"));
        }
    }
}

#[test]
fn few_throttles_jump() {
    let (mut small, mut forced, mut parted, mut jumps) = (0, 0, 0, 0);
    for_pairs(0, |frame, [request, near], name| {
        match Motion::between(frame, &request, &near).expect("solved") {
            Motion::Small => small += 1,
            Motion::Forced => forced += 1,
            Motion::Parted => parted += 1,
            Motion::Jump(said) => {
                println!("{}: {said}", name());
                jumps += 1;
            }
        }
    });
    println!(
        "of {} pairs throttles jump in {jumps} where nothing forces it, in {parted} from one optimum to another, in {forced} as forced",
        small + forced + parted + jumps
    );
    assert!(small >= 5000);
    // With other seeds some four pairs in a million do.
    assert_eq!(jumps, 0);
}

/// What is left of a unit that has lost a rotor is a curve, on which optima are apart: no oracle
/// says here which jumps are forced, so all are counted.
#[test]
fn throttles_rarely_jump_with_rotors_out() {
    let (mut pairs, mut jumps) = (0, 0);
    for_pairs(2, |frame, requests, _| {
        let [answer, moved] = requests.map(|request| request.mix(frame).expect("finite"));
        pairs += 1;
        jumps += usize::from(answer.change(&moved) > JUMP);
    });
    println!("with up to two rotors out throttles jump in {jumps} of {pairs} pairs");
    assert!(pairs >= 5000);
    assert!(jumps * 1000 <= pairs, "{jumps} of {pairs}");
}
