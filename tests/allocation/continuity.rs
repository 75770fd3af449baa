//! Requests at the ends of paths are answered as their neighbours are.

use mixer_rt::Health;
use mixer_tests::golden;
use mixer_tests::request::{Frame, Request};

use crate::REFERENCE_V;

fn at_reference(wrench: [f32; 4]) -> Request {
    Request {
        wrench,
        volts: REFERENCE_V,
        health: Health::GOOD,
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
        let [answer, next] = [wrench, next].map(|wrench| at_reference(wrench).mix(&frame).expect("finite"));
        let change = (answer.achieved[2] - next.achieved[2]).abs();
        assert!(
            change <= 0.01 * frame.authority[2],
            "{wrench:?}: {:?} and {:?}",
            answer.achieved,
            next.achieved
        );
    }
}
