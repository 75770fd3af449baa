//! Choice of the basis by cross-validation.
//!
//! Two errors are shown, both as root mean square over the points in percent of full scale: leaving
//! out one point, and leaving out one whole throttle level of one rotor (a level, or a tenth of the
//! points in order of throttle where commands do not repeat). The second is the harder and the more
//! useful test: a mixer commands throttles between and beyond the bench's levels, and a basis with
//! too many terms fails it though it passes the first. The choice falls on the fewest terms whose
//! level error, thrust and torque added, is within one standard error of the least (Breiman's rule)
//! or within a tenth of it.

use std::collections::BTreeSet;

use mixer_compiler::airframe::{Basis, Uncertainty};
use mixer_compiler::model::injectivity::EnclosedPairMap;
use serde::Serialize;

use crate::fit::basis::ThrottleBox;
use crate::fit::fold;
use crate::fit::polynomial::Polynomial;
use crate::fit::{Deficient, Design, leave_one_out};

/// One line of the table.
#[derive(Debug, Clone, Serialize)]
pub struct Candidate {
    /// The basis.
    pub basis: Basis,
    /// Number of terms.
    pub terms: usize,
    /// Errors, or nothing if the points do not determine the basis.
    pub errors: Option<Errors>,
    /// The least idle without fold in the box, where there is one.
    pub least_idle: Option<f64>,
    /// Why there are no errors.
    pub refused: Option<String>,
    /// Whether this one was chosen.
    pub chosen: bool,
}

impl Candidate {
    /// The error on throttle levels that were left out.
    pub fn uncertainty(&self) -> Option<Uncertainty> {
        let errors = self.errors?;
        let (thrust, torque) = (errors.thrust_leave_level_out, errors.torque_leave_level_out);
        Some(Uncertainty::rounded(thrust, torque))
    }
}

/// The one that was chosen.
pub fn chosen(candidates: &[Candidate]) -> Option<&Candidate> {
    candidates.iter().find(|candidate| candidate.chosen)
}

/// Cross-validation errors, percent of full scale.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Errors {
    /// Leave-one-out, thrust.
    pub thrust_leave_one_out: f64,
    /// Leave-one-out, torque.
    pub torque_leave_one_out: f64,
    /// Leave one throttle level out, thrust.
    pub thrust_leave_level_out: f64,
    /// Leave one throttle level out, torque.
    pub torque_leave_level_out: f64,
    /// Standard error of the sum of the two above, over levels.
    pub standard_error: f64,
}

impl Errors {
    fn score(&self) -> f64 {
        self.thrust_leave_level_out + self.torque_leave_level_out
    }
}

/// The table of these bases, with the choice marked. Without any that the points determine: the
/// first one's reason.
pub fn choose(
    bases: &[Basis],
    points: &[[f64; 2]],
    thrust: &[f64],
    torque: &[f64],
    throttle_box: ThrottleBox,
) -> Result<Vec<Candidate>, Deficient> {
    let folds = folds(points);
    let mut table = Vec::new();
    let mut first_reason = None;
    for &basis in bases {
        let mut least_idle = None;
        let (errors, refused) = match Design::new(basis, points, throttle_box) {
            Ok(design) => {
                let found = errors(&design, points, [thrust, torque], &folds);
                if found.is_some() {
                    let [f, q] = [thrust, torque].map(|y| design.coefficients(&design.coordinates(y)));
                    least_idle = fold::least_idle(&EnclosedPairMap::of(basis, &f, &q), throttle_box);
                }
                let why = "not determined without one throttle level";
                (found, found.is_none().then(|| why.to_string()))
            }
            Err(deficient) => {
                first_reason.get_or_insert_with(|| deficient.clone());
                (None, Some(deficient.0))
            }
        };
        table.push(Candidate {
            basis,
            terms: basis.exponents().len(),
            errors,
            least_idle,
            refused,
            chosen: false,
        });
    }
    let scored = || table.iter().filter_map(|c| c.errors);
    let best = scored().min_by(|a, b| a.score().total_cmp(&b.score()));
    let limit = match (best, first_reason) {
        (Some(best), _) => best.score() + best.standard_error.max(0.1 * best.score()),
        (None, Some(reason)) => return Err(reason),
        // Determined as a whole, but by no more than one level can tell: the least basis.
        (None, None) => f64::INFINITY,
    };
    let chosen = table.iter().position(|c| match c.errors {
        Some(errors) => errors.score() <= limit,
        None => best.is_none(),
    });
    if let Some(candidate) = chosen.and_then(|i| table.get_mut(i)) {
        candidate.chosen = true;
    }
    Ok(table)
}

