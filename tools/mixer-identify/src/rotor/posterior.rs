//! The interaction's constants, and scales of the rotors alone, from rows of a pair on a bench:
//! maximum a posteriori.
//!
//! Unknown are the relative changes of the six constants, common to all cases, and of the
//! thrust and of each torque of a case's rotors alone, which drift from day to day and from motor to motor. With
//! independent normal errors of rows and unknowns the best of them minimise
//!
//! ```text
//! sum (change / its deviation)^2 + sum ((row - model) / its deviation)^2
//! ```
//!
//! by Gauss and Newton with a damping after Levenberg.

use crate::fit::basis::ThrottleBox;
use crate::fit::normal::solve;
use crate::rotor::curve::Rotor;
use crate::rotor::interaction::Interaction;
use crate::statistics::dot;

/// One pair: rotors alone, spacing, and rows of the pair `[u, l, thrust, torque]`; NaN for a torque
/// that was not measured.
#[derive(Debug, Clone)]
pub struct Case {
    /// The upper and the lower rotor alone.
    pub rotors: [Rotor; 2],
    /// z/D.
    pub spacing_ratio: f64,
    /// u, l, thrust (N), torque (N m).
    pub rows: Vec<[f64; 4]>,
    /// The greatest thrust and torque of the pair: what per cents are of.
    pub full_scale: [f64; 2],
    /// Standard deviation of a row about the model, a share of full scale.
    pub row: [f64; 2],
}

/// Relative standard deviations before any row is seen.
#[derive(Debug, Clone, Copy)]
pub struct Deviations {
    /// Of B, m0, m1, n, a, b.
    pub constants: [f64; 6],
    /// Of the thrust of both rotors alone, of the torque of the upper and of the lower one.
    pub scales: [f64; 3],
    /// Of what two rotors give together at equal commands, as a share of both alone.
    pub equal: f64,
}

/// How constants differ between systems, and the same rotor between days (docs/no-bench.md).
pub const BETWEEN_SYSTEMS: Deviations = Deviations {
    constants: [0.2, 0.2, 0.3, 0.3, 0.4, 0.4],
    scales: [0.03, 0.06, 0.06],
    equal: 0.03,
};

/// Standard deviation of a row about the model with its own best constants, a share of full scale:
/// noise of the bench and what six constants leave of a map's shape.
pub const ROW: [f64; 2] = [0.01, 0.025];
/// Numbers that rows of a case have beside their own in common: the scales of thrust and of either
/// torque, and what is left at equal commands.
const SHARED: usize = 4;
const STEPS: usize = 30;
const DIFFERENCE: f64 = 1e-6;

/// The best constants, and how well they are known.
#[derive(Debug, Clone)]
pub struct Posterior {
    /// The constants of the interaction with the greatest posterior density.
    pub interaction: Interaction,
    /// For each case, in the order given, the factors `[thrust, upper torque, lower torque]` by which its
    /// rotors differ from their runs alone; 1 where they do not.
    pub factors: Vec<[f64; 3]>,
    /// The least sum of squared residuals, each over its standard deviation.
    pub chi_squared: f64,
    /// The same over the number of residuals and priors: about 1 where the standard deviations are true.
    pub misfit: f64,
    /// Rows of the linear problem at the minimum, and the deviations of its unknowns.
    rows: Vec<Vec<f64>>,
    deviations: Vec<f64>,
    start: Interaction,
    x: Vec<f64>,
}

fn model(start: Interaction, x: &[f64]) -> (Interaction, Vec<[f64; 3]>) {
    let mut constants = start.constants;
    for (constant, change) in constants.iter_mut().zip(x) {
        *constant *= 1.0 + change;
    }
    let factors = x[6..].chunks(3).map(|own| [0, 1, 2].map(|k| 1.0 + own[k]));
    (Interaction { constants }, factors.collect())
}

/// Differences by each unknown, by rows.
fn differences(x: &[f64], here: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    let moved = (0..x.len()).map(|k| {
        let mut beside = x.to_vec();
        beside[k] += DIFFERENCE;
        of(&beside)
    });
    let moved: Vec<Vec<f64>> = moved.collect();
    (0..here.len())
        .map(|i| moved.iter().map(|m| (m[i] - here[i]) / DIFFERENCE).collect())
        .collect()
}

