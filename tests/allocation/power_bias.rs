//! Least power: the same promises with a bias, the same wrench as without, and torques that follow
//! the thrusts.

use mixer_rt::Health;
use mixer_tests::frames::{self, AIRMODES, Options, Place};
use mixer_tests::request::{Answer, Frame, Request};
use proptest::prelude::*;

use crate::REFERENCE_V;
use crate::layout::{any_request, attainable_request, biased_layout};
use crate::properties::{config, each, many, sound};
use crate::{all_rotors, place};

/// A usual bias of the paper's pair, N m per N.
const BIAS: f64 = 0.004;

fn biased(places: &[Place], airmode: &'static str, power_bias_nm_per_n: f64) -> Frame {
    let options = Options {
        airmode,
        power_bias_nm_per_n,
        ..Options::default()
    };
    Frame::new(frames::compile(places, options).unwrap_or_else(|faults| panic!("{faults}")))
}

/// Thrust and torque of every unit at the reference voltage, by the file's polynomials.
fn efforts(frame: &Frame, answer: &Answer) -> Vec<[f64; 2]> {
    let channels = frame.physics.channels.iter();
    channels
        .map(|pair| pair.map(|channel| f64::from(answer.throttle[channel])))
        .map(|throttles| frame.physics.pairs[0].efforts(throttles))
        .collect()
}

fn mix(frame: &Frame, wrench: [f32; 4], volts: f32) -> Answer {
    all_rotors(wrench, volts).mix(frame).expect("finite")
}

/// The wrench is the same but for what the inverse map may miss, with and without the bias.
fn is_kept(frame: &Frame, [without, with]: [&Answer; 2]) -> bool {
    let tolerance = frame.compiled.tables.tolerance.wrench.map(f64::from);
    let mut axes = (0..4).filter(|&axis| frame.served()[axis]);
    axes.all(|axis| (without.achieved[axis] - with.achieved[axis]).abs() <= 2.0 * tolerance[axis])
}

proptest! {
    #![proptest_config(config())]

    /// Where a bias changes an answer, all rotors turn, the wrench stays, nothing is flagged. Elsewhere
    /// the answer has the bits of that without.
    #[test]
    fn a_bias_keeps_the_wrench(
        layout in biased_layout(),
        draws in many(prop_oneof![any_request(1), attainable_request(0.02)], 300),
    ) {
        let plain = layout.without_power_bias().frame().ok_or_else(|| TestCaseError::reject("no frame"))?;
        each(&layout, &draws, |frame, draw| {
            let request = draw.of(frame);
            let [without, with] = [&plain, frame].map(|frame| request.mix(frame).expect("finite"));
            if without == with {
                return Ok(());
            }
            prop_assert!(request.health.is_good(), "{:?}", request);
            prop_assert!(is_kept(frame, [&without, &with]), "{:?}: {:?}, {:?}", request, without, with);
            prop_assert!(!with.saturation.any_axis() || without.saturation.any_axis(), "{:?}", request);
            sound(frame, draw)
        })?;
    }
}

/// Level at half thrust every unit has Q = c f, in closed form and without one, and the
/// wrench is that without.
#[test]
fn level_torques_are_the_bias_times_the_thrust() {
    let frames = [(4, "disabled"), (4, "roll-pitch-yaw"), (6, "disabled")];
    for ((n, airmode), bias) in frames
        .into_iter()
        .flat_map(|frame| [(frame, BIAS), (frame, -BIAS)])
    {
        let frame = biased(&frames::regular(n, 45.0), airmode, bias);
        let wrench = [0.0, 0.0, 0.0, 12.0 * n as f32];
        for [f, q] in efforts(&frame, &mix(&frame, wrench, REFERENCE_V)) {
            assert!((f - 12.0).abs() < 0.011, "{n} {airmode}: {f} N");
            assert!((q - bias * f).abs() < 2e-4, "{n} {airmode}: {q} N m at {f} N");
        }
    }
}

