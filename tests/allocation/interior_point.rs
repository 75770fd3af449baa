//! Answers against a second allocator, an interior point method on the throttles. What it reaches
//! is attainable, which the optima of linear programmes over hulls are not where rotors are out.

use mixer_rt::{Health, tables::Airmode};
use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options};
use mixer_tests::interior_point;
use mixer_tests::request::{Frame, Request};

use crate::number;

/// Share of the authority by which one answer has to be better than the other.
const BETTER: f64 = 0.01;

/// Share of the authority that a higher priority may differ by, and the next one still counts.
const EQUAL: f64 = 0.001;

/// Shortages of an answer in the order of priority, as shares of the authority.
fn missed(frame: &Frame, request: &Request, given: [f64; 4]) -> [f64; 3] {
    let (asked, authority) = (request.asked(), frame.authority);
    let torque = (asked[0] * asked[0] + asked[1] * asked[1]).sqrt();
    let along = if torque > 0.0 {
        (asked[0] * given[0] + asked[1] * given[1]) / torque
    } else {
        0.0
    };
    let roll_pitch = (torque - along) / authority[0].min(authority[1]);
    let [yaw, thrust] = [2, 3].map(|axis| (asked[axis] - given[axis]).abs() / authority[axis]);
    match frame.allocation().airmode {
        Airmode::RollPitchYaw => [roll_pitch, yaw, thrust],
        _ => [roll_pitch, thrust, yaw],
    }
}

/// True where the first is better than the second in the order of priority.
fn is_better(first: [f64; 3], second: [f64; 3]) -> bool {
    let mut pairs = first.into_iter().zip(second);
    pairs
        .find(|(first, second)| first > &(second + EQUAL) || second > &(first + BETTER))
        .is_some_and(|(first, second)| second > first)
}

#[derive(Default)]
struct Compared {
    requests: usize,
    mixer_better: usize,
    other_better: usize,
}

#[test]
fn a_second_allocator_is_seldom_better() {
    let mut random = Random::new(number("MIXER_SEED", 21));
    for (out, one_in) in [(0, 50), (1, 50), (2, 25)] {
        let mut compared = Compared::default();
        for tilt in [0.0, 0.08] {
            for units in 3..=8 {
                for airmode in AIRMODES {
                    let options = Options {
                        airmode,
                        ..Options::default()
                    };
                    let places = frames::irregular(&mut random, units, tilt);
                    let Ok(frame) = frames::compile(&places, options).map(Frame::new) else {
                        continue;
                    };
                    for _ in 0..number("MIXER_REQUESTS", 25) {
                        let volts = frame.draw_volts(&mut random);
                        let mut request = frame.draw(&mut random, 0.6, volts);
                        request.health = (0..out).fold(Health::GOOD, |health, _| {
                            health.with_failed(random.below(2 * units) as u8)
                        });
                        compare(&frame, &request, &mut compared);
                    }
                }
            }
        }
        let Compared {
            requests,
            mixer_better,
            other_better,
        } = compared;
        println!(
            "{out} out: of {requests} the mixer is better on {mixer_better}, the other on {other_better}"
        );
        assert!(requests >= 500, "{out} out: {requests} requests");
        assert!(
            other_better * one_in <= requests,
            "{out} out: {other_better} of {requests}"
        );
        // Else it would be no measure.
        assert!(
            mixer_better * 5 <= requests,
            "{out} out: {mixer_better} of {requests}"
        );
    }
}

fn compare(frame: &Frame, request: &Request, compared: &mut Compared) {
    let answer = request.mix(frame).expect("finite");
    let mixer = missed(frame, request, answer.achieved);
    let other = missed(frame, request, interior_point::allocate(frame, request));
    compared.requests += 1;
    compared.mixer_better += usize::from(is_better(mixer, other));
    let is_other_better = is_better(other, mixer);
    compared.other_better += usize::from(is_other_better);
    if (is_other_better || is_better(mixer, other)) && std::env::var_os("MIXER_MISSES").is_some() {
        println!(
            "{:?} {request:?}: mixer {mixer:?}, other {other:?}",
            frame.allocation().airmode
        );
    }
}
