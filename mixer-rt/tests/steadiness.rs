//! How throttles and wrench follow the request.
#![allow(missing_docs)]

mod common;

use common::{Frame, Random, Request, assert_none, tilted, x8};
use mixer_rt::Health;

/// Two requests next to each other get throttles next to each other: a throttle moves by more than
/// 0.02 in at most so many of 10,000 pairs, with all rotors and with one out.
fn assert_steady(frame: &Frame, in_ten_thousand: [usize; 2]) {
    const PAIRS: usize = 50_000;
    for (out, in_ten_thousand) in in_ten_thousand.into_iter().enumerate() {
        let (mut random, mut jumps) = (Random::new(4), Vec::new());
        for _ in 0..PAIRS {
            let one = frame.draw(&mut random, out);
            let mut other = one;
            for (asked, authority) in other.wrench.iter_mut().zip(frame.authority()) {
                *asked += 1e-4 * authority * random.between(-1.0, 1.0);
            }
            let [first, second] = [one, other].map(|request| frame.mix(&request).throttle);
            let steps = first.iter().zip(&second).map(|(a, b)| (a - b).abs());
            let step = steps.fold(0.0, f32::max);
            if step > 0.02 {
                jumps.push((step, one, other.wrench));
            }
        }
        println!("{}, {out} out: {} of {PAIRS} jump", frame.name, jumps.len());
        if jumps.len() > in_ten_thousand * PAIRS / 10_000 {
            assert_none(&format!("{}, {out} out", frame.name), PAIRS, &jumps);
        }
    }
}

#[test]
fn throttles_of_an_x8_are_steady() {
    assert_steady(&x8(), [1, 1]);
}

/// On tilted frames more do: near the limits two local optima of sets that are not convex change places.
#[test]
fn throttles_of_tilted_units_are_steady() {
    assert_steady(&tilted(), [2, 6]);
}

/// Where all units can give the efforts of least norm, the answer is their throttles.
#[test]
fn attainable_requests_get_least_norm() {
    let (frame, mut random) = (tilted(), Random::new(5));
    let (mut served, mut faults) = (0, Vec::new());
    for _ in 0..20_000 {
        let request = frame.draw(&mut random, 0);
        let Some(wanted) = frame.least_norm(&request) else {
            continue;
        };
        served += 1;
        let answer = frame.mix(&request);
        let near = |(a, b): (&f32, &f32)| (a - b).abs() <= 1e-6;
        if !answer.throttle.iter().zip(&wanted).all(near) || answer.saturation.any_axis() {
            faults.push((request, answer, wanted));
        }
    }
    assert!(served > 4000, "{served}");
    assert_none("tilted", served, &faults);
}

/// An X8 with a rotor out, which once lost roll and pitch as a request grew: a larger request of the same direction gets no less of them, but for 2 % of the authority.
#[test]
fn larger_requests_get_no_less() {
    const SIZES: usize = 200;
    const DIRECTIONS: usize = 40;
    let (frame, mut random, mut faults) = (x8(), Random::new(9), Vec::new());
    for thrust in [0.2, 0.4, 0.6, 0.8] {
        for direction in 0..DIRECTIONS {
            let shares = [(); 3].map(|()| random.between(-1.0, 1.0));
            let health = Health::GOOD.with_failed((direction % 8) as u8);
            let mut most = 0.0_f64;
            for size in 1..=SIZES {
                let size = 2.0 * size as f32 / SIZES as f32;
                let [roll, pitch, yaw] = shares.map(|share| size * share);
                let [a, b, c, d] = frame.authority();
                let request = Request {
                    wrench: [roll * a, pitch * b, yaw * c, thrust * d],
                    volts: 14.8,
                    density: 1.2,
                    health,
                };
                let along = frame.along(&request, &frame.mix(&request));
                if along < most - 0.02 {
                    faults.push((most, along, request));
                }
                most = most.max(along);
            }
        }
    }
    assert_none("x8, one out", 4 * DIRECTIONS * SIZES, &faults);
}
