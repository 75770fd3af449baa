//! Requests that grow along a ray with rotors out: what is given of roll, pitch and thrust does not
//! fall. A smaller answer stays attainable, so an answer that gives less is no optimum; no oracle is
//! needed to see that.

use mixer_setpoints::Random;
use mixer_tests::frames::{self, AIRMODES};
use mixer_tests::request::{Frame, Request};

use crate::{REFERENCE_V, compile, has_level, number, out};

/// Share of the authority by which an answer may give less than that to a smaller request.
const LOSS: f64 = 0.02;

/// One request in so many may.
const ONE_IN: usize = 10_000;

/// Requests per ray, the last of them of the authority.
const STEPS: usize = 20;

/// What is given along a ray.
#[derive(Clone, Copy, Debug)]
enum Ray {
    /// Roll, pitch and yaw grow at a thrust.
    Torques([f32; 4]),
    /// Thrust grows alone.
    Thrust,
}

impl Ray {
    fn draw(frame: &Frame, random: &mut Random) -> Ray {
        if random.below(4) == 0 {
            return Ray::Thrust;
        }
        let yaw = [0.0, 0.3, 1.0][random.below(3)];
        let shares = [1.0, 1.0, yaw].map(|size| random.uniform(-size, size));
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis| (shares[axis] * frame.authority[axis]) as f32);
        let thrust = random.uniform(0.15, 0.95) * frame.authority[3];
        Ray::Torques([roll, pitch, yaw, thrust as f32])
    }

    fn wrench(self, frame: &Frame, share: f32) -> [f32; 4] {
        match self {
            Ray::Torques([roll, pitch, yaw, thrust]) => [share * roll, share * pitch, share * yaw, thrust],
            Ray::Thrust => [0.0, 0.0, 0.0, share * frame.authority[3] as f32],
        }
    }

    /// What counts of an answer, as a share of the authority.
    fn given(self, frame: &Frame, achieved: [f64; 4]) -> f64 {
        match self {
            Ray::Torques([roll, pitch, ..]) => {
                let [roll, pitch] = [roll, pitch].map(f64::from);
                let along = achieved[0] * roll + achieved[1] * pitch;
                along / (roll * roll + pitch * pitch).sqrt() / frame.size(0).min(frame.size(1))
            }
            Ray::Thrust => achieved[3] / frame.size(3),
        }
    }
}

#[test]
fn a_larger_request_gets_no_less_with_rotors_out() {
    let mut random = Random::new(number("MIXER_SEED", 14));
    let (mut requests, mut losses) = (0, 0);
    for (name, units, first_deg) in [("Y6", 3, 60.0), ("X8", 4, 45.0), ("X12", 6, 30.0)] {
        for airmode in AIRMODES {
            let places = frames::regular(units, first_deg);
            let plain = compile(&places, airmode, 0.0);
            let kept = compile(&places, airmode, 0.1 * plain.authority[2]);
            for (frame, count) in [&plain, &kept]
                .into_iter()
                .flat_map(|frame| [(frame, 1), (frame, 2)])
            {
                for _ in 0..number("PROPTEST_CASES", 32) {
                    let first = random.below(2 * units);
                    let second = (first + 1 + random.below(2 * units - 1)) % (2 * units);
                    let failed = [first as u8, second as u8];
                    let ray = Ray::draw(frame, &mut random);
                    let mut best: Option<(f64, Request)> = None;
                    for step in 1..=STEPS {
                        let request = Request {
                            wrench: ray.wrench(frame, step as f32 / STEPS as f32),
                            volts: REFERENCE_V,
                            health: out(&failed[..count]),
                        };
                        let answer = request.mix(frame).expect("finite");
                        let given = ray.given(frame, answer.achieved);
                        requests += 1;
                        match &best {
                            Some((most, smaller)) if given < most - LOSS => {
                                if has_level(frame, smaller) {
                                    losses += 1;
                                    println!(
                                        "{name}, {airmode}, reserve {}: {request:?} -> {:?}, {given} of the authority where {smaller:?} gets {most}",
                                        frame.allocation().yaw_reserve_nm,
                                        answer.achieved
                                    );
                                }
                            }
                            Some((most, _)) if given <= *most => {}
                            _ => best = Some((given, request)),
                        }
                    }
                }
            }
        }
    }
    println!("{losses} of {requests} requests get less than a smaller one");
    assert!(requests >= 2 * ONE_IN || number("PROPTEST_CASES", 32) < 32);
    assert!(losses * ONE_IN <= requests, "{losses} of {requests}");
}
