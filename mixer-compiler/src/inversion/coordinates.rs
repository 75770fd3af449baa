//! The root coordinates in which the inverse is almost bilinear.
//!
//! If f and Q were quadratic forms of (u, l), two combinations f/F - p Q/T and f/F + r Q/T would be perfect squares
//! of linear forms in u and l: p and -r are the generalised eigenvalues of the two forms. Their roots x and y would
//! be linear in (u, l), and the inverse linear in (x, y). Real pairs deviate: offsets c1, c2 keep the radicands
//! positive, and (p, r, c1, c2) are searched from there (Nelder and Mead 1965) for the least error of a bilinear
//! fit.

use super::{Sample, samples};
use crate::model::PairMap;

/// `x = sqrt(x0 f + x1 Q + x2)`, `y = sqrt(y0 f + y1 Q + y2)`, with f in N and Q in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates {
    /// Factors of x: 1/N, 1/(N m), 1.
    pub x: [f64; 3],
    /// Factors of y.
    pub y: [f64; 3],
}

/// Points per side of the grid on which coordinates are judged.
const GRID: usize = 11;

/// Edge of the simplex at the start.
const EDGE: f64 = 0.1;

/// Evaluations of the simplex search.
const EVALUATIONS: usize = 220;

impl Coordinates {
    /// (x, y) at the efforts `[f, Q]`.
    pub fn at(&self, [f, q]: [f64; 2]) -> [f64; 2] {
        let root = |[by_f, by_q, offset]: [f64; 3]| (by_f * f + by_q * q + offset).max(0.0).sqrt();
        [root(self.x), root(self.y)]
    }

    /// Searches the coordinates of a pair in which a bilinear fit of the throttles is best. Errors count for more
    /// where det J is small, by its power `-emphasis`: 0 suits ordinary pairs, but next to a fold a Newton step
    /// bears smaller errors of its seed than elsewhere.
    pub fn search(pair: &PairMap, emphasis: f64) -> Self {
        let scale = pair.scale();
        let samples = samples(pair, GRID);
        let [p, r] = eigenvalues(&samples, scale);
        // Offsets just large enough to keep both radicands positive over the set.
        let least = |by_q: f64| {
            let radicands = samples
                .iter()
                .map(|s| s.efforts[0] / scale[0] + by_q * s.efforts[1] / scale[1]);
            0.01 - radicands.fold(f64::INFINITY, f64::min)
        };
        let start = [p, r, least(-p), least(r)];
        let weights = weights(pair, &samples, emphasis);
        let objective =
            |parameters: &[f64; 4]| bilinear_error(&samples, &weights, &Coordinates::new(scale, parameters));
        Coordinates::new(scale, &minimise(start, EDGE, EVALUATIONS, objective))
    }

    /// Searches on from here for the least `error`.
    pub fn improved(&self, pair: &PairMap, evaluations: usize, error: impl Fn(&Coordinates) -> f64) -> Self {
        let scale = pair.scale();
        let start = [-self.x[1] * scale[1], self.y[1] * scale[1], self.x[2], self.y[2]];
        let objective = |parameters: &[f64; 4]| error(&Coordinates::new(scale, parameters));
        Coordinates::new(scale, &minimise(start, 0.3 * EDGE, evaluations, objective))
    }

    /// From (p, r, c1, c2).
    fn new(scale: [f64; 2], [p, r, c1, c2]: &[f64; 4]) -> Self {
        Coordinates {
            x: [1.0 / scale[0], -p / scale[1], *c1],
            y: [1.0 / scale[0], r / scale[1], *c2],
        }
    }
}

/// Weights of errors: a power of det J over its mean, bounded where det J vanishes.
fn weights(pair: &PairMap, samples: &[Sample], emphasis: f64) -> Vec<f64> {
    const FLOOR: f64 = 0.003;
    let determinant = |sample: &Sample| {
        let [[f_u, f_l], [q_u, q_l]] = pair.jacobian(sample.throttles);
        (f_u * q_l - f_l * q_u).max(0.0)
    };
    let determinants: Vec<f64> = samples.iter().map(determinant).collect();
    let mean = determinants.iter().sum::<f64>() / determinants.len() as f64;
    determinants
        .iter()
        .map(|determinant| libm::pow(mean / (determinant + FLOOR * mean), emphasis))
        .collect()
}

/// p and r from pure quadratic forms fitted to thrust and torque: det(A - p B) = 0 for the positive root p and the
/// negative root -r, A and B the forms of f/F and Q/T.
fn eigenvalues(samples: &[Sample], scale: [f64; 2]) -> [f64; 2] {
    let [a, b] = [0, 1].map(|k| quadratic_form(samples, |sample| sample.efforts[k] / scale[k]));
    // det [[a0 - p b0, (a1 - p b1)/2], [.., a2 - p b2]] = 0
    let square = b[0] * b[2] - 0.25 * b[1] * b[1];
    let linear = -(a[0] * b[2] + a[2] * b[0] - 0.5 * a[1] * b[1]);
    let constant = a[0] * a[2] - 0.25 * a[1] * a[1];
    let discriminant = linear * linear - 4.0 * square * constant;
    if square < 0.0 && discriminant > 0.0 {
        let root = discriminant.sqrt();
        let (one, other) = (
            (-linear + root) / (2.0 * square),
            (-linear - root) / (2.0 * square),
        );
        let (low, high) = if one < other { (one, other) } else { (other, one) };
        if low < 0.0 && high > 0.0 {
            return [high.min(2.0), (-low).min(2.0)];
        }
    }
    [0.6, 0.6] // a pair whose torque is no indefinite form; the search goes on from an ordinary pair
}

