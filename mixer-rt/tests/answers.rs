//! What every answer holds, whatever is asked of it and whichever rotors turn.
#![allow(missing_docs)]

mod common;

use common::{AIRMODES, Answer, Frame, Random, Request, assert_none, tilted, x8};
use mixer_rt::tables::Airmode;
use mixer_rt::{Axis, Direction, Health, SetpointError};

/// Requests per frame and number of rotors out.
const REQUESTS: usize = 20_000;

type Draw = fn(&Frame, &mut Random, usize) -> Request;

/// Runs a check over requests of both frames with up to `most` rotors out.
fn check(most: usize, draw: Draw, check: impl Fn(&Frame, &Request, &Answer) -> Option<String>) {
    for frame in [x8(), tilted()] {
        for out in 0..=most {
            let (mut random, mut faults) = (Random::new(out as u64), Vec::new());
            for _ in 0..REQUESTS {
                let request = draw(&frame, &mut random, out);
                let answer = frame.mix(&request);
                faults.extend(check(&frame, &request, &answer).map(|fault| (fault, request, answer)));
            }
            assert_none(&format!("{}, {out} out", frame.name), REQUESTS, &faults);
        }
    }
}

/// A throttle outside the range, or of a rotor that is out and not stopped.
fn out_of_range(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
    let range = frame.tables.throttle;
    (0..).zip(&answer.throttle).find_map(|(channel, throttle)| {
        let sound = if request.health.has_failed(channel) {
            *throttle == 0.0
        } else {
            (range.min..=range.max).contains(throttle)
        };
        (!sound).then(|| format!("throttle {throttle} at output {channel}"))
    })
}

#[test]
fn throttles_are_in_range() {
    check(2, Frame::draw, out_of_range);
    check(8, Frame::draw_wild, out_of_range);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for frame in [x8(), tilted()] {
        let random = &mut Random::new(0);
        for out in 0..3 {
            for value in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                for axis in Axis::ALL {
                    let mut request = frame.draw(random, out);
                    request.wrench[axis as usize] = value;
                    assert_eq!(frame.try_mix(&request), Err(SetpointError::NonFinite(axis)));
                }
                let mut request = frame.draw(random, out);
                request.volts = value;
                assert_eq!(frame.try_mix(&request), Err(SetpointError::NonFiniteVoltage));
            }
        }
    }
}

/// The wrench achieved is what the throttles give, within single precision.
#[test]
fn achieved_is_what_the_throttles_give() {
    check(2, Frame::draw, |frame, request, answer| {
        let (given, authority) = (frame.given(request, &answer.throttle), frame.authority());
        Axis::ALL.into_iter().find_map(|axis| {
            let (said, given) = (answer.achieved[axis as usize], given[axis as usize]);
            let off = (f64::from(said) - given).abs() / f64::from(authority[axis as usize]);
            // What is not a number is not true.
            let is_true = off <= 1e-5;
            (!is_true).then(|| format!("{axis}: {said} said, {given} given"))
        })
    });
}

/// What misses the request by more than the tolerance is flagged on its side, and nothing else.
#[test]
fn flags_are_those_of_the_achieved_wrench() {
    check(2, Frame::draw, |frame, request, answer| {
        Axis::ALL.into_iter().find_map(|axis| {
            let missing = request.wrench[axis as usize] - answer.achieved[axis as usize];
            let share = missing / frame.tables.tolerance.wrench[axis as usize];
            let [less, more] = [Direction::Positive, Direction::Negative]
                .map(|direction| answer.saturation.is_saturated(axis, direction));
            let wrong = (share > 1.001 && !less)
                || (share < 0.999 && less)
                || (share < -1.001 && !more)
                || (share > -0.999 && more);
            wrong.then(|| format!("{axis}: {missing} missing, {}", answer.saturation))
        })
    });
}

