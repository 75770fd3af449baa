//! Frames whose optima tie: all upper rotors turn alike, or there are more units than rows. The
//! throttles stay with their neighbours where yaw alone is saturated, as an idle stick gives it, and
//! near there.

use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options, Place};
use mixer_tests::request::{Frame, Request};

use crate::{all_rotors, compile_with_pair, number};

/// The largest change of a throttle between neighbours, and of an axis as a share of its authority.
const JUMP: f32 = 0.02;
const STEP: f64 = 0.01;

/// Relative change of a request.
const CHANGE: f32 = 1e-4;

/// Pairs per frame and airmode.
const PAIRS: u64 = 2000;

fn regular(units: usize, alike: bool) -> Vec<Place> {
    let mut places = frames::regular(units, 180.0 / units as f64);
    for place in &mut places {
        place.clockwise |= alike;
    }
    places
}

/// Yaw up to twice what there is; in half of the requests with roll and pitch of up to a hundredth of
/// theirs, in a quarter with any.
fn draw(frame: &Frame, random: &mut Random) -> Request {
    let [roll, pitch, yaw, thrust] = frame.authority;
    let size = [0.0, 0.01, 0.01, 0.5][random.below(4)];
    let mut torque = |size: f64| random.uniform(-size, size) as f32;
    let wrench = [torque(size * roll), torque(size * pitch), torque(2.0 * yaw)];
    let thrust = random.uniform(0.0, 1.1) * thrust;
    all_rotors(
        [wrench[0], wrench[1], wrench[2], thrust as f32],
        frame.draw_volts(random),
    )
}

/// The request, with a small change of one axis or of all: also from nothing.
fn neighbour(frame: &Frame, random: &mut Random, request: &Request) -> Request {
    let mut near = *request;
    let moved = random.below(5);
    for (axis, value) in near.wrench.iter_mut().enumerate() {
        if moved == 4 || moved == axis {
            *value += CHANGE
                * if *value == 0.0 {
                    0.1 * frame.authority[axis] as f32
                } else {
                    *value
                };
        }
    }
    near
}

#[test]
fn throttles_do_not_jump_where_optima_tie() {
    let mut random = Random::new(number("MIXER_SEED", 11));
    let (mut all, mut jumps, mut steps) = (0, 0, 0);
    for (units, alike) in [(3, true), (4, true), (6, true), (8, true), (6, false), (8, false)] {
        for airmode in AIRMODES {
            let options = Options {
                airmode,
                ..Options::default()
            };
            let frame = compile_with_pair(frames::counted::PAPER, &regular(units, alike), options);
            let (mut here, mut largest) = (0, 0.0f32);
            for _ in 0..PAIRS * number("PROPTEST_CASES", 32) / 32 {
                let request = draw(&frame, &mut random);
                let near = neighbour(&frame, &mut random, &request);
                let [answer, moved] = [request, near].map(|request| request.mix(&frame).expect("finite"));
                let change = answer.change(&moved);
                largest = largest.max(change);
                here += usize::from(change > JUMP);
                let step = (0..4)
                    .map(|axis| (answer.achieved[axis] - moved.achieved[axis]).abs() / frame.authority[axis])
                    .fold(0.0, f64::max);
                steps += usize::from(step > STEP);
                all += 1;
            }
            println!("{units} units, alike {alike}, {airmode}: {here} jumps, the largest {largest:.3}");
            jumps += here;
        }
    }
    println!("of {all} pairs throttles jump in {jumps}, the wrench in {steps}");
    // All of these have yaw saturated or nearly so. The wrench moves where the pivots end, on frames
    // of eight units.
    assert!(jumps * 4_000 <= all, "{jumps} of {all}");
    assert!(steps * 5_000 <= all, "{steps} of {all}");
}
