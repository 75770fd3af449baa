//! Table II: errors of position tracking, and their statistics over seeds.

use nalgebra::Vector3;

use crate::flight::{Flight, FlightPair, Sample};
use crate::manoeuvre::{HIGH_PHASE_S, HOVER_S};
use crate::mixer::Method;
use crate::state::wrapped;
use crate::vehicle::WEIGHT_N;

/// Errors over the columns x, y, z: x and y over the whole manoeuvre, z over the 1.5 m phase
/// (section V-B).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingError {
    /// Mean squared error, m2.
    pub mse: Vector3<f64>,
    /// Mean absolute error, m.
    pub mae: Vector3<f64>,
    /// Maximum absolute error, m.
    pub max: Vector3<f64>,
}

impl TrackingError {
    /// Rows of Table II.
    pub const NAMES: [&'static str; 3] = ["MSE", "MAE", "MaxAE"];

    /// The rows as [`TrackingError::NAMES`] has them.
    pub fn rows(&self) -> [Vector3<f64>; 3] {
        [self.mse, self.mae, self.max]
    }
}

/// Table II of the paper, coaxial mixer.
pub const PAPER_COAXIAL: TrackingError = TrackingError {
    mse: Vector3::new(1.6e-3, 0.7e-3, 0.5e-3),
    mae: Vector3::new(0.028, 0.020, 0.019),
    max: Vector3::new(0.130, 0.078, 0.062),
};

/// Table II of the paper, conventional mixer.
pub const PAPER_CONVENTIONAL: TrackingError = TrackingError {
    mse: Vector3::new(2.9e-3, 1.8e-3, 1.1e-3),
    mae: Vector3::new(0.039, 0.029, 0.026),
    max: Vector3::new(0.144, 0.156, 0.080),
};

impl Flight {
    /// The errors of this flight.
    pub fn tracking_error(&self) -> TrackingError {
        let errors = [0, 1, 2].map(|axis| -> Vec<f64> {
            let counts = |sample: &&Sample| axis < 2 || HIGH_PHASE_S.contains(&sample.time_s);
            let error = |sample: &Sample| (sample.reference.position - sample.position)[axis].abs();
            self.samples.iter().filter(counts).map(error).collect()
        });
        let over = |of: fn(&[f64]) -> f64| errors.each_ref().map(|errors| of(errors)).into();
        TrackingError {
            mse: over(|errors| mean(errors.iter().map(|e| e * e))),
            mae: over(|errors| mean(errors.iter().copied())),
            max: over(|errors| errors.iter().copied().fold(0.0, f64::max)),
        }
    }

    /// Mean absolute yaw error over the manoeuvre, rad.
    pub fn yaw_error(&self) -> f64 {
        let error = |sample: &Sample| wrapped(sample.reference.yaw - sample.yaw).abs();
        mean(self.samples.iter().map(error))
    }

    /// Mean commanded thrust over weight in the first hover (Fig. 10): 1 if the mixer delivers what
    /// is asked.
    pub fn hover_thrust(&self) -> f64 {
        let is_hover = |sample: &&Sample| HOVER_S.contains(&sample.time_s);
        let hover = self.samples.iter().filter(is_hover);
        mean(hover.map(|sample| sample.command.w / WEIGHT_N))
    }

    /// Periods in which the mixer could not deliver.
    pub fn saturated(&self) -> usize {
        self.samples.iter().filter(|sample| sample.saturated).count()
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    sum / count
}

/// Mean and standard deviation over seeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of a sample, 0 for one seed.
    pub deviation: f64,
}

impl Spread {
    /// Mean and deviation of `values`; NaN of none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.into_iter().collect();
        let mean = mean(values.iter().copied());
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        let freedom = values.len().saturating_sub(1).max(1);
        Spread {
            mean,
            deviation: (squares / freedom as f64).sqrt(),
        }
    }
}

/// One figure of Table II over the seeds: `row` as in [`TrackingError::NAMES`], `axis` 0 to 2.
pub fn figure(flights: &[FlightPair], method: Method, row: usize, axis: usize) -> Spread {
    let of = |pair: &FlightPair| pair.with(method).tracking_error().rows()[row][axis];
    Spread::of(flights.iter().map(of))
}

/// The ratio coaxial over conventional of one figure: taken seed by seed, then averaged.
pub fn ratio(flights: &[FlightPair], row: usize, axis: usize) -> Spread {
    let of = |flight: &Flight| flight.tracking_error().rows()[row][axis];
    let ratios = flights
        .iter()
        .map(|pair| of(&pair.coaxial) / of(&pair.conventional));
    Spread::of(ratios)
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn spread_is_mean_and_deviation() {
        let spread = Spread::of([1.0, 2.0, 3.0]);
        assert_eq!((spread.mean, spread.deviation), (2.0, 1.0));
        assert_eq!(Spread::of([4.0]).deviation, 0.0);
    }
}
