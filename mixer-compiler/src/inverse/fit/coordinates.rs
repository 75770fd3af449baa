//! The root coordinates in which the inverse is almost bilinear.
//!
//! If f and Q were quadratic forms of (u, l), two combinations f/F - p Q/T and f/F + r Q/T would be
//! perfect squares of linear forms in u and l: p and -r are the generalised eigenvalues of the two
//! forms. Their roots x and y would be linear in (u, l), and the inverse linear in (x, y). Real
//! pairs deviate: offsets c1, c2 keep the radicands positive, and (p, r, c1, c2) are searched from
//! there (Nelder and Mead 1965) for the least error of a fit.

use super::sample::{Sample, samples, weights};
use crate::model::PairMap;

/// `x = sqrt(x0 f + x1 Q + x2)`, `y = sqrt(y0 f + y1 Q + y2)`, with f in N and Q in N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coordinates {
    /// Factors of x: 1/N, 1/(N m), 1.
    pub x: [f64; 3],
    /// Factors of y.
    pub y: [f64; 3],
}

/// Points per side of the grid on which coordinates are judged.
const GRID: usize = 11;

/// Points per edge of the set's border.
const BORDER: usize = 48;

/// Least radicand at the border points.
const POSITIVE: f64 = 3e-4;

/// Least radicand at the start of the search.
const START: f64 = 0.01;

/// Edge of the simplex at the start.
const EDGE: f64 = 0.1;

/// An error in units of the tolerance that leaves the proof room.
const ENOUGH: f64 = 0.75;

/// Evaluations of the simplex search.
const EVALUATIONS: usize = 220;

/// What coordinates are searched for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// Terms of the fit: 4 or 6.
    terms: usize,
    /// Errors count by det J to the power `-emphasis`: where it is small, a Newton step bears
    /// smaller errors of its seed.
    pub(super) emphasis: f64,
}

impl Start {
    /// The first suits ordinary pairs, the others pairs next to a fold.
    pub(super) const ALL: [Start; 3] = [
        Start {
            terms: 4,
            emphasis: 0.0,
        },
        Start {
            terms: 4,
            emphasis: 0.75,
        },
        Start {
            terms: 6,
            emphasis: 0.75,
        },
    ];
}

impl Coordinates {
    /// (x, y) at the efforts `[f, Q]`.
    pub(crate) fn at(&self, [f, q]: [f64; 2]) -> [f64; 2] {
        let root = |[by_f, by_q, offset]: [f64; 3]| (by_f * f + by_q * q + offset).max(0.0).sqrt();
        [root(self.x), root(self.y)]
    }

    /// Searches the coordinates of a pair in which the start's fit of the throttles is best.
    pub(super) fn search(pair: &PairMap, Start { terms, emphasis }: Start) -> Self {
        let samples = samples(pair, pair.grid(GRID));
        let plane = Plane::new(pair);
        let [p, r] = eigenvalues(&samples, plane.scale);
        let weights = weights(pair, &samples, emphasis);
        let error = if terms == 4 {
            fit_error::<4>
        } else {
            fit_error::<6>
        };
        let objective = |parameters: &[f64; 4]| error(&samples, &weights, &plane.coordinates(parameters));
        let start = [p, r, plane.least(-p) + START, plane.least(r) + START];
        plane.coordinates(&minimise(start, EDGE, EVALUATIONS, objective, |_, _| false))
    }

    /// Searches on from here for the least `error`, until it is below 1 with something to spare, or
    /// will not become so: half of the evaluations must bring it half of the way.
    pub(crate) fn improved(
        &self,
        pair: &PairMap,
        evaluations: usize,
        error: impl Fn(&Coordinates) -> f64,
    ) -> Self {
        let plane = Plane::new(pair);
        let start = [
            -self.x[1] * plane.scale[1],
            self.y[1] * plane.scale[1],
            self.x[2],
            self.y[2],
        ];
        let objective = |parameters: &[f64; 4]| error(&plane.coordinates(parameters));
        let first = objective(&start);
        let enough = |done: usize, least: f64| {
            least < ENOUGH || (2 * done > evaluations && least > 1.0 && least - 1.0 > 0.5 * (first - 1.0))
        };
        plane.coordinates(&minimise(start, 0.3 * EDGE, evaluations, objective, enough))
    }
}

/// The attainable set in units of the efforts' sizes.
struct Plane {
    scale: [f64; 2],
    border: Vec<[f64; 2]>,
}

impl Plane {
    fn new(pair: &PairMap) -> Self {
        let scale = pair.scale();
        let scaled = |throttles: [f64; 2]| {
            let [f, q] = pair.efforts(throttles);
            [f / scale[0], q / scale[1]]
        };
        Plane {
            scale,
            border: pair.border(BORDER).into_iter().map(scaled).collect(),
        }
    }

