//! Rotor mismatch and the air of the room, drawn per seed; equal for both mixers.
//!
//! *Still* air does nothing: what is left are the mixer's own errors. *Unsteady* air stands for
//! what the paper calls the aerodynamic effects of a rather small flying area: a horizontal and
//! vertical force, and flutter of each unit's thrust, each a first-order Gauss-Markov process,
//!
//! ```text
//! x[k+1] = a x[k] + sqrt(1 - a^2) sigma n[k],   a = exp(-step / T)
//! ```
//!
//! Its size is a round figure that was set beforehand, not identified: the paper measures no
//! disturbance.

use nalgebra::SVector;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

use crate::plant::Disturbance;
use crate::vehicle::{ROTORS, UNITS, WEIGHT_N};

/// Standard deviation of a rotor's effective throttle about the commanded one.
const MISMATCH: f64 = 0.01;

/// Standard deviation of the force in unsteady air per axis, N: 1 % of the weight.
const FORCE_N: f64 = 0.01 * WEIGHT_N;

/// Standard deviation of a unit's thrust in unsteady air, relative.
const FLUTTER: f64 = 0.02;

/// Correlation time of unsteady air, s.
const CORRELATION_S: f64 = 1.0;

/// The air around the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Air {
    /// No disturbance.
    Still,
    /// Gauss-Markov force and flutter.
    Unsteady,
}

/// What differs between flights of different seeds.
#[derive(Clone, Debug)]
pub struct Room {
    air: Air,
    source: Pcg64Mcg,
    /// Relative deviation of each rotor's effective throttle, 1 % standard deviation.
    pub mismatch: SVector<f64, ROTORS>,
    disturbance: Disturbance<ROTORS>,
}

impl Room {
    /// Mismatch and air of a seed; equal seeds give equal sequences on every machine.
    pub fn new(air: Air, seed: u64) -> Self {
        let mut source = Pcg64Mcg::seed_from_u64(seed);
        let mismatch = SVector::from_fn(|_, _| MISMATCH * normal(&mut source));
        Room {
            air,
            source,
            mismatch,
            disturbance: Disturbance::default(),
        }
    }

    /// The disturbance over the next `step` seconds.
    pub fn next(&mut self, step: f64) -> Disturbance<ROTORS> {
        if self.air == Air::Unsteady {
            let (steps, source) = (step / CORRELATION_S, &mut self.source);
            let Disturbance { force_n, flutter } = &mut self.disturbance;
            force_n.apply(|force| *force = gauss_markov(*force, FORCE_N, steps, source));
            flutter
                .fixed_rows_mut::<UNITS>(0)
                .apply(|unit| *unit = gauss_markov(*unit, FLUTTER, steps, source));
        }
        self.disturbance
    }
}

/// The next value of a Gauss-Markov process of a standard deviation, `steps` correlation times later.
pub fn gauss_markov(last: f64, size: f64, steps: f64, source: &mut Pcg64Mcg) -> f64 {
    let kept = libm::exp(-steps);
    last * kept + size * normal(source) * (1.0 - kept * kept).sqrt()
}

/// A number of the standard normal distribution.
pub fn normal(source: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(source)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsteady_air_has_the_stated_size_and_memory() {
        let mut room = Room::new(Air::Unsteady, 1);
        let step = 0.005;
        let forces: Vec<f64> = (0..400_000).map(|_| room.next(step).force_n.x).collect();
        let mean_square = forces.iter().map(|f| f * f).sum::<f64>() / forces.len() as f64;
        // 2000 s hold 1000 independent samples: the deviation is known to 3 %.
        let size = mean_square.sqrt() / FORCE_N;
        assert!((0.9..1.1).contains(&size), "{size}");
        let after_a_second: f64 = forces.iter().zip(&forces[200..]).map(|(a, b)| a * b).sum();
        let correlation = after_a_second / forces.len() as f64 / mean_square;
        assert!((correlation - libm::exp(-1.0)).abs() < 0.1, "{correlation}");
    }

    #[test]
    fn still_air_is_still() {
        let mut room = Room::new(Air::Still, 1);
        assert_eq!(room.next(0.005), Disturbance::default());
    }
}
