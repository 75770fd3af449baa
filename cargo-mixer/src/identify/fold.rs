//! Where the fitted map folds, and the least idle that avoids it.
//!
//! The mixer inverts (u, l) -> (f, Q). Where det J = f_u Q_l - f_l Q_u <= 0 two commands give one effort: the map
//! folds. det J is a polynomial, so that its sign over a box is proven by Bernstein coefficients with bisection.
//! A smaller box inside a box without fold has none, so the least idle is found by bisection too.

use serde::Serialize;

use super::basis::{Basis, Polynomial, ThrottleBox};
use super::bernstein::{Cell, cell, coefficients, quarters};

/// What is known about det J over a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DetSign {
    /// Proven positive.
    Positive,
    /// Not positive, or not proven, here.
    Folds {
        /// Throttles (u, l).
        at: [f64; 2],
    },
}

/// The report on a map's fold.
#[derive(Debug, Clone, Serialize)]
pub struct Fold {
    /// The box that was examined.
    pub commanded: ThrottleBox,
    /// Whether the map folds inside it.
    pub folds: bool,
    /// Least det J on a grid of the box, N * N m per throttle squared.
    pub least_det: f64,
    /// Where, (u, l).
    pub least_det_at: [f64; 2],
    /// The connected parts of the box where det J <= 0, worst first; none narrower than half a percent of the box.
    pub regions: Vec<Region>,
    /// The least idle of both rotors, at or above the box's, without fold; none if there is none below 0.9 of full.
    pub least_idle: Option<f64>,
}

/// A part of the box where the map folds.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Region {
    /// Least and greatest u in it.
    pub u: [f64; 2],
    /// Least and greatest l in it.
    pub l: [f64; 2],
    /// Least det J in it.
    pub least_det: f64,
    /// Where, (u, l).
    pub least_det_at: [f64; 2],
}

/// det J as a polynomial, of a thrust and a torque in this basis.
pub fn determinant(basis: Basis, thrust: &Polynomial, torque: &Polynomial) -> Polynomial {
    let det = thrust
        .du()
        .times(&torque.dl())
        .plus(-1.0, &thrust.dl().times(&torque.du()));
    det.resized(basis.determinant_degree())
}

/// The sign of det J over a box.
pub fn det_sign(basis: Basis, thrust: &[f64], torque: &[f64], throttle_box: ThrottleBox) -> DetSign {
    let (f, q) = (basis.polynomial(thrust), basis.polynomial(torque));
    // On [0, 1] all terms of the products add up to no more than this.
    let sizes = f
        .du()
        .sizes()
        .times(&q.dl().sizes())
        .plus(1.0, &f.dl().sizes().times(&q.du().sizes()));
    positive(
        &determinant(basis, &f, &q),
        cell(throttle_box),
        ROUNDING * sizes.at(1.0, 1.0),
        12,
    )
}

/// Rounding of a Bernstein coefficient in parts of the sum of its terms' sizes: what is below is no proof.
const ROUNDING: f64 = 1e-13;

fn positive(p: &Polynomial, at: Cell, floor: f64, depth: usize) -> DetSign {
    let b = coefficients(p, at);
    if b.iter().flatten().all(|&x| x > floor) {
        return DetSign::Positive;
    }
    let (n, m) = (b.len() - 1, b[0].len() - 1);
    let [[ua, ub], [la, lb]] = at;
    let corners = [
        (b[0][0], ua, la),
        (b[n][0], ub, la),
        (b[0][m], ua, lb),
        (b[n][m], ub, lb),
    ];
    if let Some(&(_, u, l)) = corners
        .iter()
        .find(|(value, ..)| value.is_nan() || *value <= floor)
    {
        return DetSign::Folds { at: [u, l] };
    }
    if depth == 0 {
        return DetSign::Folds {
            at: [0.5 * (ua + ub), 0.5 * (la + lb)],
        };
    }
    let folded = quarters(at)
        .into_iter()
        .map(|q| positive(p, q, floor, depth - 1))
        .find(|s| *s != DetSign::Positive);
    folded.unwrap_or(DetSign::Positive)
}

/// The least idle of both rotors from the box's on, to a millionth, from which on the map has no fold.
pub fn least_idle(basis: Basis, thrust: &[f64], torque: &[f64], throttle_box: ThrottleBox) -> Option<f64> {
    let works =
        |min: f64| det_sign(basis, thrust, torque, ThrottleBox { min, ..throttle_box }) == DetSign::Positive;
    let mut folds = throttle_box.min;
    if works(folds) {
        return Some(folds);
    }
    let mut fine = throttle_box.min + 0.9 * (throttle_box.max - throttle_box.min);
    if !works(fine) {
        return None;
    }
    while fine - folds > 1e-6 {
        let middle = 0.5 * (folds + fine);
        if works(middle) {
            fine = middle;
        } else {
            folds = middle;
        }
    }
    Some(fine)
}

