//! An X8 that loses any one rotor keeps a fifth of its roll and pitch and all of its thrust at 60 %
//! of full thrust; the most that is left of roll, pitch and yaw is printed.

use mixer_rt::Health;
use mixer_tests::frames;
use mixer_tests::optimum::Oracle;
use mixer_tests::request::{Answer, Frame, Request};
use mixer_tests::{shortfall::Shortfall, soundness};

use crate::{REFERENCE_V, compile};

/// Share of full thrust.
const HOVER: f64 = 0.6;

/// Roll and pitch that are left in any direction, as shares of what the whole vehicle has at the
/// same thrust.
const LEFT: [f32; 4] = [0.01, 0.05, 0.1, 0.2];

/// Directions of (roll, pitch).
const DIRECTIONS: [[f32; 2]; 8] = [
    [1.0, 0.0],
    [0.8, 0.6],
    [0.0, 1.0],
    [-0.6, 0.8],
    [-1.0, 0.0],
    [-0.7, -0.7],
    [0.0, -1.0],
    [0.7, -0.7],
];

/// An X8 with or without its rotors at [`HOVER`].
struct Flight {
    frame: Frame,
    health: Health,
    thrust: f32,
}

impl Flight {
    fn request(&self, [roll, pitch, yaw]: [f32; 3]) -> Request {
        Request {
            wrench: [roll, pitch, yaw, self.thrust],
            volts: REFERENCE_V,
            density: None,
            health: self.health,
        }
    }

    /// What `[roll, pitch, yaw]` come to.
    fn fly(&self, torques: [f32; 3]) -> Answer {
        let request = self.request(torques);
        let answer = request.mix(&self.frame).expect("finite");
        let fault = soundness::fault(&self.frame, &request, &answer).expect("solved");
        assert_eq!(fault, None, "{request:?} -> {answer:?}");
        answer
    }

    /// The share of (roll, pitch) that is possible; the answer must be as good.
    fn possible(&self, torques: [f32; 3]) -> f64 {
        let (request, answer) = (self.request(torques), self.fly(torques));
        let oracle = Oracle::new(
            &self.frame.physics,
            self.frame.allocation(),
            [1.0; 2],
            self.health,
        );
        let shortfall = Shortfall::of(&answer, &request, &self.frame, &oracle).expect("solved");
        let shortfall = shortfall.expect("an X8 flies without any one rotor");
        assert!(!shortfall.misses(), "{request:?} -> {answer:?}: {shortfall:?}");
        let optimum = oracle.optimum(request.asked()).expect("solved");
        optimum.expect("an X8 flies without any one rotor").share
    }

    /// Asserts that roll, pitch and thrust are delivered but for 0.1 % of their authority and what
    /// the inverse map may miss.
    fn keeps(&self, [roll, pitch]: [f32; 2]) {
        let achieved = self.fly([roll, pitch, 0.0]).achieved;
        let tolerance = self.frame.compiled.tables.tolerance.wrench;
        for (axis, asked) in [(0, roll), (1, pitch), (3, self.thrust)] {
            let allowed = f64::from(tolerance[axis]) + 1e-3 * self.frame.authority[axis];
            let missed = (achieved[axis] - f64::from(asked)).abs();
            assert!(
                missed <= allowed,
                "{:?} {roll} {pitch}: {achieved:?}",
                self.health
            );
        }
    }
}

#[test]
fn an_x8_without_a_rotor_still_flies() {
    for airmode in ["disabled", "roll-pitch"] {
        let frame = compile(&frames::regular(4, 45.0), airmode, 0.0);
        let thrust = (HOVER * f64::from(frame.compiled.thrust_range_n[1])) as f32;
        let mut flight = Flight {
            frame,
            health: Health::GOOD,
            thrust,
        };
        let most = flight.fly([100.0, 0.0, 0.0]).achieved[0] as f32;
        println!("{airmode}: the whole X8 has {most:.2} N m of roll at {thrust:.1} N");
        for channel in 0..8u8 {
            flight.health = Health::GOOD.with_failed(channel);
            flight.keeps([0.0; 2]);
            let mut least = f64::INFINITY;
            for direction in DIRECTIONS {
                let of = |share: f32| direction.map(|part| share * most * part);
                for size in LEFT {
                    flight.keeps(of(size));
                }
                let [roll, pitch] = of(1.0);
                least = least.min(flight.possible([roll, pitch, 0.0]));
            }
            let yaw = [-10.0, 10.0].map(|yaw| flight.fly([0.0, 0.0, yaw]).achieved[2]);
            println!(
                "  rotor {channel} out: {:.0} % of roll and pitch in the worst direction, yaw {:.3} to {:.3} N m",
                100.0 * least,
                yaw[0],
                yaw[1]
            );
            // Yaw is left on either side.
            assert!(yaw[0] < -0.1 && yaw[1] > 0.1, "{channel}: {yaw:?}");
        }
    }
}
