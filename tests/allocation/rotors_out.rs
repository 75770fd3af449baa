//! What no answer may do with one and two rotors out: reverse or exceed an axis, or turn (roll,
//! pitch), wherever level flight is attainable. Requests that once had such answers; drawn ones are
//! the soak's.

use std::fs;

use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES, Options};
use mixer_tests::request::{Frame, Request};
use mixer_tests::root;
use mixer_tests::soundness::{self, Fault};

use crate::{REFERENCE_V, compile_with_pair, number, out};

/// Files whose pairs were identified from benches.
const PAIRS: [&str; 4] = [
    "airframes/isae-x8.toml",
    "airframes/x8-11in-cubic.toml",
    "airframes/x8-16in-quartic.toml",
    "tests/fixtures/rotor-out-x8.toml",
];

/// Share of yaw's authority that is kept in reserve.
const RESERVE: f64 = 0.1;

/// Tables of a file but for its name, its layout and its units.
fn pair(path: &str) -> String {
    let text = fs::read_to_string(root().join(path)).expect("a file of the project");
    let is_kept = |table: &&str| {
        ["throttle]", "pair]", "pair.", "voltage]", "inverse]"]
            .iter()
            .any(|name| table.starts_with(name))
    };
    let tables: Vec<&str> = text.split("\n[").filter(is_kept).collect();
    format!("[{}\n", tables.join("\n["))
}

/// A regular frame with a file's pair.
pub(crate) fn frame(path: &str, units: usize, airmode: &'static str, reserve: f64) -> Frame {
    let first_deg = 180.0 / units as f64;
    let of = |yaw_reserve_nm| {
        let options = Options {
            airmode,
            yaw_reserve_nm,
            ..Options::default()
        };
        compile_with_pair(&pair(path), &frames::regular(units, first_deg), options)
    };
    let plain = of(0.0);
    if reserve == 0.0 {
        return plain;
    }
    of(reserve * plain.authority[2])
}

/// What is wrong with the answer to a request.
fn fault(frame: &Frame, request: &Request) -> Option<Fault> {
    let answer = request.mix(frame).expect("finite");
    soundness::fault(frame, request, &answer).expect("solved")
}

/// A request for yaw alone has no roll in its answer, though the reserve is not attainable.
#[test]
fn a_reserve_yields_to_direction() {
    let frame = frame("airframes/isae-x8.toml", 4, "roll-pitch", RESERVE);
    for (yaw, thrust) in [(-0.2, 24.0), (0.2, 24.0), (-0.2, 40.0), (0.05, 30.0)] {
        for failed in [[0, 5], [1, 4], [2, 7], [0, 3]] {
            let request = Request {
                wrench: [0.0, 0.0, yaw, thrust],
                volts: REFERENCE_V,
                density: None,
                health: out(&failed),
            };
            assert_eq!(fault(&frame, &request), None, "{request:?}");
        }
    }
}

/// Yaw keeps its sign with both rotors of a Y6's last unit out and with one of each of two.
#[test]
fn yaw_keeps_its_sign_on_a_y6() {
    for path in PAIRS {
        for airmode in AIRMODES {
            let frame = frame(path, 3, airmode, 0.0);
            let [.., authority_nm, thrust_n] = frame.authority;
            for failed in [[4, 5], [0, 3], [1, 2], [0, 5]] {
                for share in [-0.24f64, -0.1, 0.1, 0.24] {
                    for thrust in [0.2, 0.4, 0.6] {
                        let yaw = (share * authority_nm) as f32;
                        let request = Request {
                            wrench: [0.0, 0.0, yaw, (thrust * thrust_n) as f32],
                            volts: REFERENCE_V,
                            density: None,
                            health: out(&failed),
                        };
                        assert_eq!(fault(&frame, &request), None, "{path}, {airmode}: {request:?}");
                    }
                }
            }
        }
    }
}

/// Of the wrenches that throttles give with a rotor out, half of them with most rotors at an end of the range, 99.9 % are
/// delivered: none of them needs a judge to be attainable.
#[test]
fn what_the_other_rotors_give_is_delivered() {
    let mut random = Random::new(number("MIXER_SEED", 71));
    let (mut asked, mut missed) = (0, Vec::new());
    for path in [PAIRS[1], PAIRS[2]] {
        for units in [3, 4, 6] {
            let frame = frame(path, units, "roll-pitch", 0.0);
            let count = number("MIXER_REQUESTS", 1000);
            for (channel, request) in [0, 1]
                .into_iter()
                .flat_map(|channel| (0..count).map(move |k| (channel, k)))
            {
                let health = out(&[channel]);
                let shares = (0..2 * units).map(|_| match random.below(3) {
                    end @ (0 | 1) if request % 2 == 0 => end as f64,
                    _ => random.uniform(0.0, 1.0),
                });
                let shares: Vec<f64> = shares.collect();
                let throttles = frame.physics.throttles(shares.into_iter(), health);
                let wrench = frame.physics.wrench(&throttles, REFERENCE_V);
                let request = Request {
                    wrench: wrench.map(|value| value as f32),
                    volts: REFERENCE_V,
                    density: None,
                    health,
                };
                let answer = request.mix(&frame).expect("finite");
                let short = (0..4)
                    .map(|axis| (answer.achieved[axis] - wrench[axis]).abs() / frame.size(axis))
                    .fold(0.0, f64::max);
                asked += 1;
                if short > 0.01 {
                    missed.push((path, units, short, request));
                }
            }
        }
    }
    println!("{} of {asked} missed", missed.len());
    assert!(
        1000 * missed.len() <= asked,
        "{} of {asked}: {missed:#?}",
        missed.len()
    );
}

/// A rotor alone, extrapolated, gives its least thrust well inside the range: no inverse of its thrust
/// is exact there.
const FLAT: &str = "[throttle]
min = 0.2017
max = 0.95

[pair]
basis = \"biquadratic\"
thrust_n = [4.547544, -7.099103, 3.729132, -5.164996, 7.566039, -1.566169, 2.583195, 0.3864211]
torque_nm = [0.00811863, -0.006860399, -0.009858123, -0.01807183, 0.02161001, -0.01600404, 0.00818081, 0.0100284]
upper_spin = \"cw\"
";

/// The throttle of a single rotor is the one at which its efforts were judged.
#[test]
fn yaw_keeps_its_sign_where_the_curve_of_a_rotor_alone_is_flat() {
    let options = Options {
        airmode: "roll-pitch-yaw",
        ..Options::default()
    };
    let frame = compile_with_pair(FLAT, &frames::regular(6, 30.0), options);
    let mut random = Random::new(number("MIXER_SEED", 5));
    for failed in 0..12 {
        for _ in 0..200 {
            let mut request = frame.draw(&mut random, 3.0, REFERENCE_V);
            request.health = out(&[failed]);
            assert_eq!(fault(&frame, &request), None, "{request:?}");
        }
    }
}
