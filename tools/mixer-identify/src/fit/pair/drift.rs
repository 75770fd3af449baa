//! Drift in the order of the rows: a load cell's zero or its scale, a battery that runs empty, motors that
//! warm up.
//!
//! One regressor more beside the terms of the basis: x, the position of a row in its run from -1/2 to
//! 1/2, or x times the fitted value. With the fit's orthonormal columns Q, residual e and x' = x - Q Q'x the
//! change over the run is b = x'e / x'x', its standard error s / |x'|, s2 = (e'e - b2 x'x') / (n - p - 1).
//! In the order of a grid x is nearly a term of the throttles: |x'| is small against |x|, and any lack of
//! fit looks like a drift. There nothing can be told.

use mixer_compiler::airframe::Basis;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::placed::{Placed, channels, places};
use crate::bench::read::ROTOR_CELLS;
use crate::fit::Design;
use crate::statistics::{dot, greatest};

/// Least |t| that is significant, and the chance at which as large a one is noise of few rows.
const CERTAIN: f64 = 5.0;
const CHANCE: f64 = 1e-4;

/// Least change over the run that matters, as a share of the greatest value.
const MATTERS: f64 = 0.01;

/// Least share of x that the throttles must leave unexplained: |x'|2 / |x|2.
const OWN: f64 = 0.2;

/// How a value changes over the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DriftKind {
    /// By a constant: the zero of a load cell.
    Offset,
    /// By a share of it: a scale, a voltage, a temperature.
    Scale,
}

/// The drift that explains most of what a fit leaves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Of which kind.
    pub kind: DriftKind,
    /// Change from the first row to the last: in the value's unit, or as a share of it.
    pub change: f64,
    /// The change over its standard error.
    pub t: f64,
    /// Greatest change of any row, as a share of the greatest value.
    pub share: f64,
    /// Whether it is larger than chance and matters.
    pub significant: bool,
}

impl Drift {
    /// The drift of `y` over the rows of a run; none where their order cannot show one.
    pub fn of(design: &Design, y: &[f64]) -> Option<Drift> {
        let freedom = y.len().checked_sub(design.centred.basis.exponents().len() + 1)?;
        let x: Vec<f64> = (0..y.len())
            .map(|k| k as f64 / (y.len() as f64 - 1.0) - 0.5)
            .collect();
        let own = |x: &[f64]| design.residuals(x, &design.coordinates(x));
        if freedom == 0 || dot(&own(&x), &own(&x)) < OWN * dot(&x, &x) {
            return None;
        }
        let e = own(y);
        let fitted: Vec<f64> = y.iter().zip(&e).map(|(y, e)| y - e).collect();
        let scaled = x.iter().zip(&fitted).map(|(x, f)| x * f).collect();
        let tried = [
            (DriftKind::Offset, x, 1.0),
            (DriftKind::Scale, scaled, greatest(&fitted)),
        ];
        let drifts = tried.map(|(kind, x, most)| {
            let own = own(&x);
            let size = dot(&own, &own);
            let change = dot(&own, &e) / size;
            let sigma = ((dot(&e, &e) - change * change * size).max(0.0) / freedom as f64).sqrt();
            let (t, share) = (change * size.sqrt() / sigma, (change * most / greatest(y)).abs());
            Drift {
                kind,
                change,
                t,
                share,
                significant: t.abs() > certain(freedom) && share > MATTERS,
            }
        });
        drifts.into_iter().max_by(|a, b| a.t.abs().total_cmp(&b.t.abs()))
    }

    fn in_words(&self, file: &str, of: &str, unit: &str) -> String {
        let (change, t, share) = (self.change, self.t, 100.0 * self.share);
        let (how, mend) = match self.kind {
            DriftKind::Offset => (
                format!("by {change:+.4} {unit}"),
                "load cells that hold their zero, and measuring again in the order of cargo mixer plan",
            ),
            DriftKind::Scale => (
                format!("in scale by {:+.1} %", 100.0 * change),
                "a supply of one voltage, or its column with --voltage-exponent; else measuring again in the order of cargo mixer plan",
            ),
        };
        format!(
            "{file}: the {of} drifts with the order of the rows {how} from the first to the last (t = {t:.1}), {share:.1} % of the \
             greatest: {mend}"
        )
    }

    /// `y` as it would be without the drift, from the run's beginning on.
    pub fn taken_off(&self, y: &[f64]) -> Vec<f64> {
        let last = y.len() as f64 - 1.0;
        let rows = y.iter().enumerate().map(|(k, y)| {
            let by = self.change * k as f64 / last;
            match self.kind {
                DriftKind::Offset => y - by,
                DriftKind::Scale => y / (1.0 + by),
            }
        });
        rows.collect()
    }
}

/// One quantity of a file, and the drift that the order of the rows shows of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// The file.
    pub file: String,
    /// `thrust`, `torque`, or that of one rotor's load cell.
    pub of: &'static str,
    /// The drift; none where the order cannot show one.
    pub drift: Option<Drift>,
}

