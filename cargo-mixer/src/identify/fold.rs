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
    /// The part of the box where det J <= 0: [least, greatest] of u and of l.
    pub region: Option<[[f64; 2]; 2]>,
    /// The least idle of both rotors, at or above the box's, without fold; none if there is none below 0.9 of full.
    pub least_idle: Option<f64>,
}

/// det J as a polynomial.
pub fn determinant(thrust: &Polynomial, torque: &Polynomial) -> Polynomial {
    thrust
        .du()
        .times(&torque.dl())
        .plus(-1.0, &thrust.dl().times(&torque.du()))
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
        &determinant(&f, &q),
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
    // `<=` would let a NaN pass as positive.
    if let Some(&(_, u, l)) = corners.iter().find(|(value, ..)| !(*value > floor)) {
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

/// The report for a map on a box.
pub fn examine(basis: Basis, thrust: &[f64], torque: &[f64], commanded: ThrottleBox) -> Fold {
    let det = determinant(&basis.polynomial(thrust), &basis.polynomial(torque));
    let mut least = (f64::MAX, [commanded.min; 2]);
    let mut region: Option<[[f64; 2]; 2]> = None;
    let grid = commanded.grid(200);
    for u in grid.clone() {
        for l in grid.clone() {
            let value = det.at(u, l);
            if value < least.0 {
                least = (value, [u, l]);
            }
            if value <= 0.0 {
                let seen = region.unwrap_or([[u, u], [l, l]]);
                region = Some([
                    [seen[0][0].min(u), seen[0][1].max(u)],
                    [seen[1][0].min(l), seen[1][1].max(l)],
                ]);
            }
        }
    }
    Fold {
        commanded,
        folds: det_sign(basis, thrust, torque, commanded) != DetSign::Positive,
        least_det: least.0,
        least_det_at: least.1,
        region,
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
        let [u, l] = fold.region.expect("a region");
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