/// Steps of the grid on which regions are sought.
const STEPS: usize = 200;

/// Connected regions of values <= 0 on a square grid (u by rows), by flood fill.
fn regions(grid: &[f64], mut values: Vec<f64>) -> Vec<Region> {
    let n = grid.len();
    let mut found = Vec::new();
    for seed in 0..values.len() {
        if values[seed] > 0.0 {
            continue;
        }
        let [u, l] = [grid[seed / n], grid[seed % n]];
        let mut region = Region {
            u: [u, u],
            l: [l, l],
            least_det: values[seed],
            least_det_at: [u, l],
        };
        let mut open = vec![seed];
        while let Some(k) = open.pop() {
            let value = std::mem::replace(&mut values[k], f64::INFINITY);
            if value > 0.0 {
                continue;
            }
            let (i, j) = (k / n, k % n);
            let [u, l] = [grid[i], grid[j]];
            region.u = [region.u[0].min(u), region.u[1].max(u)];
            region.l = [region.l[0].min(l), region.l[1].max(l)];
            if value < region.least_det {
                (region.least_det, region.least_det_at) = (value, [u, l]);
            }
            let beside = [
                (i > 0, k.wrapping_sub(n)),
                (i + 1 < n, k + n),
                (j > 0, k.wrapping_sub(1)),
                (j + 1 < n, k + 1),
            ];
            open.extend(
                beside
                    .into_iter()
                    .filter(|(inside, _)| *inside)
                    .map(|(_, next)| next),
            );
        }
        found.push(region);
    }
    found.sort_by(|a, b| a.least_det.total_cmp(&b.least_det));
    found
}

/// The report for a map on a box.
pub fn examine(basis: Basis, thrust: &[f64], torque: &[f64], commanded: ThrottleBox) -> Fold {
    let det = determinant(basis, &basis.polynomial(thrust), &basis.polynomial(torque));
    let grid: Vec<f64> = commanded.grid(STEPS).collect();
    let values: Vec<f64> = grid
        .iter()
        .flat_map(|&u| grid.iter().map(move |&l| (u, l)))
        .map(|(u, l)| det.at(u, l))
        .collect();
    let least = (0..values.len())
        .min_by(|&a, &b| values[a].total_cmp(&values[b]))
        .unwrap_or(0);
    let place = |k: usize| [grid[k / grid.len()], grid[k % grid.len()]];
    Fold {
        commanded,
        folds: det_sign(basis, thrust, torque, commanded) != DetSign::Positive,
        least_det: values[least],
        least_det_at: place(least),
        regions: regions(&grid, values),
        least_idle: least_idle(basis, thrust, torque, commanded),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // Table I of the paper.
    const THRUST: [f64; 8] = [
        5.2075, -2.1892, 12.3604, -10.2432, 4.4427, 2.7640, 12.2092, 0.2363,
    ];
    const TORQUE: [f64; 8] = [-0.0673, -0.0606, -0.1312, 0.0953, 0.0364, -0.0907, 0.1441, 0.0720];

    #[test]
    fn the_papers_model_folds_below_an_idle_of_0_08875() {
        let b = Basis::Biquadratic;
        let whole = ThrottleBox { min: 0.0, max: 1.0 };
        let fold = examine(b, &THRUST, &TORQUE, whole);
        assert!(fold.folds && fold.least_det < 0.0);
        assert!(
            (fold.least_idle.expect("an idle") - 0.08875).abs() < 1e-5,
            "{:?}",
            fold.least_idle
        );
        assert_eq!(fold.regions.len(), 1);
        let Region { u, l, .. } = fold.regions[0];
        assert!(
            (u[1] - 0.089).abs() < 0.006 && (l[0] - 0.79).abs() < 0.01 && l[1] == 1.0,
            "{u:?} {l:?}"
        );
        assert_eq!(
            det_sign(
                b,
                &THRUST,
                &TORQUE,
                ThrottleBox {
                    min: 0.0888,
                    max: 1.0
                }
            ),
            DetSign::Positive
        );
        assert!(
            det_sign(
                b,
                &THRUST,
                &TORQUE,
                ThrottleBox {
                    min: 0.0887,
                    max: 1.0
                }
            ) != DetSign::Positive
        );
    }

    #[test]
    fn a_constant_map_and_nan_are_no_proof() {
        let b = Basis::Biquadratic;
        let whole = ThrottleBox { min: 0.1, max: 1.0 };
        assert!(det_sign(b, &[0.0; 8], &[0.0; 8], whole) != DetSign::Positive);
        assert!(det_sign(b, &[f64::NAN; 8], &TORQUE, whole) != DetSign::Positive);
        assert_eq!(least_idle(b, &THRUST, &THRUST, whole), None);
    }
}
