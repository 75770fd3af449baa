//! The fit whose map does not fold: least squares under det J > 0 over the box.
//!
//! In orthonormal coordinates, thrust and torque each divided by the standard deviation of its
//! residual, the least squares are |x - x0|2 with x0 the free fit. On each cell of the box divided,
//! det J lies above its Bernstein coefficients c_k, which are bilinear in the thrust's and the
//! torque's coordinates; c_k >= margin on all cells suffices. Sequential quadratic programming:
//! with g_k the gradient of c_k at x, solve
//!
//!   min |x + d - x0|2   subject to   c_k(x) + g_k d >= margin
//!
//! (an interior-point solver, clarabel), step to x + a d with the first a of 1, 1/2, 1/4, .. that
//! lowers the exact penalty |x - x0|2 + rho max_k (margin - c_k)+, and repeat until d is small and
//! the constraints hold.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use mixer_compiler::airframe::Basis;
use serde::Serialize;

use crate::fit::basis::ThrottleBox;
use crate::fit::bernstein::{Cell, coefficients};
use crate::fit::fold::determinant;
use crate::fit::polynomial::Polynomial;
use crate::fit::{Design, Fit};

/// Cells per side.
const CELLS: usize = 8;
/// det J is kept above this part of its mean over the box. A map that is nearly singular along a
/// line is invertible on paper only: with 0.02 no evaluator of the compiler meets its usual
/// tolerance on two of three large bench maps; the step to 0.1 costs two to eight percent more
/// residual.
const MARGIN: f64 = 0.1;
const STEPS: usize = 60;

/// The constrained coordinates of both channels.
pub struct Monotone {
    /// Orthonormal coordinates of thrust.
    pub thrust: Vec<f64>,
    /// Orthonormal coordinates of torque.
    pub torque: Vec<f64>,
}

/// Residuals with and without the constraint that det J > 0.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct MonotoneCost {
    /// Residual rms of thrust without it, N.
    pub free_thrust_rms: f64,
    /// Residual rms of torque without it, N m.
    pub free_torque_rms: f64,
}

/// Finds the monotone fit nearest to the free one; nothing if the programme does not converge.
pub fn constrain(
    design: &Design,
    free: [&Fit; 2],
    coordinates: [Vec<f64>; 2],
    throttle_box: ThrottleBox,
) -> Option<Monotone> {
    let problem = Problem::new(design, free, throttle_box);
    let terms = problem.terms;
    let mut x0 = Vec::with_capacity(2 * terms);
    for (z, sigma) in coordinates.iter().zip(problem.sigma) {
        x0.extend(z.iter().map(|z| z / sigma));
    }
    let margin = MARGIN * problem.mean_det(&x0)?;
    let violation = |values: &[f64]| values.iter().fold(0.0_f64, |m, c| m.max(margin - c));
    let distance = |x: &[f64]| x.iter().zip(&x0).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    let mut x = x0.clone();
    let mut rho = 0.0_f64;
    for _ in 0..STEPS {
        let values = problem.values(&x);
        let (step, weight) = problem.step(&x, &x0, &values, margin)?;
        rho = rho.max(2.0 * weight);
        let merit = |x: &[f64]| distance(x) + rho * violation(&problem.values(x));
        let here = merit(&x);
        let to = |a: f64| -> Vec<f64> { x.iter().zip(&step).map(|(x, d)| x + a * d).collect() };
        let halvings = (0..20).map(|k| 1.0 / f64::from(1u32 << k));
        let next = halvings.map(to).find(|y| merit(y) <= here * (1.0 + 1e-12));
        let size = step.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        let done = size < 1e-6 * (1.0 + distance(&x).sqrt());
        match next {
            Some(next) => x = next,
            None if done => {}
            None => return None,
        }
        if done && violation(&problem.values(&x)) < 0.5 * margin {
            let scaled = |c: usize| {
                x[c * terms..(c + 1) * terms]
                    .iter()
                    .map(|x| x * problem.sigma[c])
                    .collect()
            };
            return Some(Monotone {
                thrust: scaled(0),
                torque: scaled(1),
            });
        }
    }
    None
}

