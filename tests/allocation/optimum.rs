//! Answers against linear programmes over the physical attainable sets: frames in closed form miss
//! none. How often others do is the soak's.

use mixer_rt::Health;
use mixer_setpoints::Random;
use mixer_tests::frames::{self, Options};
use mixer_tests::optimum::Oracle;
use mixer_tests::request::Frame;
use mixer_tests::shortfall::{ALLOWED, Shortfall};

use crate::{REFERENCE_V, number};

#[derive(Default)]
pub(crate) struct Judged {
    pub(crate) requests: usize,
    /// Requests without an optimum: not even roll = pitch = 0 is attainable.
    void: usize,
    /// Requests on which the optimum is missed.
    pub(crate) missed: usize,
    pub(crate) worst: Shortfall,
}

impl Judged {
    /// Judges `count` requests at one voltage and one state of health.
    pub(crate) fn judge(
        &mut self,
        frame: &Frame,
        random: &mut Random,
        (volts, health): (f32, Health),
        count: usize,
    ) {
        let factors = frame.physics.factors(volts);
        let oracle = Oracle::new(&frame.physics, frame.allocation(), factors, health);
        for _ in 0..count {
            let mut request = frame.draw(random, 0.6, volts);
            request.health = health;
            let answer = request.mix(frame).expect("finite");
            let exact = || Oracle::exact(&frame.physics, frame.allocation(), factors, health);
            let shortfall = Shortfall::beyond_hulls(&answer, &request, frame, ALLOWED, &oracle, exact);
            let Some(shortfall) = shortfall.expect("solved") else {
                self.void += 1;
                continue;
            };
            self.requests += 1;
            self.worst = self.worst.max(shortfall);
            if shortfall.misses() {
                self.missed += 1;
                if std::env::var_os("MIXER_MISSES").is_some() {
                    println!(
                        "{} units, {:?}: {request:?} -> {:?}\n    {shortfall:?} of {:?}",
                        frame.compiled.airframe.units.len(),
                        frame.allocation(),
                        answer.achieved,
                        oracle.optimum(request.asked()),
                    );
                }
            }
        }
    }

    pub(crate) fn print(&self, name: &str) {
        let Shortfall { torque, yaw, thrust } = self.worst;
        println!(
            "{name}: {} of {} miss the optimum; worst roll-pitch {:.2} %, thrust {:.2} %, yaw {:.2} %; {} void",
            self.missed,
            self.requests,
            100.0 * torque,
            100.0 * thrust,
            100.0 * yaw,
            self.void
        );
    }
}

/// Random numbers from a fixed seed; `MIXER_SEED` sets another.
fn random(seed: u64) -> Random {
    Random::new(number("MIXER_SEED", seed))
}

/// An irregular frame that can hover, for about each that is asked for.
fn irregular(random: &mut Random, units: usize, tilt: f64, options: Options) -> Option<Frame> {
    let places = frames::irregular(random, units, tilt);
    frames::compile(&places, options).ok().map(Frame::new)
}

#[test]
fn vertical_frames_of_three_and_four_units_reach_the_optimum() {
    let mut random = random(2);
    for n in [3, 4] {
        for airmode in ["disabled", "roll-pitch"] {
            let options = Options {
                airmode,
                ..Options::default()
            };
            let mut judged = Judged::default();
            let regular = frames::compile(&frames::regular(n, 45.0), options).map(Frame::new);
            let others = (0..4).filter_map(|_| irregular(&mut random, n, 0.0, options));
            let frames: Vec<Frame> = regular.into_iter().chain(others).collect();
            for frame in &frames {
                assert!(frame.compiled.tables.closed_form.is_some());
                for volts in [REFERENCE_V, frame.draw_volts(&mut random)] {
                    judged.judge(frame, &mut random, (volts, Health::GOOD), 20);
                }
            }
            judged.print(&format!("{n} vertical units, {airmode}"));
            assert!(judged.requests >= 120);
            assert_eq!(judged.missed, 0);
        }
    }
}
