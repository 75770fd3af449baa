//! A rotor on a motor and its speed controller: how its speed follows throttle, voltage and air.
//!
//! Of the voltage d V that a controller applies (d throttle, V supply) the back-EMF K w (w speed)
//! leaves R I for the resistance of windings and controller. The current I turns the rotor, of inertia J,
//! against the torque Q of the propeller and that of the no-load current I0:
//!
//! ```text
//! d V = K w + R I,   J dw/dt = K (I - I0) - Q,   Q ~ rho w^2
//! ```
//!
//! With x = V / Vref, sigma = rho / rho_ref, speed and current over those of a rotor at full
//! throttle at the reference, s its ohmic share R I / V, i0 its no-load current and Qf the torque of its propeller:
//!
//! ```text
//! t dw/dt = d x - D(w),   D(w) = (1 - s) w + s ((1 - i0) sigma w^2 + i0),   t = s (1 - i0) J W / Qf
//! ```
//!
//! A rotor in steady state at the reference turns so that D(w) = d. About there the speed follows a small step with the
//! lag tau = t / D'(w). The motor's torque, whose reaction is on the frame, begins with r times the change that it ends with:
//!
//! ```text
//! r = 1 + (1 - s) / (2 s (1 - i0) sigma w) = (1 + s_w) / (2 s_w),   T = r tau = J w / (2 Q)
//! ```
//!
//! with s_w the ohmic share at w of the voltage beyond R I0, which is 2 / k - 1 where thrust follows the voltage by the
//! power k. So lag and inertia are one number.
//!
//! The map of the pair is that of the bench, at x = sigma = 1, over the throttles. Its rotors have the speeds of the
//! steady state there. Elsewhere they turn faster by L than they would at these throttles there, L the root of their squares' sum
//! over that at the reference. Efforts grow by sigma L^2; the interaction is a function of the speeds' ratio, so they
//! are those of the map where the rotors would turn at w / L. With i0 = 0 it follows, for any map,
//!
//! ```text
//! f(u, l; V, sigma rho) = f(u, l; sigma V, rho) / sigma,   Q likewise.
//! ```
//!
//! Assumptions: the throttle is the duty; a rotor's load is its own, whatever the other does;
//! coefficients know no Reynolds or Mach number; K, R and I0 know no temperature. The controller brakes as it
//! drives, by the difference of the voltages (complementary PWM, "damped light"), which is the default of `BLHeli` and AM32;
//! with `[vehicle] rotor_brakes = false` a rotor slows down by its propeller alone: I is not below 0. No controller limits
//! current or slew.

use mixer_compiler::airframe::TYPICAL_EXPONENT;
use mixer_compiler::flywheel;

/// No-load current over that of full throttle, usual for motors of multirotors.
pub const NO_LOAD: f64 = 0.03;

/// Speed below which the torque of the no-load current falls to zero, so that a rotor at rest stays there.
const SLOW: f64 = 0.02;

/// Least x: a battery that its load pulls down further turns nothing any more.
const LEAST_SUPPLY: f64 = 0.01;

/// A motor with its rotor, alike for all, and where it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Ohmic share of the voltage at full throttle at the reference, s.
    ohmic: f64,
    /// No-load current over that of full throttle there, i0.
    no_load: f64,
    /// Voltage of the bench, V; `None` where the supply is of no account.
    reference_v: Option<f64>,
    /// Power of the voltage that thrust follows.
    exponent: f64,
    /// Density of the air over that of the bench.
    sigma: f64,
    /// t, s.
    time_s: f64,
    /// Whether the controller brakes.
    brakes: bool,
}

impl Motor {
    /// A motor at the reference whose thrust follows V^`exponent`, and whose rotor follows at once.
    ///
    /// An exponent below 1 or above 2 is that of a controller that holds a speed or a current, or measured wrong: the motor is a
    /// usual one, on a supply that follows the voltage by so much more or less.
    pub fn new(exponent: f64, no_load: f64, reference_v: Option<f64>) -> Motor {
        Motor {
            // Where D - s i0 is a throttle d, s_w / (1 - s_w)^2 = d (1 - i0) s / (1 - s)^2.
            ohmic: flywheel::ohmic_share(exponent, 1.0 / (1.0 - no_load)),
            no_load,
            reference_v,
            exponent,
            sigma: 1.0,
            time_s: 0.0,
            brakes: true,
        }
    }

    /// The same motor in air of `sigma` times the bench's density.
    ///
    /// # Errors
    /// An exponent that is not a motor's.
    pub fn in_air(self, sigma: f64) -> Result<Motor, String> {
        if flywheel::is_of_motors(self.exponent) {
            return Ok(Motor { sigma, ..self });
        }
        let exponent = self.exponent;
        Err(format!(
            "thrust follows the voltage by the power {exponent:.2}: motors have 1 to 2"
        ))
    }

    /// The same motor with a lag about a speed at the reference, s.
    #[must_use]
    pub fn with_lag(self, lag_s: f64, speed: f64) -> Self {
        let slope = 1.0 - self.ohmic + 2.0 * self.ohmic * (1.0 - self.no_load) * speed;
        Motor {
            time_s: lag_s * slope,
            ..self
        }
    }