/// Least-squares coefficients of u^2, u l, l^2.
fn quadratic_form(samples: &[Sample], value: impl Fn(&Sample) -> f64) -> [f64; 3] {
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for sample in samples {
        let [u, l] = sample.throttles;
        let terms = nalgebra::Vector3::new(u * u, u * l, l * l);
        normal += terms * terms.transpose();
        right += terms * value(sample);
    }
    normal
        .cholesky()
        .map_or([1.0, 0.0, 1.0], |factors| factors.solve(&right).into())
}

/// The sum of sixth powers of the weighted throttle errors of a bilinear least-squares fit: close to the maximum, yet
/// smooth.
fn bilinear_error(samples: &[Sample], weights: &[f64], coordinates: &Coordinates) -> f64 {
    let mut normal = [[0.0f64; 6]; 4]; // with both right-hand sides as columns 4 and 5
    for (sample, weight) in samples.iter().zip(weights) {
        let [x, y] = coordinates.at(sample.efforts);
        let terms = [1.0, x, y, x * y];
        let row = [1.0, x, y, x * y, sample.throttles[0], sample.throttles[1]];
        for (i, (sums, term)) in normal.iter_mut().zip(terms).enumerate() {
            for (sum, value) in sums.iter_mut().zip(row).skip(i) {
                *sum += weight * weight * term * value;
            }
        }
    }
    let Some(solution) = solve_symmetric(normal) else {
        return f64::INFINITY;
    };
    let mut sum = 0.0;
    for (sample, weight) in samples.iter().zip(weights) {
        let [x, y] = coordinates.at(sample.efforts);
        for (c, throttle) in solution.iter().zip(sample.throttles) {
            let error = c[0] + c[1] * x + c[2] * y + c[3] * x * y - throttle;
            let error = error * weight;
            let square = error * error;
            sum += square * square * square;
        }
    }
    sum
}

/// Solves a symmetric positive definite 4 x 4 system given by its upper triangle, with two right-hand sides, by
/// Gauss elimination without pivoting. (Written out, since the search solves it hundreds of times in builds at
/// opt-level 0.)
fn solve_symmetric(mut rows: [[f64; 6]; 4]) -> Option<[[f64; 4]; 2]> {
    for i in 0..4 {
        let pivot_row = rows[i];
        let pivot = pivot_row[i];
        if pivot.is_nan() || pivot <= 1e-12 {
            return None;
        }
        for (k, row) in rows.iter_mut().enumerate().skip(i + 1) {
            let factor = pivot_row[k] / pivot;
            for (value, above) in row.iter_mut().zip(pivot_row).skip(k) {
                *value -= factor * above;
            }
        }
    }
    let mut solution = [[0.0; 4]; 2];
    for (column, unknowns) in solution.iter_mut().enumerate() {
        for (i, row) in rows.iter().enumerate().rev() {
            let known: f64 = row.iter().zip(&*unknowns).skip(i + 1).map(|(a, x)| a * x).sum();
            unknowns[i] = (row[4 + column] - known) / row[i];
        }
    }
    Some(solution)
}

/// Nelder and Mead's simplex search with their coefficients 1, 2, 1/2, 1/2.
fn minimise(
    start: [f64; 4],
    edge: f64,
    most_evaluations: usize,
    objective: impl Fn(&[f64; 4]) -> f64,
) -> [f64; 4] {
    let mut simplex: Vec<([f64; 4], f64)> = vec![(start, objective(&start))];
    for k in 0..4 {
        let mut vertex = start;
        vertex[k] += edge;
        simplex.push((vertex, objective(&vertex)));
    }
    let mut evaluations = 5;
    while evaluations < most_evaluations {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let worst = simplex[4];
        let mut centre = [0.0; 4];
        for (vertex, _) in &simplex[..4] {
            for (c, v) in centre.iter_mut().zip(vertex) {
                *c += 0.25 * v;
            }
        }
        let towards = |factor: f64| {
            let mut point = centre;
            for (p, w) in point.iter_mut().zip(&worst.0) {
                *p += factor * (*p - w);
            }
            (point, objective(&point))
        };
        let reflected = towards(1.0);
        evaluations += 1;
        if reflected.1 < simplex[0].1 {
            let expanded = towards(2.0);
            evaluations += 1;
            simplex[4] = if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            };
        } else if reflected.1 < simplex[3].1 {
            simplex[4] = reflected;
        } else {
            let contracted = towards(if reflected.1 < worst.1 { 0.5 } else { -0.5 });
            evaluations += 1;
            if contracted.1 < worst.1.min(reflected.1) {
                simplex[4] = contracted;
            } else {
                let best = simplex[0].0;
                for (vertex, value) in &mut simplex[1..] {
                    for (v, b) in vertex.iter_mut().zip(&best) {
                        *v = b + 0.5 * (*v - b);
                    }
                    *value = objective(vertex);
                }
                evaluations += 4;
            }
        }
    }
    simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
    simplex[0].0
}
