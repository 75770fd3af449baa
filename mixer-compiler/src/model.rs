//! The forward map of one unit in f64, with its Jacobian: what inverses are fitted to and checked against.

use crate::airframe::{Pair, Throttle};

/// Largest exponent of any basis.
const DEGREE: usize = 4;

/// Thrust and torque of one unit at the reference voltage (eq. (1)).
#[derive(Clone, Debug)]
pub struct PairMap {
    terms: Vec<Term>,
    range: [f64; 2],
}

/// One monomial with its coefficient in thrust (N) and in torque (N m).
#[derive(Clone, Debug)]
struct Term {
    powers: [usize; 2],
    coefficients: [f64; 2],
}

impl PairMap {
    /// The map of a pair over the allowed throttles.
    pub fn new(pair: &Pair, throttle: &Throttle) -> Self {
        let coefficients = pair.thrust_n.iter().zip(&pair.torque_nm);
        let terms = pair
            .basis
            .exponents()
            .iter()
            .zip(coefficients)
            .map(|(&(u, l), (&f, &q))| Term {
                powers: [usize::from(u), usize::from(l)],
                coefficients: [f, q],
            })
            .collect();
        PairMap {
            terms,
            range: [throttle.min, throttle.max],
        }
    }

    /// Least and largest throttle.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Efforts `[f, Q]` at throttles `[u, l]`, N and N m.
    pub fn efforts(&self, throttles: [f64; 2]) -> [f64; 2] {
        let [u, l] = throttles.map(powers);
        let mut efforts = [0.0; 2];
        for term in &self.terms {
            let monomial = u[term.powers[0]] * l[term.powers[1]];
            efforts[0] += term.coefficients[0] * monomial;
            efforts[1] += term.coefficients[1] * monomial;
        }
        efforts
    }

    /// Jacobian `[[f_u, f_l], [Q_u, Q_l]]` at throttles `[u, l]`.
    pub fn jacobian(&self, throttles: [f64; 2]) -> [[f64; 2]; 2] {
        let [u, l] = throttles.map(powers);
        let mut jacobian = [[0.0; 2]; 2];
        for Term {
            powers: [i, j],
            coefficients,
        } in &self.terms
        {
            let by_u = if *i == 0 {
                0.0
            } else {
                *i as f64 * u[i - 1] * l[*j]
            };
            let by_l = if *j == 0 {
                0.0
            } else {
                *j as f64 * u[*i] * l[j - 1]
            };
            for (row, coefficient) in jacobian.iter_mut().zip(coefficients) {
                row[0] += coefficient * by_u;
                row[1] += coefficient * by_l;
            }
        }
        jacobian
    }

    /// One Newton step from `throttles` towards `efforts` with `residuals` residuals to its Jacobian, each clamped
    /// to the range as `mixer-rt` does.
    pub fn newton(&self, throttles: [f64; 2], [f, q]: [f64; 2], residuals: u8) -> [f64; 2] {
        let [[f_u, f_l], [q_u, q_l]] = self.jacobian(throttles);
        let determinant = f_u * q_l - f_l * q_u;
        let [mut u, mut l] = throttles;
        for _ in 0..residuals {
            let [thrust, torque] = self.efforts([u, l]);
            let (missing_f, missing_q) = (f - thrust, q - torque);
            u = self.clamp(u + (missing_f * q_l - missing_q * f_l) / determinant);
            l = self.clamp(l + (missing_q * f_u - missing_f * q_u) / determinant);
        }
        [u, l]
    }

    /// A throttle limited to the range.
    pub fn clamp(&self, throttle: f64) -> f64 {
        throttle.clamp(self.range[0], self.range[1])
    }

    /// Throttles on a `points` x `points` grid over the range that is denser towards the edges (Chebyshev's
    /// extrema), corners included.
    pub fn grid(&self, points: usize) -> Vec<[f64; 2]> {
        squared(&self.nodes(points))
    }

    /// [`PairMap::grid`] with two more lines along every edge of the box: next to a fold an inverse bends within
    /// less than the grid's first step.
    pub fn edge_grid(&self, points: usize) -> Vec<[f64; 2]> {
        let [low, high] = self.range;
        let mut nodes = self.nodes(points);
        let step = nodes[1] - low;
        for share in [0.25, 0.0625] {
            nodes.extend([low + share * step, high - share * step]);
        }
        nodes.sort_by(f64::total_cmp);
        squared(&nodes)
    }

    fn nodes(&self, points: usize) -> Vec<f64> {
        let [low, high] = self.range;
        let node = |k: usize| {
            let share = 0.5 - 0.5 * libm::cos(std::f64::consts::PI * k as f64 / (points - 1) as f64);
            if k + 1 == points {
                high
            } else {
                low + (high - low) * share
            }
        };
        (0..points).map(node).collect()
    }

    /// `points` throttles along the border of the box, anticlockwise in the plane of (f, Q): since det J > 0 the
    /// map keeps the sense of rotation. Starts at idle, corners included once each; `points` is per edge.
    pub fn border(&self, points: usize) -> Vec<[f64; 2]> {
        let [low, high] = self.range;
        let at = |k: usize| low + (high - low) * k as f64 / points as f64;
        let mut border = Vec::with_capacity(4 * points);
        border.extend((0..points).map(|k| [at(k), low]));
        border.extend((0..points).map(|k| [high, at(k)]));
        border.extend((0..points).map(|k| [high - (at(k) - low), high]));
        border.extend((0..points).map(|k| [low, high - (at(k) - low)]));
        border
    }

    /// Largest thrust (N) and largest absolute torque (N m) over the box: the sizes of the efforts.
    pub fn scale(&self) -> [f64; 2] {
        let mut scale = [0.0f64; 2];
        for throttles in self.border(32) {
            let [f, q] = self.efforts(throttles);
            scale = [scale[0].max(f.abs()), scale[1].max(q.abs())];
        }
        scale
    }
}

fn squared(nodes: &[f64]) -> Vec<[f64; 2]> {
    nodes
        .iter()
        .flat_map(|&u| nodes.iter().map(move |&l| [u, l]))
        .collect()
}

/// `[1, x, x^2, ..]` up to the largest exponent.
fn powers(x: f64) -> [f64; DEGREE + 1] {
    let mut powers = [1.0; DEGREE + 1];
    for k in 1..=DEGREE {
        powers[k] = powers[k - 1] * x;
    }
    powers
}