struct Problem {
    basis: Basis,
    terms: usize,
    sigma: [f64; 2],
    /// Each orthonormal coordinate's polynomial.
    modes: Vec<Polynomial>,
    to_monomials: Vec<Vec<f64>>,
    cells: Vec<Cell>,
    throttle_box: ThrottleBox,
}

impl Problem {
    fn new(design: &Design, free: [&Fit; 2], throttle_box: ThrottleBox) -> Self {
        let basis = design.centred.basis;
        let terms = basis.exponents().len();
        let mode = |k: usize| -> Polynomial {
            Polynomial::of(
                basis,
                &design.to_monomials.iter().map(|row| row[k]).collect::<Vec<_>>(),
            )
        };
        let edges: Vec<f64> = throttle_box.grid(CELLS).collect();
        let sides = || edges.windows(2).map(|e| [e[0], e[1]]);
        Self {
            basis,
            terms,
            // Data without noise leave no residual to weigh by: full scale stands in.
            sigma: free.map(|f| f.residual_rms.max(1e-9 * f.full_scale).max(f64::MIN_POSITIVE)),
            modes: (0..terms).map(mode).collect(),
            to_monomials: design.to_monomials.clone(),
            cells: sides().flat_map(|u| sides().map(move |l| [u, l])).collect(),
            throttle_box,
        }
    }

    fn polynomial(&self, x: &[f64], channel: usize) -> Polynomial {
        let z = &x[channel * self.terms..(channel + 1) * self.terms];
        let value = |row: &Vec<f64>| row.iter().zip(z).map(|(c, z)| c * z * self.sigma[channel]).sum();
        Polynomial::of(
            self.basis,
            &self.to_monomials.iter().map(value).collect::<Vec<f64>>(),
        )
    }

    fn mean_det(&self, x: &[f64]) -> Option<f64> {
        let det = determinant(self.basis, &self.polynomial(x, 0), &self.polynomial(x, 1));
        let grid = self.throttle_box.grid(20);
        let values = grid
            .clone()
            .flat_map(|u| grid.clone().map(move |l| (u, l)))
            .map(|(u, l)| det.at(u, l));
        let mean = values.sum::<f64>() / 441.0;
        (mean > 0.0).then_some(mean)
    }

    fn on_cells(&self, p: &Polynomial) -> Vec<f64> {
        self.cells
            .iter()
            .flat_map(|&cell| coefficients(p, cell).into_iter().flatten())
            .collect()
    }

    /// c_k at x.
    fn values(&self, x: &[f64]) -> Vec<f64> {
        self.on_cells(&determinant(
            self.basis,
            &self.polynomial(x, 0),
            &self.polynomial(x, 1),
        ))
    }

    /// The step d and the sum of the multipliers.
    fn step(&self, x: &[f64], x0: &[f64], values: &[f64], margin: f64) -> Option<(Vec<f64>, f64)> {
        let (thrust, torque) = (self.polynomial(x, 0), self.polynomial(x, 1));
        let by_thrust = |m: &Polynomial| (determinant(self.basis, m, &torque), self.sigma[0]);
        let by_torque = |m: &Polynomial| (determinant(self.basis, &thrust, m), self.sigma[1]);
        let gradients = self
            .modes
            .iter()
            .map(by_thrust)
            .chain(self.modes.iter().map(by_torque));
        let columns: Vec<Vec<f64>> = gradients
            .map(|(p, s)| self.on_cells(&p).into_iter().map(|c| c * s).collect())
            .collect();
        // Far from their bound constraints cannot bind within a step; leaving them out keeps the
        // programme small.
        let near = 6.0 * margin - values.iter().fold(0.0_f64, |m, c| m.min(*c));
        let active: Vec<usize> = (0..values.len()).filter(|&k| values[k] < near).collect();
        let n = columns.len();
        if active.is_empty() {
            return Some((x0.iter().zip(x).map(|(a, b)| a - b).collect(), 0.0));
        }
        // clarabel: min 1/2 d'P d + q'd, A d + s = b, s >= 0. Rows divided by the margin for a
        // scale near one.
        let m = active.len();
        let identity = CscMatrix::new(n, n, (0..=n).collect(), (0..n).collect(), vec![2.0; n]);
        let q: Vec<f64> = x.iter().zip(x0).map(|(a, b)| 2.0 * (a - b)).collect();
        let entries = columns
            .iter()
            .flat_map(|c| active.iter().map(|&k| -c[k] / margin))
            .collect();
        let rows = (0..n).flat_map(|_| 0..m).collect();
        let a = CscMatrix::new(m, n, (0..=n).map(|j| j * m).collect(), rows, entries);
        let b: Vec<f64> = active.iter().map(|&k| (values[k] - margin) / margin).collect();
        let settings = DefaultSettings {
            verbose: false,
            ..DefaultSettings::default()
        };
        let cones = [SupportedConeT::NonnegativeConeT(m)];
        let mut solver = DefaultSolver::new(&identity, &q, &a, &b, &cones, settings).ok()?;
        solver.solve();
        let solution = solver.solution;
        let solved = matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
        solved.then(|| (solution.x, solution.z.iter().sum::<f64>() / margin))
    }
}

