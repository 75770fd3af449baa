//! The pair's map, eq. (1), once more: the plant reads the coefficients from the file and shares no
//! arithmetic with the compiler, whose f64 map the tables were fitted to.
//!
//! Below idle, where the map does not hold, efforts are those at idle, those of one rotor alone and
//! zero, weighted bilinearly by the shares of idle at which both rotors turn. So a rotor that spins
//! up or stops gives continuous efforts, and one at rest leaves the other what the file says of it.

use mixer_compiler::airframe::{Kind, RotorAlone, Throttle};

/// Powers from 0 to the highest of any basis.
const POWERS: usize = 5;

/// Thrust and torque of one pair at the reference voltage.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Powers of the upper and of the lower throttle, coefficients of thrust (N) and torque (N m).
    terms: Vec<([usize; 2], [f64; 2])>,
    /// The upper and the lower rotor alone, where the file has them.
    alone: [Option<RotorAlone>; 2],
    idle: f64,
}

impl Pair {
    /// The map of a kind of unit.
    pub fn new(kind: Kind<'_>, throttle: &Throttle) -> Self {
        let (terms, alone) = match kind {
            Kind::Pair(pair) => {
                let coefficients = pair.thrust_n.iter().zip(&pair.torque_nm);
                let terms = pair.basis.exponents().iter().zip(coefficients);
                let terms = terms.map(|(&(u, l), (&f, &q))| ([u.into(), l.into()], [f, q]));
                (terms.collect(), [pair.lower_out.clone(), pair.upper_out.clone()])
            }
            // A pair whose lower rotor never turns.
            Kind::SingleRotor(rotor) => {
                let terms = rotor.alone.thrust_n.iter().zip(&rotor.alone.torque_nm);
                let terms = (1..).zip(terms).map(|(power, (&f, &q))| ([power, 0], [f, q]));
                (terms.collect(), [Some(rotor.alone.clone()), None])
            }
        };
        Pair {
            terms,
            alone,
            idle: throttle.min,
        }
    }

    /// `[f, Q]`, N and N m, at the effective throttles `[upper, lower]`, from rest on.
    pub fn efforts(&self, throttles: [f64; 2]) -> [f64; 2] {
        if throttles.iter().all(|d| *d >= self.idle) {
            return self.both(throttles);
        }
        let [u, l] = throttles.map(|d| d.max(self.idle));
        let [share_u, share_l] = throttles
            .map(|d| (d / self.idle).clamp(0.0, 1.0))
            .map(|share| share * share);
        let parts = [
            (share_u * share_l, self.both([u, l])),
            (share_u * (1.0 - share_l), self.alone(0, u)),
            ((1.0 - share_u) * share_l, self.alone(1, l)),
        ];
        parts
            .iter()
            .fold([0.0; 2], |[f, q], (share, [a, b])| [f + share * a, q + share * b])
    }

    /// Efforts of one rotor, 0 being the upper one, the other at rest: of the file, or of the map
    /// there.
    fn alone(&self, rotor: usize, throttle: f64) -> [f64; 2] {
        match &self.alone[rotor] {
            Some(alone) => alone.efforts(throttle),
            None if rotor == 0 => self.both([throttle, 0.0]),
            None => self.both([0.0, throttle]),
        }
    }

    /// The map itself.
    fn both(&self, throttles: [f64; 2]) -> [f64; 2] {
        let [u, l] = throttles.map(|d| {
            let mut powers = [1.0; POWERS];
            for k in 1..POWERS {
                powers[k] = powers[k - 1] * d;
            }
            powers
        });
        self.terms.iter().fold([0.0; 2], |[f, q], ([i, j], [a, b])| {
            let monomial = u[*i] * l[*j];
            [f + a * monomial, q + b * monomial]
        })
    }
}

#[cfg(test)]
mod tests {
    use mixer_compiler::model::PairMap;

    use super::*;

    #[test]
    fn it_is_the_compilers_map() {
        let airframe = crate::vehicle::airframe().unwrap();
        let (pair, map) = (
            Pair::new(Kind::Pair(&airframe.pairs[0]), &airframe.throttle),
            PairMap::new(&airframe.pairs[0], &airframe.throttle),
        );
        for throttles in [[0.1, 0.1], [0.3, 0.8], [1.0, 0.5], [1.0, 1.0]] {
            let (ours, theirs) = (pair.efforts(throttles), map.efforts(throttles));
            assert!((ours[0] - theirs[0]).abs() < 1e-12 && (ours[1] - theirs[1]).abs() < 1e-14);
        }
        // The sum of Table I's coefficients.
        let full = pair.efforts([1.0, 1.0]);
        assert!(
            (full[0] - 24.7877).abs() < 1e-9 && (full[1] + 0.0020).abs() < 1e-9,
            "{full:?}"
        );
    }

    #[test]
    fn below_idle_it_is_continuous_down_to_rest() {
        let airframe = crate::vehicle::airframe().unwrap();
        let pair = Pair::new(Kind::Pair(&airframe.pairs[0]), &airframe.throttle);
        assert_eq!(pair.efforts([0.0, 0.0]), [0.0, 0.0]);
        let [above, below] = [0.1, 0.1 - 1e-9].map(|l| pair.efforts([0.6, l]));
        assert!((above[0] - below[0]).abs() < 1e-6, "{above:?} {below:?}");
        // Without [pair.lower_out] the polynomials at l = 0 stand for the upper rotor alone.
        let [f, q] = pair.efforts([0.6, 0.0]);
        assert!((f - (12.3604 * 0.36 + 2.7640 * 0.6)).abs() < 1e-9, "{f}");
        assert!((q - (-0.1312 * 0.36 - 0.0907 * 0.6)).abs() < 1e-9, "{q}");
    }
}
