//! Requests that no controller sends, voltages that no battery has, and frames at the edge of what
//! makes sense.

use std::f64::consts::TAU;

use mixer_rt::{Axis, Health, SetpointError};
use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Place};
use mixer_tests::golden;
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::soundness;

use crate::{REFERENCE_V, all_rotors, compile};

pub(crate) const NUMBERS: [f32; 14] = [
    0.0,
    -0.0,
    1e-40,
    -1e-40,
    1e-6,
    0.1,
    -0.1,
    1.0,
    40.0,
    -40.0,
    1e4,
    1e30,
    f32::MAX,
    f32::MIN,
];

pub(crate) fn at(position: [f64; 3], clockwise: bool) -> Place {
    Place {
        position,
        axis: [0.0, 0.0, -1.0],
        clockwise,
    }
}

pub(crate) fn degenerate_frames() -> [(&'static str, Vec<Place>); 4] {
    // Lever arms that differ by a factor of ten.
    let mut uneven = frames::regular(6, 0.0);
    for (k, place) in uneven.iter_mut().enumerate() {
        place.position = place.position.map(|x| if k % 3 == 0 { 0.2 * x } else { 2.0 * x });
    }
    [
        ("one unit", vec![at([0.0; 3], true)]),
        (
            "two units",
            vec![at([0.0, 0.3, 0.0], true), at([0.0, -0.3, 0.0], false)],
        ),
        ("X8", frames::regular(4, 45.0)),
        ("uneven arms", uneven),
    ]
}

#[test]
fn degenerate_requests_are_answered() {
    let mut random = Random::new(6);
    for (name, places) in degenerate_frames() {
        for airmode in AIRMODES {
            let frame = compile(&places, airmode, 0.0);
            for _ in 0..200 {
                let request = Request {
                    wrench: std::array::from_fn(|_| NUMBERS[random.below(NUMBERS.len())]),
                    volts: match random.below(2) {
                        0 => REFERENCE_V,
                        _ => NUMBERS[random.below(NUMBERS.len())],
                    },
                    density: None,
                    health: Health::GOOD,
                };
                let answer = request.mix(&frame).expect("finite");
                let fault = soundness::fault(&frame, &request, &answer).expect("solved");
                assert_eq!(fault, None, "{name} {airmode}: {request:?} -> {answer:?}");
            }
        }
    }
}

#[test]
fn what_is_not_finite_is_refused_by_name() {
    for (name, places) in degenerate_frames() {
        let frame = compile(&places, "disabled", 0.0);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for (index, axis) in Axis::ALL.into_iter().enumerate() {
                let mut request = Request {
                    wrench: [0.0, 0.0, 0.0, 20.0],
                    volts: REFERENCE_V,
                    density: None,
                    health: Health::GOOD,
                };
                request.wrench[index] = bad;
                assert_eq!(request.mix(&frame), Err(SetpointError::NonFinite(axis)), "{name}");
            }
            let request = Request {
                wrench: [0.0, 0.0, 0.0, 20.0],
                volts: bad,
                density: None,
                health: Health::GOOD,
            };
            assert_eq!(
                request.mix(&frame),
                Err(SetpointError::NonFiniteVoltage),
                "{name}"
            );
        }
    }
}

#[test]
fn an_airframe_without_voltage_takes_any() {
    let frame = Frame::new(golden::compile("single-pair").expect("compiles"));
    assert_eq!(frame.compiled.tables.corrections.voltage, None);
    let at = |volts| {
        let request = Request {
            wrench: [0.0, 0.0, 0.05, 10.0],
            volts,
            density: None,
            health: Health::GOOD,
        };
        request.mix(&frame).expect("finite")
    };
    for volts in NUMBERS
        .into_iter()
        .chain([f32::NAN, f32::INFINITY, f32::NEG_INFINITY])
    {
        assert_eq!(at(volts), at(REFERENCE_V), "{volts}");
    }
    assert!(!at(f32::NAN).saturation.voltage_clamped());
}

/// NaN, infinity, zero and less are no density: the mix is that at the bench's, and flagged. A density beyond
/// the range is the nearest within, flagged as well; none else is.
#[test]
fn no_density_means_that_of_the_bench() {
    let frame = Frame::new(golden::compile("x8-11in-least-power").expect("compiles"));
    let at = |density| {
        let request = Request {
            wrench: [0.3, -0.2, 0.05, 30.0],
            volts: 11.0,
            density,
            health: Health::GOOD,
        };
        request.mix(&frame).expect("finite")
    };
    let same = |a: &Answer, b: &Answer| a.throttle == b.throttle && a.achieved == b.achieved;
    let bench = at(None);
    assert!(!bench.saturation.density_clamped() && same(&bench, &at(Some(1.2))));
    for none in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0, -1.2] {
        let answer = at(Some(none));
        assert!(
            answer.saturation.density_clamped() && same(&answer, &bench),
            "{none}"
        );
    }
    let [low, high] = frame
        .physics
        .density_range()
        .expect("[air]")
        .map(|density| density as f32);
    for (within, beyond) in [
        (low, 1e-40),
        (low, 0.9 * low),
        (high, 1.1 * high),
        (high, f32::MAX),
    ] {
        let (within, beyond) = (at(Some(within)), at(Some(beyond)));
        assert!(!within.saturation.density_clamped() && beyond.saturation.density_clamped());
        assert!(same(&within, &beyond) && !same(&within, &bench));
    }
    let without = Frame::new(golden::compile("isae-x8").expect("compiles"));
    for density in [f32::NAN, 0.5] {
        let request = |density| Request {
            wrench: [0.3, -0.2, 0.05, 30.0],
            volts: 14.0,
            density,
            health: Health::GOOD,
        };
        assert_eq!(request(Some(density)).mix(&without), request(None).mix(&without));
    }
}

/// About a centre of gravity that is a little off, two facets are nearly walls: along them half the thrust would be
/// given up for a trace of roll and pitch, and throttles would follow in steps.
#[test]
fn throttles_follow_along_steep_facets() {
    const NEXT: f64 = 1e-4;
    let mut places = frames::regular(4, 45.0);
    for place in &mut places {
        place.position[0] += 0.012;
        place.position[1] -= 0.008;
    }
    let frame = compile(&places, "disabled", 0.0);
    for direction in 0..24 {
        let (sin, cos) = libm::sincos(f64::from(direction) * TAU / 24.0);
        let mut before: Option<Answer> = None;
        for k in 2000..6000 {
            let size = NEXT * f64::from(k);
            let shares = [cos * size, sin * size, 0.0, 0.9];
            let asked: [f32; 4] = std::array::from_fn(|axis| (shares[axis] * frame.authority[axis]) as f32);
            let answer = all_rotors(asked, REFERENCE_V).mix(&frame).expect("finite");
            let step = before.map_or(0.0, |before| answer.change(&before));
            assert!(step < 0.02, "{step} at {asked:?}");
            before = Some(answer);
        }
    }
}