    /// The same motor on a controller that brakes, or does not: then no current flows back, and the rotor is slowed down by its
    /// load alone.
    #[must_use]
    pub fn braking(self, brakes: bool) -> Self {
        Motor { brakes, ..self }
    }

    /// Speed over that of full throttle, steady at a throttle at the reference.
    pub fn speed_at_reference(&self, throttle: f64) -> f64 {
        self.speed_of(throttle, 1.0)
    }

    /// Speed over that of full throttle at the reference, steady at a throttle and a voltage, V.
    pub fn speed(&self, throttle: f64, volts: f64) -> f64 {
        self.speed_of(throttle * self.supply_of(volts), self.sigma)
    }

    /// Change of the speed, 1/s.
    pub fn acceleration(&self, speed: f64, throttle: f64, volts: f64) -> f64 {
        let applied = throttle * self.supply_of(volts);
        let back_emf = if self.brakes {
            0.0
        } else {
            (1.0 - self.ohmic) * speed
        };
        (applied.max(back_emf) - self.drive(speed, self.sigma)) / self.time_s
    }

    /// At the speeds of a pair's rotors and a voltage: what efforts of the map are multiplied by,
    /// and the throttles at which the map gives them.
    pub fn at_reference(&self, speeds: [f64; 2], volts: f64) -> (f64, [f64; 2]) {
        let x = self.supply_of(volts);
        let there = speeds.map(|speed| self.speed_of(self.drive(speed, self.sigma) / x, 1.0));
        let [was, is] = [there, speeds].map(|[u, l]| u * u + l * l);
        if was == 0.0 {
            return (0.0, [0.0; 2]);
        }
        let faster = (is / was).sqrt();
        let throttles = speeds.map(|speed| self.drive(speed / faster, 1.0));
        (self.sigma * is / was, throttles)
    }

    /// x at a voltage, V.
    fn supply_of(&self, volts: f64) -> f64 {
        let over = self.reference_v.map_or(1.0, |reference_v| volts / reference_v);
        let over = over.max(LEAST_SUPPLY);
        if flywheel::is_of_motors(self.exponent) {
            over
        } else {
            libm::pow(over, self.exponent / TYPICAL_EXPONENT)
        }
    }

    /// D(w) in air of sigma.
    fn drive(&self, speed: f64, sigma: f64) -> f64 {
        let current = (1.0 - self.no_load) * sigma * speed * speed + self.no_load * (speed / SLOW).min(1.0);
        (1.0 - self.ohmic) * speed + self.ohmic * current
    }