/// No torque is reversed or exceeded, with rotors out neither roll nor pitch, and (roll, pitch) keeps its direction.
fn unsound(frame: &Frame, request: &Request, answer: &Answer) -> Option<String> {
    let slack = frame.slack();
    let held = match request.health == Health::GOOD {
        true => &[Axis::Roll, Axis::Pitch, Axis::Yaw][..],
        false => &[Axis::Roll, Axis::Pitch],
    };
    let overstepped = held.iter().find_map(|&axis| {
        let [asked, got] = [request.wrench, answer.achieved].map(|wrench| f64::from(wrench[axis as usize]));
        let beyond = (got * asked.signum() - asked.abs()).max(-got * asked.signum());
        (beyond > slack[axis as usize]).then(|| format!("{axis}: {asked} asked, {got} given"))
    });
    let [across, allowed] = frame.turned(request, answer);
    overstepped.or_else(|| (across > allowed).then(|| format!("turned by {across} N m")))
}

#[test]
fn torques_are_neither_reversed_nor_exceeded_nor_turned() {
    check(1, Frame::draw, |frame, request, answer| {
        let fault = unsound(frame, request, answer);
        fault.filter(|_| frame.has_level(request))
    });
}

/// With airmode `disabled` nothing raises the thrust above the request, or above the least that level
/// flight needs.
#[test]
fn thrust_is_not_raised() {
    check(1, Frame::draw, |frame, request, _| {
        let frame = frame.with(Airmode::Disabled, frame.tables.priorities.yaw_reserve_nm);
        let is_good = request.health == Health::GOOD;
        if !is_good && !frame.has_level(request) {
            return None;
        }
        let least = if is_good {
            f64::from(frame.tables.level_n[0]) * frame.factors(request)[0]
        } else {
            f64::NEG_INFINITY
        };
        let (asked, got) = (f64::from(request.wrench[3]), frame.mix(request).achieved[3]);
        let is_raised = f64::from(got) > asked.max(least) + frame.slack()[3];
        is_raised.then(|| format!("{asked} N asked, {least} N needed, {got} N given"))
    });
}

/// A request far beyond on every axis, in every airmode.
#[test]
fn requests_far_beyond_keep_their_direction() {
    for (frame, out) in [(x8(), 0), (x8(), 1), (tilted(), 0), (tilted(), 1)] {
        let mut random = Random::new(7);
        let mut faults = Vec::new();
        for index in 0..REQUESTS {
            // The closed form is that of the table's airmode.
            let airmode = if (frame.name, out) == ("isae_x8", 0) {
                frame.tables.priorities.airmode
            } else {
                AIRMODES[index % 3]
            };
            let frame = frame.with(airmode, frame.tables.priorities.yaw_reserve_nm);
            let mut request = frame.draw(&mut random, out);
            let size = [10.0, 1e3, 1e6][random.below(3) as usize];
            for (asked, authority) in request.wrench.iter_mut().zip(frame.authority()).take(3) {
                *asked = size * authority * random.between(0.2, 1.0).copysign(*asked);
            }
            if frame.has_level(&request) {
                let answer = frame.mix(&request);
                let fault = unsound(&frame, &request, &answer);
                faults.extend(fault.map(|fault| (airmode, fault, request, answer)));
            }
        }
        assert_none(&format!("{}, {out} out", frame.name), REQUESTS, &faults);
    }
}

/// Yaw takes no roll and pitch, nor does a reserve of yaw, which keeps the yaw that there was without
/// it: at most 2 % of the authority is lost.
#[test]
fn priorities_hold() {
    for airmode in AIRMODES {
        let frame = tilted().with(airmode, 0.0);
        let [authority_yaw, reserve] = [frame.authority()[2], 0.1 * frame.authority()[2]];
        let (mut random, mut faults) = (Random::new(8), Vec::new());
        for _ in 0..REQUESTS {
            let request = frame.draw(&mut random, 0);
            let mut without_yaw = request;
            without_yaw.wrench[2] = 0.0;
            let [answer, alone] = [request, without_yaw].map(|request| frame.mix(&request));
            let kept = frame.with(airmode, reserve).mix(&request);
            let along = |answer: &Answer| frame.along(&request, answer);
            let yaw = |answer: &Answer| answer.achieved[2] * request.wrench[2].signum();
            let lost = [
                along(&alone) - along(&answer),
                along(&answer) - along(&kept),
                f64::from((yaw(&answer).min(reserve) - yaw(&kept)) / authority_yaw),
            ];
            if lost.iter().any(|lost| *lost > 0.02) {
                faults.push((lost, request));
            }
        }
        assert_none(&format!("{airmode:?}"), REQUESTS, &faults);
    }
}