impl Shown {
    /// Whether there is a significant drift.
    pub fn is_significant(&self) -> bool {
        self.drift.is_some_and(|drift| drift.significant)
    }
}

/// Drifts of both channels and of each load cell in every file, a run of its own; takes those of the
/// channels that are significant off `points`, by which other causes are judged.
pub(super) fn examine(basis: Basis, points: &mut [Placed], warnings: &mut Vec<String>) -> Vec<Shown> {
    let mut shown = Vec::new();
    for run in points.chunk_by_mut(|a, b| a.file == b.file) {
        let (file, mut both) = (run[0].file, channels(run));
        let design = Design::within_its_points(basis, &places(run)).ok();
        let of = |y: &[f64]| design.as_ref().and_then(|design| Drift::of(design, y));
        for (quantity, (name, unit)) in [("thrust", "N"), ("torque", "N m")].into_iter().enumerate() {
            let whole = of(&both[quantity]);
            let mut all = vec![(name, whole)];
            for cell in [2 * quantity, 2 * quantity + 1] {
                let y: Vec<f64> = run.iter().map(|p| p.cells[cell]).collect();
                if y.iter().all(|y| y.is_finite()) && greatest(&y) > 0.0 {
                    all.push((ROTOR_CELLS[cell], of(&y)));
                }
            }
            let told = all
                .iter()
                .filter_map(|(of, drift)| Some((of, drift.filter(|drift| drift.significant)?)));
            if let Some((of, drift)) = told.max_by(|(_, a), (_, b)| a.t.abs().total_cmp(&b.t.abs())) {
                warnings.push(drift.in_words(file, of, unit));
            }
            if let Some(drift) = whole.filter(|drift| drift.significant) {
                both[quantity] = drift.taken_off(&both[quantity]);
            }
            let file = || file.to_owned();
            shown.extend(all.into_iter().map(|(of, drift)| Shown {
                file: file(),
                of,
                drift,
            }));
        }
        for (k, point) in run.iter_mut().enumerate() {
            (point.thrust, point.torque) = (both[0][k], both[1][k]);
        }
    }
    shown
}

fn certain(freedom: usize) -> f64 {
    let t =
        StudentsT::new(0.0, 1.0, freedom as f64).map_or(f64::INFINITY, |t| t.inverse_cdf(1.0 - 0.5 * CHANCE));
    t.max(CERTAIN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::basis::ThrottleBox;
    use crate::plan::plan;

    /// Thrust of a pair with noise, drifted by `change` of (row of the run, thrust).
    fn found(points: &[[f64; 2]], change: impl Fn(f64, f64) -> f64) -> Option<Drift> {
        let noise = |k: usize| ((k * 7919 + 13) % 101) as f64 / 101.0 - 0.5;
        let last = points.len() as f64 - 1.0;
        let y = points.iter().enumerate().map(|(k, [u, l])| {
            let thrust = 12.0 * u * u + 9.0 * l * l + 2.0 * u * l + 0.1 * noise(k);
            change(k as f64 / last, thrust)
        });
        let design = Design::new(Basis::Cubic, points, ThrottleBox { min: 0.1, max: 1.0 }).expect("a design");
        Drift::of(&design, &y.collect::<Vec<f64>>())
    }

    #[test]
    fn the_plans_order_shows_a_drift_of_either_kind_and_a_grids_none() {
        for levels in 5..=10 {
            let points = plan(levels, 0.1, 1.0);
            let clean = found(&points, |_, f| f).expect("a plan");
            assert!(!clean.significant, "{levels}: {clean:?}");
            let offset = found(&points, |x, f| f + 1.5 * x).expect("a plan");
            assert!(
                offset.significant && (offset.change - 1.5).abs() < 0.2,
                "{levels}: {offset:?}"
            );
            let scale = found(&points, |x, f| f * (1.0 - 0.08 * x)).expect("a plan");
            assert_eq!(
                (scale.significant, scale.kind),
                (true, DriftKind::Scale),
                "{levels}: {scale:?}"
            );
            let mut grid = points;
            grid.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
            assert_eq!(found(&grid, |x, f| f + 1.5 * x), None, "{levels}");
        }
    }

    #[test]
    fn a_drift_that_is_taken_off_leaves_the_values_of_the_beginning() {
        let drift = |kind, change| Drift {
            kind,
            change,
            t: 9.0,
            share: 0.1,
            significant: true,
        };
        assert_eq!(
            drift(DriftKind::Offset, 1.0).taken_off(&[2.0, 3.0, 4.0]),
            [2.0, 2.5, 3.0]
        );
        assert_eq!(
            drift(DriftKind::Scale, -0.5).taken_off(&[2.0, 3.0, 4.0]),
            [2.0, 4.0, 8.0]
        );
    }
}
