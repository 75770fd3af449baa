//! What the emitted inverse misses, over a dense grid of the whole attainable set.
//!
//! The tables are run through `mixer-rt` itself in f32; the forward map that judges them is the file's, in f64.
//! This observes; the proof over all efforts takes this stage's place in the pipeline when it exists, with the
//! same inputs and outputs.

use mixer_rt::Inverse;

use crate::model::PairMap;
use crate::tables::MixerTables;

/// The largest residual |forward(inverse(f, Q)) - (f, Q)| of one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Of thrust, N, and of torque, N m, at the reference voltage.
    pub efforts: [f64; 2],
    /// Throttles `[u, l]` at which each was met.
    pub at: [[f64; 2]; 2],
    /// Number of points looked at.
    pub points: usize,
}

/// Points per side of the grid over the throttle box.
const GRID: usize = 65;

/// Points per edge of the throttle box.
const EDGE: usize = 256;

/// Points per side of the first, coarse look.
const COARSE_GRID: usize = 15;

impl Residual {
    /// Over the whole set, all edges included.
    pub fn over_set(pair: &PairMap, tables: &MixerTables) -> Self {
        let mut points = pair.grid(GRID);
        points.extend(pair.border(EDGE));
        Self::over(pair, tables, &points)
    }

    /// A first look that rejects most evaluators.
    pub fn at_a_glance(pair: &PairMap, tables: &MixerTables) -> Self {
        Self::over(pair, tables, &pair.grid(COARSE_GRID))
    }

    fn over(pair: &PairMap, tables: &MixerTables, points: &[[f64; 2]]) -> Self {
        let mut residual = Residual {
            efforts: [0.0; 2],
            at: [[0.0; 2]; 2],
            points: points.len(),
        };
        for &throttles in points {
            let efforts = pair.efforts(throttles);
            let asked = efforts.map(|effort| effort as f32);
            let found = (&tables.inverse).throttles(&tables.pair, &tables.throttle, asked);
            let given = pair.efforts(found.map(f64::from));
            // The runtime judges by its own forward map: its rounding counts too.
            let seen = tables.pair.efforts(found);
            for k in 0..2 {
                let missed = (given[k] - efforts[k])
                    .abs()
                    .max(f64::from(seen[k] - asked[k]).abs());
                if missed > residual.efforts[k] {
                    residual.efforts[k] = missed;
                    residual.at[k] = throttles;
                }
            }
        }
        residual
    }

    /// True where no residual is above `tolerance` (`[N, N m]`).
    pub fn within(&self, tolerance: [f64; 2]) -> bool {
        self.efforts[0] <= tolerance[0] && self.efforts[1] <= tolerance[1]
    }

    /// The residual in units of the tolerance.
    pub fn ratio(&self, tolerance: [f64; 2]) -> f64 {
        (self.efforts[0] / tolerance[0]).max(self.efforts[1] / tolerance[1])
    }
}
