//! A reserve of yaw on the frames of the closed form: X8s and Y6s, with real pairs and irregular.

use mixer_rt::Health;
use mixer_setpoints::Random;
use mixer_tests::frames::{self, Options};
use mixer_tests::request::{Frame, Request};
use mixer_tests::soundness;

use crate::delivery::{PAIRS, pair_of};
use crate::number;
use crate::optimum::Judged;

/// Share of the yaw of level flight at half of all thrust that is kept.
const KEPT: f32 = 0.2;

/// The largest change of a throttle for a change of 1e-4 of the request.
const JUMP: f32 = 0.02;

/// A frame with a reserve and the same without.
struct Pair {
    name: String,
    kept: Frame,
    plain: Frame,
    reserve: f32,
}

/// X8s and Y6s with the pairs of `airframes/`, and irregular frames of three and four units with
/// the paper's, with either airmode.
fn pairs(random: &mut Random) -> Vec<Pair> {
    let regular = [("X8", frames::regular(4, 45.0)), ("Y6", frames::regular(3, 60.0))];
    let regular = PAIRS.iter().flat_map(|&pair| {
        regular
            .clone()
            .map(|(name, places)| (format!("{name}, {pair}"), pair, places))
    });
    let irregular = (0..6).map(|k| {
        let places = frames::irregular(random, 3 + k % 2, 0.0);
        (format!("irregular {k}"), PAIRS[0], places)
    });
    let mut pairs = Vec::new();
    for (name, pair, places) in regular.chain(irregular) {
        for airmode in ["disabled", "roll-pitch"] {
            let of = |yaw_reserve_nm| {
                let options = Options {
                    airmode,
                    yaw_reserve_nm,
                    ..Options::default()
                };
                let channels: Vec<usize> = (0..2 * places.len()).collect();
                let text = frames::toml_with_pair(&pair_of(pair), &places, &channels, options);
                frames::compile_text(&text).ok().map(Frame::new)
            };
            // One that cannot hover is refused.
            let Some(plain) = of(0.0) else { continue };
            let half = 0.5 * plain.authority[3] as f32;
            let most = plain.authority[2] as f32;
            let reserve = [most, -most].map(|yaw| given(&plain, [0.0, 0.0, yaw, half])[2].abs());
            let reserve = KEPT * reserve[0].min(reserve[1]);
            let kept = of(f64::from(reserve)).expect("as without");
            assert!(kept.compiled.tables.closed_form.is_some());
            pairs.push(Pair {
                name: format!("{name}, {airmode}"),
                kept,
                plain,
                reserve,
            });
        }
    }
    pairs
}

fn request(wrench: [f32; 4]) -> Request {
    Request {
        wrench,
        volts: 0.0,
        health: Health::GOOD,
    }
}

fn given(frame: &Frame, wrench: [f32; 4]) -> [f32; 4] {
    let answer = request(wrench).mix(frame).expect("finite");
    answer.achieved.map(|value| value as f32)
}

/// Where the answer without the reserve delivers it, that is the answer to the bit. Otherwise it is
/// sound, and its throttles do not jump.
#[test]
fn answers_with_a_reserve_are_sound_and_no_others_without_need() {
    let mut random = Random::new(number("MIXER_SEED", 31));
    let count = number("MIXER_REQUESTS", 1000);
    let (mut bound, mut all) = (0, 0);
    for Pair {
        name,
        kept,
        plain,
        reserve,
    } in pairs(&mut random)
    {
        for _ in 0..count {
            let request = kept.draw(&mut random, 1.0, 0.0);
            let [answer, free] = [&kept, &plain].map(|frame| request.mix(frame).expect("finite"));
            let yaw = request.asked()[2];
            let needed = yaw.abs().min(f64::from(reserve));
            all += 1;
            // Beyond what a retreat to zero yaw may give by its last step.
            if free.achieved[2] * yaw.signum() >= needed + 1e-3 * kept.authority[2] {
                assert_eq!(answer.throttle, free.throttle, "{name}: {request:?}");
                continue;
            }
            bound += 1;
            let fault = soundness::fault(&kept, &request, &answer).expect("solved");
            assert_eq!(fault, None, "{name}: {request:?} -> {answer:?}");
            let mut near = request;
            let moved = random.below(5);
            for (axis, value) in near.wrench.iter_mut().enumerate() {
                if moved == 4 || moved == axis {
                    *value *= 1.0 + 1e-4;
                }
            }
            let change = answer.change(&near.mix(&kept).expect("finite"));
            assert!(change <= JUMP, "{name}: {change} from {request:?} to {near:?}");
        }
    }
    println!("the reserve binds on {bound} of {all} requests");
    assert!(bound * 20 >= all, "{bound} of {all}");
}

#[test]
fn answers_with_a_reserve_reach_the_optimum() {
    let mut random = Random::new(number("MIXER_SEED", 32));
    let count = number("MIXER_REQUESTS", 40) as usize;
    let mut all = Judged::default();
    for Pair { name, kept, .. } in pairs(&mut random) {
        let mut judged = Judged::default();
        judged.judge(&kept, &mut random, (0.0, Health::GOOD), count);
        judged.print(&name);
        all.add(&judged);
    }
    all.print("all");
    assert!(all.requests >= 1000 || count < 40);
    assert!(
        all.missed * 100 <= all.requests,
        "{} of {}",
        all.missed,
        all.requests
    );
}

/// Full thrust keeps the reserve; without it yaw would be gone. A reserve raises no thrust with
/// airmode "disabled", and what level flight hardly has is left to roll and pitch by half.
#[test]
fn a_reserve_is_kept_at_full_thrust_and_yields_at_little() {
    for Pair {
        name,
        kept,
        plain,
        reserve,
    } in pairs(&mut Random::new(33))
    {
        let [roll, _, yaw, thrust] = kept.authority.map(|authority| authority as f32);
        let slack = 1e-3 * yaw;
        for yaw in [yaw, -yaw] {
            let full = given(&kept, [0.0, 0.0, yaw, 1.2 * thrust]);
            assert!(full[2] * yaw.signum() >= reserve - slack, "{name}: {full:?}");
            if !name.ends_with("disabled") {
                continue;
            }
            let floor = given(&plain, [0.0; 4])[3];
            for part in 0..10 {
                let little = floor + 0.01 * part as f32 * thrust;
                let level = given(&kept, [0.0, 0.0, yaw, little]);
                let turned = given(&kept, [0.3 * roll, 0.0, yaw, little]);
                let free = given(&plain, [0.3 * roll, 0.0, 0.0, little]);
                for wrench in [level, turned] {
                    assert!(
                        wrench[3] <= little + 2e-3 * thrust,
                        "{name}: {little}: {wrench:?}"
                    );
                }
                assert!(
                    turned[0] >= 0.5 * free[0] - 1e-3 * roll,
                    "{name}: {turned:?}, {free:?} without yaw"
                );
            }
        }
    }
}