/// The best constants and factors.
pub fn fit(start: Interaction, before: Deviations, cases: &[Case]) -> Posterior {
    let unknowns = 6 + 3 * cases.len();
    let deviations: Vec<f64> = (0..unknowns)
        .map(|k| match k {
            0..6 => before.constants[k],
            _ => before.scales[k % 3],
        })
        .collect();
    let residuals = |x: &[f64]| -> Vec<f64> {
        let (interaction, factors) = model(start, x);
        let mut all: Vec<f64> = (0..unknowns).map(|k| x[k] / deviations[k]).collect();
        for (case, factors) in cases.iter().zip(&factors) {
            let [now, then] =
                [interaction, start].map(|i| i.pair(&case.rotors, case.spacing_ratio, [1.0; 2])[0]);
            all.push((now / then - 1.0) / before.equal);
            let rotors = scaled(&case.rotors, *factors);
            for &[u, l, thrust, torque] in &case.rows {
                let model = interaction.pair(&rotors, case.spacing_ratio, [u, l]);
                for k in 0..2 {
                    let missed = ([thrust, torque][k] - model[k]) / (case.row[k] * case.full_scale[k]);
                    all.push(if missed.is_nan() { 0.0 } else { missed });
                }
            }
        }
        all
    };
    let squares = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>();
    let mut x = vec![0.0; unknowns];
    let mut here = residuals(&x);
    let mut damping: f64 = 1e-3;
    for _ in 0..STEPS {
        let mut rows = differences(&x, &here, residuals);
        let mut wanted: Vec<f64> = here.iter().map(|r| -r).collect();
        // Damped in units of the deviations.
        for k in 0..unknowns {
            let mut row = vec![0.0; unknowns];
            row[k] = damping.sqrt() / deviations[k];
            rows.push(row);
            wanted.push(0.0);
        }
        let Some(step) = solve(&rows, &wanted) else { break };
        let next: Vec<f64> = x.iter().zip(&step).map(|(x, d)| (x + d).max(-0.9)).collect();
        let there = residuals(&next);
        if squares(&there) < squares(&here) {
            let gain = 1.0 - squares(&there) / squares(&here);
            (x, here) = (next, there);
            damping *= 0.2;
            if gain < 1e-10 {
                break;
            }
        } else {
            damping *= 10.0;
        }
    }
    let (interaction, factors) = model(start, &x);
    let rows = cases.iter().flat_map(|case| &case.rows);
    let numbers = rows.flat_map(|row| &row[2..]).filter(|x| x.is_finite()).count();
    let chi_squared = squares(&here);
    Posterior {
        interaction,
        factors,
        chi_squared,
        misfit: chi_squared / (numbers + SHARED * cases.len()) as f64,
        rows: differences(&x, &here, residuals),
        deviations,
        start,
        x,
    }
}

impl Posterior {
    /// Standard deviation of thrust (N) and torque (N m) of the first case's pair, over a box of
    /// throttles: the sum of g' H^-1 g, g the gradient by the unknowns and H the matrix of the least
    /// squares, under a root.
    pub fn spread(&self, case: &Case, throttle: ThrottleBox) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for throttles in throttle.square(5) {
            let of = |x: &[f64]| {
                let (interaction, factors) = model(self.start, x);
                let rotors = scaled(&case.rotors, factors[0]);
                interaction.pair(&rotors, case.spacing_ratio, throttles).to_vec()
            };
            for (square, g) in squares.iter_mut().zip(differences(&self.x, &of(&self.x), of)) {
                // The first rows are the unknowns over their deviations, so that A' y is g.
                let mut y = vec![0.0; self.rows.len()];
                for (y, (g, deviation)) in y.iter_mut().zip(g.iter().zip(&self.deviations)) {
                    *y = g * deviation;
                }
                *square += solve(&self.rows, &y).map_or(f64::INFINITY, |x| dot(&x, &g));
            }
        }
        squares.map(f64::sqrt)
    }
}

/// Rotors whose thrust and torque alone are multiplied.
pub fn scaled(rotors: &[Rotor; 2], [thrust, upper, lower]: [f64; 3]) -> [Rotor; 2] {
    let [a, b] = rotors;
    [(a, upper), (b, lower)].map(|(rotor, torque)| Rotor {
        thrust: rotor.thrust.times(thrust),
        torque: rotor.torque.times(torque),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotor::curve::Curve;
    use crate::rotor::interaction::OPEN_LOOP;

    /// Rows of other constants and scales are found again, from thrust and torque as from thrust
    /// alone.
    #[test]
    fn rows_move_the_model_towards_them() {
        let rotor = Rotor {
            thrust: Curve([2.0, 9.0, 1.0]),
            torque: Curve([0.03, 0.13, 0.02]),
        };
        let mut truth = OPEN_LOOP;
        truth.constants[0] *= 1.15;
        truth.constants[4] *= 0.7;
        let rotors = scaled(&[rotor; 2], [1.04, 0.95, 0.95]);
        let at = |[u, l]: [f64; 2]| truth.pair(&rotors, 0.25, [u, l]);
        let full_scale = at([1.0, 1.0]).map(f64::abs);
        let full_scale = [full_scale[0], 0.15];
        let grid = || (0..25).map(|k| [0.2 + 0.2 * f64::from(k / 5), 0.2 + 0.2 * f64::from(k % 5)]);
        let worst = |interaction: Interaction, factors: [f64; 3], k: usize| {
            let rotors = scaled(&[rotor; 2], factors);
            let missed = grid().map(|t| (interaction.pair(&rotors, 0.25, t)[k] - at(t)[k]).abs());
            missed.fold(0.0, f64::max) / full_scale[k]
        };
        for with_torque in [true, false] {
            let rows = [[0.6, 0.6], [0.95, 0.4], [0.4, 0.95], [0.95, 0.95]].map(|[u, l]| {
                let [f, q] = at([u, l]);
                [u, l, f, if with_torque { q } else { f64::NAN }]
            });
            let case = Case {
                rotors: [rotor; 2],
                spacing_ratio: 0.25,
                rows: rows.to_vec(),
                full_scale,
                row: ROW,
            };
            let Posterior {
                interaction: found,
                factors,
                ..
            } = fit(OPEN_LOOP, BETWEEN_SYSTEMS, &[case]);
            let (before, after) = (worst(OPEN_LOOP, [1.0; 3], 0), worst(found, factors[0], 0));
            assert!(after < 0.5 * before, "{before} {after}");
            if with_torque {
                let (before, after) = (worst(OPEN_LOOP, [1.0; 3], 1), worst(found, factors[0], 1));
                assert!(after < 0.5 * before, "{before} {after}");
            } else {
                assert_eq!(factors[0][1], 1.0, "nothing was said of torque");
            }
        }
    }
}