    /// The least offset with which f/F + `by_q` Q/T is nowhere negative on the set.
    fn least(&self, by_q: f64) -> f64 {
        let (mut least, mut k) = (f64::INFINITY, 0);
        while k < self.border.len() {
            let [f, q] = self.border[k];
            let value = f + by_q * q;
            if value < least {
                least = value;
            }
            k += 1;
        }
        -least
    }

    /// From (p, r, c1, c2). Radicands stay positive: where one were limited to zero, the fit would
    /// have a kink that hides between the samples.
    fn coordinates(&self, [p, r, c1, c2]: &[f64; 4]) -> Coordinates {
        let offset = |by_q: f64, offset: f64| offset.max(self.least(by_q) + POSITIVE);
        Coordinates {
            x: [1.0 / self.scale[0], -p / self.scale[1], offset(-p, *c1)],
            y: [1.0 / self.scale[0], r / self.scale[1], offset(*r, *c2)],
        }
    }
}

/// p and r from pure quadratic forms fitted to thrust and torque: det(A - p B) = 0 for the positive
/// root p and the negative root -r, A and B the forms of f/F and Q/T.
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

/// The sum of sixth powers of the weighted throttle errors of a least-squares fit: close to the
/// maximum, yet smooth. The terms are 1, x, y, xy and, with `TERMS` = 6, x2 and y2.
fn fit_error<const TERMS: usize>(samples: &[Sample], weights: &[f64], coordinates: &Coordinates) -> f64 {
    let mut normal = [[0.0f64; TERMS]; TERMS];
    let mut right = [[0.0f64; TERMS]; 2];
    let mut rows = Vec::with_capacity(samples.len());
    for (sample, weight) in samples.iter().zip(weights) {
        let [x, y] = coordinates.at(sample.efforts);
        let all = [1.0, x, y, x * y, x * x, y * y];
        let mut row = [0.0; TERMS];
        row.copy_from_slice(&all[..TERMS]);
        let square = weight * weight;
        // Plain loops: the search runs through here hundreds of times in builds without
        // optimisation.
        let mut i = 0;
        while i < TERMS {
            let weighted = square * row[i];
            right[0][i] += weighted * sample.throttles[0];
            right[1][i] += weighted * sample.throttles[1];
            let mut j = i;
            while j < TERMS {
                normal[i][j] += weighted * row[j];
                j += 1;
            }
            i += 1;
        }
        rows.push(row);
    }
    let Some(solution) = solve_symmetric(normal, right) else {
        return f64::INFINITY;
    };
    let mut sum = 0.0;
    for ((sample, weight), row) in samples.iter().zip(weights).zip(&rows) {
        let (mut u, mut l, mut i) = (0.0, 0.0, 0);
        while i < TERMS {
            u += solution[0][i] * row[i];
            l += solution[1][i] * row[i];
            i += 1;
        }
        for error in [u - sample.throttles[0], l - sample.throttles[1]] {
            let error = error * weight;
            let square = error * error;
            sum += square * square * square;
        }
    }
    sum
}

/// Solves a symmetric positive definite system given by its upper triangle, with two right-hand
/// sides, by Gauss elimination without pivoting.
fn solve_symmetric<const TERMS: usize>(
    mut rows: [[f64; TERMS]; TERMS],
    mut right: [[f64; TERMS]; 2],
) -> Option<[[f64; TERMS]; 2]> {
    for i in 0..TERMS {
        let pivot = rows[i][i];
        if pivot.is_nan() || pivot <= 1e-12 {
            return None;
        }
        for k in i + 1..TERMS {
            let factor = rows[i][k] / pivot;
            let mut j = k;
            while j < TERMS {
                rows[k][j] -= factor * rows[i][j];
                j += 1;
            }
            for right in &mut right {
                right[k] -= factor * right[i];
            }
        }
    }
    for unknowns in &mut right {
        for i in (0..TERMS).rev() {
            for j in i + 1..TERMS {
                unknowns[i] -= rows[i][j] * unknowns[j];
            }
            unknowns[i] /= rows[i][i];
        }
    }
    Some(right)
}

/// Nelder and Mead's simplex search with their coefficients 1, 2, 1/2, 1/2; `enough` may end it
/// early, given the evaluations so far and the least value.
fn minimise(
    start: [f64; 4],
    edge: f64,
    most_evaluations: usize,
    objective: impl Fn(&[f64; 4]) -> f64,
    enough: impl Fn(usize, f64) -> bool,
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
        if enough(evaluations, simplex[0].1) {
            break;
        }
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