    /// The speed of a D.
    fn speed_of(&self, drive: f64, sigma: f64) -> f64 {
        let no_load = self.ohmic * self.no_load;
        let [mut linear, mut drives] = [1.0 - self.ohmic, drive - no_load];
        if drive < self.drive(SLOW, sigma) {
            [linear, drives] = [linear + no_load / SLOW, drive.max(0.0)];
        }
        let square = self.ohmic * (1.0 - self.no_load) * sigma;
        2.0 * drives / (linear + (linear * linear + 4.0 * square * drives).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use mixer_compiler::airframe::Kind;

    use super::*;
    use crate::pair::Pair;

    fn pairs() -> Vec<Pair> {
        let files = ["isae-x8", "x8-16in-quartic", "x8-22in-cubic"];
        let read = |name: &&str| {
            let path = format!("{}/../../airframes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(&path).unwrap();
            let airframe =
                mixer_compiler::airframe::Airframe::read(&mixer_compiler::Source::new(path, text)).unwrap();
            Pair::new(Kind::Pair(&airframe.pairs[0]), &airframe.throttle)
        };
        files.iter().map(read).collect()
    }

    fn given(pair: &Pair, motor: &Motor, throttles: [f64; 2], x: f64, sigma: f64) -> [f64; 2] {
        let (motor, volts) = (motor.in_air(sigma).unwrap(), x * 15.0);
        let speeds = throttles.map(|throttle| motor.speed(throttle, volts));
        let (factor, throttles) = motor.at_reference(speeds, volts);
        pair.efforts(throttles).map(|effort| factor * effort)
    }

    /// Largest difference between both sides of the similarity, f and Q over full scale.
    fn difference(pair: &Pair, motor: &Motor) -> [f64; 2] {
        let throttles = (0..81).map(|k| [k / 9, k % 9].map(|k| 0.2 + 0.1 * f64::from(k)));
        let mut worst = [0.0f64; 2];
        for (x, sigma) in [0.75, 1.0, 1.1]
            .map(|x| [0.7, 0.85, 1.15].map(|sigma| (x, sigma)))
            .concat()
        {
            let both: Vec<_> = throttles
                .clone()
                .map(|at| {
                    let thin = given(pair, motor, at, x, sigma);
                    let low = given(pair, motor, at, sigma * x, 1.0);
                    [0, 1].map(|k| [thin[k], low[k] / sigma])
                })
                .collect();
            for (k, worst) in worst.iter_mut().enumerate() {
                let scale = both.iter().fold(0.0f64, |most, row| most.max(row[k][0].abs()));
                let largest = both
                    .iter()
                    .fold(0.0f64, |most, row| most.max((row[k][0] - row[k][1]).abs()));
                *worst = worst.max(largest / scale);
            }
        }
        worst
    }

    #[test]
    fn thin_air_acts_like_a_lower_voltage() {
        for pair in pairs() {
            for exponent in [1.0, 1.6, 1.75, 2.0] {
                let motor = |no_load| Motor::new(exponent, no_load, Some(15.0));
                let [f, q] = difference(&pair, &motor(0.0));
                assert!(f < 1e-14 && q < 1e-13, "{exponent}: {f} {q}");
            }
            // As ten measured systems have it: 0.64 % with a no-load current of 3 %, 1.30 % with 6 %.
            for (no_load, percent) in [(0.03, 0.64), (0.06, 1.30)] {
                let motor = Motor::new(1.785, no_load, Some(15.0));
                let [f, q] = difference(&pair, &motor).map(|share| 100.0 * share / percent);
                assert!(
                    (0.7..1.3).contains(&f) && (0.5..2.5).contains(&q),
                    "{no_load}: {f} {q}"
                );
            }
        }
    }

    #[test]
    fn at_the_reference_it_is_the_map() {
        for (reference_v, volts) in [(Some(14.8), 14.8), (None, 3.0)] {
            for exponent in [0.0, 1.0, 1.75, 2.0, 2.5] {
                let motor = Motor::new(exponent, NO_LOAD, reference_v);
                for throttles in [[0.1, 0.1], [0.3, 0.8], [0.0, 1.0], [1.0, 0.001], [0.0, 0.0]] {
                    let (factor, found) = motor.at_reference(throttles.map(|d| motor.speed(d, volts)), volts);
                    assert!(
                        throttles == [0.0, 0.0] || (factor - 1.0).abs() < 1e-14,
                        "{factor}"
                    );
                    assert!(
                        found.iter().zip(throttles).all(|(a, b)| (a - b).abs() < 1e-14),
                        "{found:?}"
                    );
                }
            }
        }
    }

    /// A rotor that is followed through a small step of the throttle.
    #[test]
    fn a_step_is_followed_with_the_lag() {
        for (exponent, throttle) in [(1.6, 0.8), (1.75, 0.8), (1.9, 0.8), (1.75, 0.45)] {
            let (lag_s, step, dt_s) = (0.06, 1e-4, 1e-5);
            let motor = Motor::new(exponent, NO_LOAD, None);
            let speed = motor.speed_at_reference(throttle);
            let (motor, mut now) = (motor.with_lag(lag_s, speed), speed);
            for _ in 0..(lag_s / dt_s) as usize {
                now += dt_s * motor.acceleration(now, throttle + step, 0.0);
            }
            let followed = (now - speed) / (motor.speed_at_reference(throttle + step) - speed);
            assert!(
                (followed - (1.0 - libm::exp(-1.0))).abs() < 1e-3,
                "{exponent}: {followed}"
            );
        }
    }

    #[test]
    fn a_bench_of_two_voltages_finds_the_exponent() {
        let grid = (0..81).map(|k| [k / 9, k % 9].map(|k| 0.2 + 0.1 * f64::from(k)));
        for pair in pairs() {
            for exponent in [1.65, 1.75, 1.85] {
                let motor = Motor::new(exponent, 0.0, Some(15.0));
                let thrust = |x: f64| -> Vec<f64> {
                    grid.clone()
                        .map(|at| given(&pair, &motor, at, x, 1.0)[0])
                        .collect()
                };
                let (full, low) = (thrust(1.0), thrust(0.85));
                let products: f64 = full.iter().zip(&low).map(|(a, b)| a * b).sum();
                let squares: f64 = full.iter().map(|a| a * a).sum();
                let found = libm::log(products / squares) / libm::log(0.85);
                assert!((found - exponent).abs() < 0.015, "{exponent}: {found}");
            }
        }
    }

    #[test]
    fn controllers_that_hold_a_speed_follow_the_voltage_as_the_file_has_it() {
        let pair = &pairs()[0];
        for (exponent, low, high) in [(0.0, 0.0, 0.0), (0.5, 0.45, 0.55), (2.5, 2.3, 2.7)] {
            let motor = Motor::new(exponent, NO_LOAD, Some(15.0));
            let [less, more] = [0.85, 1.15].map(|x| {
                let speeds = [0.6, 0.5].map(|throttle| motor.speed(throttle, 15.0 * x));
                let (factor, throttles) = motor.at_reference(speeds, 15.0 * x);
                factor * pair.efforts(throttles)[0]
            });
            let found = libm::log(more / less) / libm::log(1.15 / 0.85);
            assert!((low - 1e-9..=high + 1e-9).contains(&found), "{exponent}: {found}");
            // Nobody knows what they do in thin air.
            assert!(motor.in_air(0.9).is_err());
        }
    }
}
