//! Throttles and the wrench follow a small change of the request: on random layouts with and without
//! a power bias, with rotors out, and on frames whose optima tie. All jumps count, the optimum's own
//! as well.
//!
//! `MIXER_SEED=2 PROPTEST_CASES=400 cargo test --release -p mixer-tests --test allocation jumps --
//! --nocapture` counts them on 400 random frames, 500 pairs of neighbours each.

use mixer_rt::Health;
use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options, Place};
use mixer_tests::request::{Frame, Request};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use crate::layout::{Draw, Layout, biased_layout, layout, moderate_request};
use crate::{compile_with_pair, number, out};

/// The largest change of a throttle between neighbours, and of an axis as a share of its authority.
const JUMP: f32 = 0.02;
const STEP: f64 = 0.01;

/// One pair in so many may jump, or step.
const ONE_IN: usize = 10_000;

/// Relative change of a request.
const CHANGE: f32 = 1e-4;

/// Pairs of neighbours per frame.
const PAIRS: usize = 500;

/// Pairs of neighbours, and those that jump.
#[derive(Debug, Default)]
struct Tally {
    pairs: usize,
    jumps: usize,
    steps: usize,
    largest: f32,
}

impl Tally {
    /// Counts a request and its neighbour: `moved` is the axis that changes, 4 for all.
    fn count(&mut self, frame: &Frame, request: &Request, moved: usize, name: &dyn Fn() -> String) {
        let mut near = *request;
        for (axis, value) in near.wrench.iter_mut().enumerate() {
            if moved == 4 || moved == axis {
                // Also from nothing.
                let size = if *value == 0.0 {
                    0.1 * frame.authority[axis] as f32
                } else {
                    *value
                };
                *value += CHANGE * size;
            }
        }
        let [answer, after] = [request, &near].map(|request| request.mix(frame).expect("finite"));
        let change = answer.change(&after);
        let step = (0..4)
            .filter(|&axis| frame.served()[axis])
            .map(|axis| (answer.achieved[axis] - after.achieved[axis]).abs() / frame.size(axis))
            .fold(0.0, f64::max);
        self.pairs += 1;
        self.jumps += usize::from(change > JUMP);
        self.steps += usize::from(step > STEP);
        self.largest = self.largest.max(change);
        if change > JUMP || step > STEP {
            println!(
                "{}\nthrottles move by {change}, the wrench by {step}: {request:?}, axis {moved}\n  {answer:?}\n  {after:?}",
                name()
            );
        }
    }

    fn add(&mut self, what: &str, other: &Tally) {
        println!("{what}: {other:?}");
        self.pairs += other.pairs;
        self.jumps += other.jumps;
        self.steps += other.steps;
        self.largest = self.largest.max(other.largest);
    }
}

/// On random layouts with all rotors.
fn on_layouts(layouts: impl Strategy<Value = Layout>) -> Tally {
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&number("MIXER_SEED", 1).to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let mut tally = Tally::default();
    for _ in 0..number("PROPTEST_CASES", 32) {
        let layout = layouts.new_tree(&mut runner).expect("drawn").current();
        let draws = prop::collection::vec((moderate_request(), 0..5_usize), PAIRS);
        let draws: Vec<(Draw, usize)> = draws.new_tree(&mut runner).expect("drawn").current();
        let Some(frame) = layout.frame() else { continue };
        for (draw, moved) in &draws {
            tally.count(&frame, &draw.of(&frame), *moved, &|| format!("{layout:?}"));
        }
    }
    tally
}

/// A regular frame whose upper rotors turn alternately, or alike.
fn regular(units: usize, alike: bool, airmode: &'static str) -> Frame {
    let mut places: Vec<Place> = frames::regular(units, 180.0 / units as f64);
    for place in &mut places {
        place.clockwise |= alike;
    }
    let options = Options {
        airmode,
        ..Options::default()
    };
    compile_with_pair(frames::counted::PAPER, &places, options)
}

/// Yaw up to twice what there is; in half of the requests with roll and pitch of up to a hundredth of
/// theirs, in a quarter with any.
fn draw(frame: &Frame, random: &mut Random, health: Health) -> Request {
    let [roll, pitch, yaw, thrust] = frame.authority;
    let size = [0.0, 0.01, 0.01, 0.5][random.below(4)];
    let mut torque = |size: f64| random.uniform(-size, size) as f32;
    let torques = [torque(size * roll), torque(size * pitch), torque(2.0 * yaw)];
    let thrust = random.uniform(0.0, 1.1) * thrust;
    Request {
        wrench: [torques[0], torques[1], torques[2], thrust as f32],
        volts: frame.draw_volts(random),
        health,
    }
}

/// All upper rotors turn alike, or there are more units than rows: optima tie where yaw alone is
/// saturated, as an idle stick gives it, and near there.
fn where_optima_tie() -> Tally {
    let mut random = Random::new(number("MIXER_SEED", 11));
    let mut tally = Tally::default();
    for (units, alike) in [(3, true), (4, true), (6, true), (8, true), (6, false), (8, false)] {
        for airmode in AIRMODES {
            let frame = regular(units, alike, airmode);
            for _ in 0..60 * number("PROPTEST_CASES", 32) {
                let request = draw(&frame, &mut random, Health::GOOD);
                let moved = random.below(5);
                tally.count(&frame, &request, moved, &|| {
                    format!("{units} units, {alike}, {airmode}")
                });
            }
        }
    }
    tally
}

/// An X8, an X12 and an X16 fly level without any one or two rotors of different units.
fn with_rotors_out() -> Tally {
    let mut random = Random::new(number("MIXER_SEED", 12));
    let mut tally = Tally::default();
    for units in [4, 6, 8] {
        for airmode in AIRMODES {
            let frame = regular(units, false, airmode);
            for index in 0..60 * number("PROPTEST_CASES", 32) {
                let first = random.below(2 * units);
                let second = (first + 2 + random.below(2 * units - 4)) % (2 * units);
                let failed = [first as u8, second as u8];
                let health = out(&failed[..1 + index as usize % 2]);
                let request = if random.below(2) == 0 {
                    draw(&frame, &mut random, health)
                } else {
                    let volts = frame.draw_volts(&mut random);
                    Request {
                        health,
                        ..frame.draw(&mut random, 0.6, volts)
                    }
                };
                let moved = random.below(5);
                tally.count(&frame, &request, moved, &|| format!("{units} units, {airmode}"));
            }
        }
    }
    tally
}

#[test]
fn throttles_and_the_wrench_follow_the_request() {
    let mut all = Tally::default();
    all.add("random layouts", &on_layouts(layout()));
    all.add("random layouts with a bias", &on_layouts(biased_layout()));
    all.add("ties", &where_optima_tie());
    all.add("rotors out", &with_rotors_out());
    println!("{all:?}");
    assert!(all.pairs >= 5 * ONE_IN || number("PROPTEST_CASES", 32) < 32);
    assert!(all.jumps * ONE_IN <= all.pairs, "{all:?}");
    assert!(all.steps * ONE_IN <= all.pairs, "{all:?}");
}