#[cfg(test)]
mod tests {
    use mixer_compiler::model::injectivity::EnclosedPairMap;

    use super::*;
    use crate::fit::{fit, judge};
    use crate::paper::{THRUST, TORQUE};

    fn levels() -> Vec<[f64; 2]> {
        let at = |k: usize| 0.02 + 0.98 * k as f64 / 9.0;
        (0..100).map(|k| [at(k / 10), at(k % 10)]).collect()
    }

    const BOX: ThrottleBox = ThrottleBox { min: 0.02, max: 1.0 };

    #[test]
    fn the_papers_model_is_unfolded_at_a_small_cost() {
        let points = levels();
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let sampled = |c: &[f64], amount: f64| -> Vec<f64> {
            let p = Polynomial::of(Basis::Biquadratic, c);
            points
                .iter()
                .enumerate()
                .map(|(k, t)| p.at(t[0], t[1]) + amount * noise(k))
                .collect()
        };
        let (f, q) = (sampled(&THRUST, 0.5), sampled(&TORQUE, 0.006));
        for basis in Basis::ALL {
            let design = Design::new(basis, &points, BOX).expect("a design");
            let free = [fit(&design, &f, BOX), fit(&design, &q, BOX)];
            let z = [design.coordinates(&f), design.coordinates(&q)];
            let proven = |f: &Fit, q: &Fit| {
                let map = EnclosedPairMap::of(basis, &f.coefficients, &q.coefficients);
                map.prove_injective(BOX.into()).is_ok()
            };
            assert!(!proven(&free[0], &free[1]), "the test needs a fold to remove");
            let found = constrain(&design, [&free[0], &free[1]], z, BOX).expect("a monotone fit");
            let thrust = judge(&design, &f, &found.thrust, BOX);
            let torque = judge(&design, &q, &found.torque, BOX);
            assert!(proven(&thrust, &torque), "{basis:?}");
            let cost = [
                thrust.residual_rms / free[0].residual_rms,
                torque.residual_rms / free[1].residual_rms,
            ];
            assert!(
                cost.iter().all(|c| (1.0 - 1e-9..1.7).contains(c)),
                "{basis:?} {cost:?}"
            );
        }
    }

    #[test]
    fn a_map_without_fold_stays_as_it_is() {
        let points: Vec<[f64; 2]> = levels().iter().map(|p| p.map(|t| 0.2 + 0.8 * t)).collect();
        let inner = ThrottleBox { min: 0.216, max: 1.0 };
        let at = |c: &[f64], k: usize| Polynomial::of(Basis::Biquadratic, c).at(points[k][0], points[k][1]);
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let f: Vec<f64> = (0..100).map(|k| at(&THRUST, k) + 0.1 * noise(k)).collect();
        let q: Vec<f64> = (0..100).map(|k| at(&TORQUE, k) + 0.001 * noise(k + 50)).collect();
        let design = Design::new(Basis::Biquadratic, &points, inner).expect("a design");
        let free = [fit(&design, &f, inner), fit(&design, &q, inner)];
        let z = [design.coordinates(&f), design.coordinates(&q)];
        let found = constrain(&design, [&free[0], &free[1]], z.clone(), inner).expect("a fit");
        for (a, b) in found.thrust.iter().zip(&z[0]) {
            assert!((a - b).abs() < 1e-4 * (1.0 + b.abs()), "{a} {b}");
        }
    }
}
