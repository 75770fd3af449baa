//! Thrust and torque of a coaxial pair from those of its rotors alone.
//!
//! Momentum theory: a rotor of thrust T draws air at a speed whose square is proportional to T.
//! Below it the wake contracts and speeds up with the distance z, above it the drawn air fades:
//! h = 1 - zeta / sqrt(1 + zeta^2), zeta = 2 z / D, falls from 1 at the rotor to 0 far away.
//! Blade element: at a held command the thrust falls in proportion to the inflow. Taking the inflow
//! as the root of the sum of two squares, of the rotor's own at its thrust alone T0 and of a share c
//! of the other rotor's at its thrust T, gives
//!
//! ```text
//! T0 (1 + B - B sqrt(1 + c T / T0)),     c = m0 - m1 h below the other rotor, n h above it
//! ```
//!
//! B is the slope of thrust over inflow. The torque of the lower rotor falls with the cube of the ratio of
//! speeds r^2 = T_upper / T0_lower, down to a limit; that of the upper rotor stays:
//!
//! ```text
//! Q_lower = Q0 (1 - a r^3 / (1 + b r^3)),     f = T_upper + T_lower,     Q = Q_lower - Q_upper
//! ```
//!
//! Neither size, speed nor air density enters.

use crate::rotor::curve::Rotor;

/// The six constants of the interaction, each without a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interaction {
    /// B, m0, m1, n, a, b.
    pub constants: [f64; 6],
}

/// Throttle commands a share of the supply voltage, as most speed controllers do.
///
/// Fitted on 52 maps of five systems of 11 to 22 inch at z/D 0.1 to 1. `cargo interaction`
/// measures them on the bench data of `MIXER_BENCH_DATA` against constants that it fits there with
/// one system left out; docs/no-bench.md has its table.
pub const OPEN_LOOP: Interaction = Interaction {
    constants: [1.75, 0.55, 0.09, 0.12, 0.124, 0.056],
};

/// Throttle commands a rotor's speed, which the speed controller holds. Of the same maps over their
/// measured speeds.
pub const CLOSED_LOOP: Interaction = Interaction {
    constants: [4.28, 0.219, 0.038, 0.050, 0.154, 0.045],
};

/// Ratio of speeds beyond which the lower rotor idles under a fast upper one; nothing was measured
/// there.
const LARGEST_RATIO: f64 = 6.0;

/// Thrusts depend on one another weakly: a step of the fixed point shrinks its error by n m0 B^2 / 4
/// or less, which is a twentieth.
const STEPS: usize = 10;

impl Interaction {
    /// Thrust (N) and torque (N m, positive where the lower rotor outweighs the upper) at throttles
    /// `[u, l]` in (0, 1], of rotors at a spacing z/D.
    pub fn pair(&self, [upper, lower]: &[Rotor; 2], spacing_ratio: f64, [u, l]: [f64; 2]) -> [f64; 2] {
        let [b, m0, m1, n, loss, limit] = self.constants;
        let zeta = 2.0 * spacing_ratio;
        let h = 1.0 - zeta / (1.0 + zeta * zeta).sqrt();
        let [upper_alone, lower_alone] = [(upper, u), (lower, l)]
            .map(|(rotor, throttle)| rotor.thrust.at(throttle).max(f64::MIN_POSITIVE));
        let in_stream = |alone: f64, share: f64, other: f64| {
            alone * (1.0 + b - b * (1.0 + (share * other.max(0.0) / alone).max(0.0)).sqrt())
        };
        let mut upper_n = upper_alone;
        let mut lower_n = lower_alone;
        for _ in 0..STEPS {
            lower_n = in_stream(lower_alone, m0 - m1 * h, upper_n);
            upper_n = in_stream(upper_alone, n * h, lower_n);
        }
        let ratio = (upper_n.max(0.0) / lower_alone).sqrt().min(LARGEST_RATIO);
        let cube = ratio * ratio * ratio;
        let lower_nm = lower.torque.at(l) * (1.0 - loss * cube / (1.0 + limit * cube));
        [upper_n + lower_n, lower_nm - upper.torque.at(u)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotor::curve::Curve;

    fn rotor() -> Rotor {
        Rotor {
            thrust: Curve([2.0, 9.0, 1.0]),
            torque: Curve([0.03, 0.13, 0.02]),
        }
    }

    /// Published pairs give 0.77 to 0.82 of two isolated rotors at equal commands, the lower rotor
    /// 0.54 to 0.68 of one alone.
    #[test]
    fn equal_commands_lose_what_benches_lose() {
        let rotors = [rotor(), rotor()];
        for spacing in [0.1, 0.25, 0.5, 1.0] {
            for throttle in [0.3, 0.6, 1.0] {
                let [thrust, torque] = OPEN_LOOP.pair(&rotors, spacing, [throttle; 2]);
                let share = thrust / (2.0 * rotor().thrust.at(throttle));
                assert!((0.77..0.82).contains(&share), "{spacing} {throttle}: {share}");
                assert!(torque < 0.0, "the lower rotor is unloaded");
            }
        }
    }

    #[test]
    fn a_resting_rotor_leaves_the_other_alone() {
        let rotors = [rotor(), rotor()];
        let alone = rotor().thrust.at(0.8);
        for throttles in [[0.8, 1e-6], [1e-6, 0.8]] {
            let [thrust, _] = OPEN_LOOP.pair(&rotors, 0.25, throttles);
            assert!(
                (thrust / alone - 1.0).abs() < 0.02,
                "{throttles:?}: {thrust} {alone}"
            );
        }
    }

    /// The fixed point solves both equations.
    #[test]
    fn more_steps_change_nothing() {
        let rotors = [rotor(), rotor()];
        let Interaction {
            constants: [b, m0, m1, n, ..],
        } = OPEN_LOOP;
        let h = 1.0 - 0.5 / (1.25_f64).sqrt();
        for (u, l) in [(0.2, 1.0), (1.0, 0.2), (0.7, 0.7), (1.0, 1.0)] {
            let (t0u, t0l) = (rotor().thrust.at(u), rotor().thrust.at(l));
            let (mut tu, mut tl) = (t0u, t0l);
            for _ in 0..200 {
                tl = t0l * (1.0 + b - b * (1.0 + (m0 - m1 * h) * tu.max(0.0) / t0l).sqrt());
                tu = t0u * (1.0 + b - b * (1.0 + n * h * tl.max(0.0) / t0u).sqrt());
            }
            let [thrust, _] = OPEN_LOOP.pair(&rotors, 0.25, [u, l]);
            assert!((thrust - tu - tl).abs() < 1e-7 * thrust, "({u}, {l})");
        }
    }
}