/// With roll, pitch and yaw the torques are c f and their part of yaw, less what c f gives of yaw
/// in all, alike per unit.
#[test]
fn torques_give_the_yaw_asked_beside_the_bias() {
    for (airmode, volts) in AIRMODES.into_iter().zip([REFERENCE_V, 13.2, 16.0]) {
        let frame = biased(&frames::regular(4, 45.0), airmode, BIAS);
        let wrench = [0.9, -0.4, 0.08, 45.0];
        let answer = mix(&frame, wrench, volts);
        let yaw_at_reference = f64::from(wrench[2]) / frame.physics.factors(volts)[1];
        let efforts = efforts(&frame, &answer);
        let spins = [1.0, -1.0, 1.0, -1.0];
        let lost: f64 = efforts.iter().zip(spins).map(|([f, _], s)| s * BIAS * f).sum();
        for ([f, q], s) in efforts.iter().zip(spins) {
            let expected = BIAS * f + s * (yaw_at_reference - lost) / 4.0;
            assert!((q - expected).abs() < 3e-4, "{airmode}: {q}, not {expected}");
        }
    }
}

/// Tilted axes couple thrust and torque: the shift is then one of thrusts, too, and still none of
/// the wrench.
#[test]
fn tilted_frames_keep_their_wrench() {
    let places = [
        place([0.31, 0.32, 0.0], [0.06, -0.05], true),
        place([-0.33, 0.30, 0.0], [-0.05, -0.06], false),
        place([-0.30, -0.34, 0.0], [-0.06, 0.05], true),
        place([0.32, -0.31, 0.0], [0.05, 0.07], false),
    ];
    let [plain, frame] = [0.0, BIAS].map(|bias| biased(&places, "disabled", bias));
    let wrench = [0.5, 0.3, 0.05, 48.0];
    let answers = [&plain, &frame].map(|frame| mix(frame, wrench, REFERENCE_V));
    let [without, with] = &answers;
    assert!(is_kept(&frame, [without, with]), "{without:?}, {with:?}");
    assert!(!with.saturation.any_axis(), "{with:?}");
    let [without, with] = answers.map(|answer| efforts(&frame, &answer));
    let moved = without
        .iter()
        .zip(&with)
        .map(|([_, before], [f, after])| (after - before) / (BIAS * f));
    for moved in moved {
        assert!((0.8..1.1).contains(&moved), "{moved} of the bias");
    }
}

/// Towards the end of yaw the bias fades to none, and nothing jumps on the way; beyond, answers are
/// bit for bit those without.
#[test]
fn the_bias_fades_before_yaw_saturates() {
    for (name, places) in frames::regular_frames() {
        if name == "Y6" {
            continue; // no freedom in level flight
        }
        for airmode in AIRMODES {
            let [plain, frame] = [0.0, BIAS].map(|bias| biased(&places, airmode, bias));
            let thrust = 12.0 * places.len() as f32;
            let (mut last, mut largest, mut equal) = (None::<[Answer; 2]>, [0.0f32; 2], 0);
            for step in 0..2000 {
                let yaw = 6e-4 * step as f32 * places.len() as f32 / 4.0;
                let request = all_rotors([0.0, 0.0, yaw, thrust], REFERENCE_V);
                let answers = [&plain, &frame].map(|frame| request.mix(frame).expect("finite"));
                if let Some(last) = &last {
                    largest = [0, 1].map(|k| largest[k].max(answers[k].change(&last[k])));
                }
                let [without, with] = &answers;
                if without.saturation.any_axis() {
                    assert_eq!(without.throttle, with.throttle, "{name} {airmode} {yaw}");
                    equal += 1;
                }
                last = Some(answers);
            }
            assert!(equal > 100, "{name} {airmode}: yaw never saturates");
            let [without, with] = largest;
            assert!(
                with <= without.max(0.004),
                "{name} {airmode}: a throttle moves by {with}, {without} without a bias"
            );
        }
    }
}

/// While a rotor is out there is no bias: answers are bit for bit those without.
#[test]
fn a_rotor_out_suspends_the_bias() {
    let [plain, frame] = [0.0, BIAS].map(|bias| biased(&frames::regular(4, 45.0), "disabled", bias));
    let request = Request {
        wrench: [0.1, 0.0, 0.0, 40.0],
        volts: REFERENCE_V,
        density: None,
        health: Health::GOOD.with_failed(5),
    };
    let [without, with] = [&plain, &frame].map(|frame| request.mix(frame).expect("finite"));
    assert_eq!(without, with);
}
