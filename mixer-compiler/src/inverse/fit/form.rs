//! A seed's terms in its coordinates.

use super::{Coordinates, FittedInverse, Sample};
use crate::inverse::evaluator::{Refinement, SeedForm};

/// A seed in its coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) coordinates: Coordinates,
    pub(super) offset: [f64; 2],
    pub(super) seed: SeedForm,
}

impl Form {
    /// In these coordinates; for a table they are stretched so that its knots cover the samples.
    pub(super) fn new(coordinates: Coordinates, seed: SeedForm, samples: &[Sample]) -> Self {
        if seed != SeedForm::Table {
            return Form {
                coordinates,
                offset: [0.0; 2],
                seed,
            };
        }
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for sample in samples {
            for (range, x) in range.iter_mut().zip(coordinates.at(sample.efforts)) {
                *range = [range[0].min(x), range[1].max(x)];
            }
        }
        let stretch = range.map(|[low, high]| 3.0 / (high - low));
        let stretched = |factors: [f64; 3], by: f64| factors.map(|factor| factor * by * by);
        Form {
            coordinates: Coordinates {
                x: stretched(coordinates.x, stretch[0]),
                y: stretched(coordinates.y, stretch[1]),
            },
            offset: [0, 1].map(|k| -range[k][0] * stretch[k]),
            seed,
        }
    }

    /// The terms at every sample.
    pub(super) fn rows(&self, samples: &[Sample]) -> Vec<Vec<f64>> {
        let row = |sample: &Sample| {
            let [x, y] = self.coordinates.at(sample.efforts);
            self.seed.row(x + self.offset[0], y + self.offset[1])
        };
        samples.iter().map(row).collect()
    }

    /// Second differences of a table's knots.
    pub(super) fn smooth(&self) -> Vec<Vec<f64>> {
        if self.seed != SeedForm::Table {
            return Vec::new();
        }
        let mut rows = Vec::new();
        for line in 0..4 {
            for (start, step) in [(4 * line, 1), (line, 4)] {
                for first in [start, start + step] {
                    let mut row = vec![0.0; 16];
                    for (place, share) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
                        row[first + place * step] = share;
                    }
                    rows.push(row);
                }
            }
        }
        rows
    }

    pub(super) fn fitted(&self, refinement: Refinement, coefficients: [Vec<f64>; 2]) -> FittedInverse {
        let (steps, residuals) = refinement.steps();
        FittedInverse::Seeded {
            seed: self.seed,
            steps,
            residuals,
            coordinates: self.coordinates,
            offset: self.offset,
            coefficients,
        }
    }
}
