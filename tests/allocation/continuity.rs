//! Requests next to each other are answered alike: those near which throttles or what is delivered once jumped.

use mixer_rt::Health;
use mixer_tests::frames::Place;
use mixer_tests::golden;
use mixer_tests::request::{Frame, Request};

use crate::{REFERENCE_V, compile};

fn place(position: [f64; 3], axis: [f64; 2], clockwise: bool) -> Place {
    Place {
        position,
        axis: [axis[0], axis[1], -1.0],
        clockwise,
    }
}

fn all_rotors(wrench: [f32; 4], volts: f32) -> Request {
    Request {
        wrench,
        volts,
        health: Health::GOOD,
    }
}

/// Changes one axis by 1e-4 of it: no throttle moves by more than 0.02.
fn stays(frame: &Frame, wrench: [f32; 4], volts: f32, axis: usize) {
    let request = all_rotors(wrench, volts);
    let mut near = request;
    near.wrench[axis] *= 1.0 + 1e-4;
    let [answer, moved] = [request, near].map(|request| request.mix(frame).expect("finite"));
    let change = answer.change(&moved);
    assert!(change <= 0.02, "{change}: {answer:?}, then {moved:?}");
}

/// Little less than all is attainable, and all but the last bit of it without crossing an edge.
#[test]
fn the_last_bit_comes_gradually() {
    let places = [
        place([0.02875, -0.53661, -0.0130], [-0.04819, 0.07345], true),
        place([0.62633, 0.32506, -0.0500], [-0.14330, -0.07641], false),
        place([-0.37419, 0.15251, -0.0465], [-0.03352, -0.09509], false),
    ];
    let frame = compile(&places, "roll-pitch-yaw", 0.0);
    let mut asked = [4.6543736, -4.008832, 0.22767107, 0.0];
    for step in 0..200 {
        asked[3] = 26.0 + 1e-3 * step as f32;
        stays(&frame, asked, 15.425033, 3);
    }
}

/// Where roll and pitch leave the thrusts no room at all, rounding leaves them less; the reserve of yaw is kept.
#[test]
fn a_reserve_is_kept_where_thrusts_have_no_room() {
    let vertical = [0.0, 0.0];
    let places = [
        place([-0.003970421513648438, 0.27762963756311904, 0.0], vertical, true),
        place([-0.19671269978719483, 0.03611251503887493, 0.0], vertical, false),
        place([0.0018966751448836689, -0.3358674052841479, 0.0], vertical, false),
        place([0.6250584676096459, -0.11655371243145435, 0.0], vertical, false),
    ];
    let reserve = 0.04606133174454187;
    let frame = compile(&places, "disabled", reserve);
    let mut request = all_rotors([3.3156884, 15.232795, 0.10576367, 65.15473], 13.748151);
    for _ in 0..200 {
        request.wrench[0] += 1e-5;
        let answer = request.mix(&frame).expect("finite");
        assert!(answer.achieved[2] > reserve - 1e-3, "{request:?}: {answer:?}");
    }
}

/// At the end of roll and pitch rounding errors of the wrench cannot be made up for: trying to turned two units to and
/// fro until the pieces ran out, and what was left of yaw was lost.
#[test]
fn yaw_at_the_end_of_roll_and_pitch_is_that_of_the_neighbours() {
    let frame = Frame::new(golden::compile("px4-x12").expect("compiles"));
    for (wrench, next) in [
        (
            [-32.299_454, 27.726_133, 0.449_855_57, 92.303_925],
            [-32.303_703, 27.729_778, 0.449_914_72, 92.303_764],
        ),
        (
            [35.324_436, -22.486_635, -0.488_017_98, -56.112_247],
            [35.328_583, -22.489_275, -0.488_075_3, -56.125_774],
        ),
    ] {
        let [answer, next] =
            [wrench, next].map(|wrench| all_rotors(wrench, REFERENCE_V).mix(&frame).expect("finite"));
        let change = (answer.achieved[2] - next.achieved[2]).abs();
        assert!(
            change <= 0.01 * frame.authority[2],
            "{wrench:?}: {:?} and {:?}",
            answer.achieved,
            next.achieved
        );
    }
}
