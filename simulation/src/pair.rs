//! The pair's map, eq. (1), once more: the plant reads the coefficients from the file and shares no
//! arithmetic with the compiler, whose f64 map the tables were fitted to.

use mixer_compiler::airframe;

/// Powers from 0 to the highest of any basis.
const POWERS: usize = 5;

/// Thrust and torque of one pair at the reference voltage.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Powers of the upper and of the lower throttle, coefficients of thrust (N) and torque (N m).
    terms: Vec<([usize; 2], [f64; 2])>,
}

impl Pair {
    /// The map of the airframe file.
    pub fn new(pair: &airframe::Pair) -> Self {
        let coefficients = pair.thrust_n.iter().zip(&pair.torque_nm);
        let terms = pair.basis.exponents().iter().zip(coefficients);
        Pair {
            terms: terms
                .map(|(&(u, l), (&f, &q))| ([u.into(), l.into()], [f, q]))
                .collect(),
        }
    }

    /// `[f, Q]`, N and N m, at the effective throttles `[upper, lower]`.
    pub fn efforts(&self, throttles: [f64; 2]) -> [f64; 2] {
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
            Pair::new(&airframe.pair),
            PairMap::new(&airframe.pair, &airframe.throttle),
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
}