fn errors(
    design: &Design,
    points: &[[f64; 2]],
    channels: [&[f64]; 2],
    folds: &[Vec<bool>],
) -> Option<Errors> {
    let basis = design.centred.basis;
    // Sums of squares per fold and channel in units of full scale, and the number of points.
    let full = channels.map(|y| y.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs())));
    let mut of_folds: Vec<([f64; 2], usize)> = Vec::new();
    for left_out in folds {
        let kept = |i: &usize| !left_out[*i];
        let inside: Vec<[f64; 2]> = (0..points.len()).filter(kept).map(|i| points[i]).collect();
        let inner = Design::within_its_points(basis, &inside).ok()?;
        let mut squares = [0.0; 2];
        for (channel, y) in channels.iter().enumerate() {
            let values: Vec<f64> = (0..points.len()).filter(kept).map(|i| y[i]).collect();
            let polynomial = Polynomial::of(basis, &inner.coefficients(&inner.coordinates(&values)));
            for i in (0..points.len()).filter(|&i| left_out[i]) {
                let miss = (y[i] - polynomial.at(points[i][0], points[i][1])) / full[channel];
                squares[channel] += miss * miss;
            }
        }
        of_folds.push((squares, left_out.iter().filter(|x| **x).count()));
    }
    let count: usize = of_folds.iter().map(|(_, n)| n).sum();
    let rms = |c: usize| 100.0 * (of_folds.iter().map(|(s, _)| s[c]).sum::<f64>() / count as f64).sqrt();
    let of_fold = |(s, n): &([f64; 2], usize)| s.iter().map(|s| (s / *n as f64).sqrt()).sum::<f64>();
    let per_fold: Vec<f64> = of_folds.iter().map(|fold| 100.0 * of_fold(fold)).collect();
    let m = per_fold.len() as f64;
    let mean = per_fold.iter().sum::<f64>() / m;
    let variance = per_fold.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / (m - 1.0).max(1.0);
    let loo = |c: usize| 100.0 * leave_one_out(design, channels[c]) / full[c];
    Some(Errors {
        thrust_leave_one_out: loo(0),
        torque_leave_one_out: loo(1),
        thrust_leave_level_out: rms(0),
        torque_leave_level_out: rms(1),
        standard_error: (variance / m).sqrt(),
    })
}

/// Which points each fold leaves out: the throttle levels of the upper rotor, then those of the
/// lower one.
fn folds(points: &[[f64; 2]]) -> Vec<Vec<bool>> {
    let mut folds = Vec::new();
    for rotor in [0, 1] {
        let level = |p: &[f64; 2]| (p[rotor] * 200.0).round() as i64;
        let levels: BTreeSet<i64> = points.iter().map(level).collect();
        if levels.len() <= 20 && levels.len() * 3 <= points.len() {
            let of_level = |v: &i64| points.iter().map(|p| level(p) == *v).collect::<Vec<bool>>();
            folds.extend(levels.iter().map(of_level));
        } else {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by(|&a, &b| points[a][rotor].total_cmp(&points[b][rotor]));
            let parts = 10.min(points.len());
            let mut tenths = vec![vec![false; points.len()]; parts];
            for (rank, &i) in order.iter().enumerate() {
                tenths[rank * parts / points.len()][i] = true;
            }
            folds.extend(tenths);
        }
    }
    folds
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: ThrottleBox = ThrottleBox { min: 0.1, max: 0.91 };

    fn grid() -> Vec<[f64; 2]> {
        (0..100)
            .map(|k| [0.1 + 0.09 * (k / 10) as f64, 0.1 + 0.09 * (k % 10) as f64])
            .collect()
    }

    /// Noise of 1 part in 200 of full scale, from a linear congruential generator.
    fn noisy(basis: Basis, coefficients: &[f64], seed: u64) -> Vec<f64> {
        let mut state = seed;
        let polynomial = Polynomial::of(basis, coefficients);
        let clean: Vec<f64> = grid().iter().map(|p| polynomial.at(p[0], p[1])).collect();
        let full = clean.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        clean.iter().map(|y| y + 0.01 * full * noise()).collect()
    }

    fn chosen(thrust: &[f64], torque: &[f64]) -> Basis {
        let table = choose(&Basis::ALL, &grid(), thrust, torque, BOX).expect("a table");
        assert_eq!(table.iter().filter(|c| c.chosen).count(), 1);
        table
            .iter()
            .find(|c| c.chosen)
            .map(|c| c.basis)
            .expect("a choice")
    }

    #[test]
    fn the_true_basis_is_chosen() {
        let eight = [5.2, -2.2, 12.4, -10.2, 4.4, 2.8, 12.2, 0.2];
        let eight_q = [-0.07, -0.06, -0.13, 0.1, 0.04, -0.09, 0.14, 0.07];
        let nine = [9.0, -12.0, -3.0, 8.0, 12.0, 4.0, 11.0, 2.0, 1.0];
        let nine_q = [-0.1, 0.05, 0.05, 0.12, -0.2, 0.03, 0.2, -0.05, 0.05];
        for seed in 1..6 {
            let (b, c) = (Basis::Biquadratic, Basis::Cubic);
            assert_eq!(
                chosen(&noisy(b, &eight, seed), &noisy(b, &eight_q, seed + 50)),
                b,
                "{seed}"
            );
            assert_eq!(
                chosen(&noisy(c, &nine, seed), &noisy(c, &nine_q, seed + 50)),
                c,
                "{seed}"
            );
        }
    }

    #[test]
    fn scattered_commands_are_grouped_in_tenths() {
        let points: Vec<[f64; 2]> = (0..60)
            .map(|k| [(k as f64 * 0.618_034) % 1.0, (k as f64 * 0.414_214) % 1.0])
            .collect();
        let folds = folds(&points);
        assert_eq!(folds.len(), 20);
        for i in 0..60 {
            assert_eq!(folds.iter().filter(|f| f[i]).count(), 2);
        }
    }
}
