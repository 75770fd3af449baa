//! What the emitted inverse misses, over a dense grid of the whole attainable set.
//!
//! The tables are run through `mixer-rt` itself in f32; the forward map that judges them is the
//! file's, in f64. This observes: it rejects evaluators at little cost, and it tells the proof how
//! sharp a bound can be. A proof that contradicted it would be wrong.

use crate::model::PairMap;
use crate::tables::UnitMap;

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
    pub(crate) fn over_set(pair: &PairMap, map: &UnitMap) -> Self {
        let mut points = pair.grid(GRID);
        points.extend(pair.border(EDGE));
        Self::over(pair, map, &points)
    }

    /// A first look that rejects most evaluators.
    pub(crate) fn coarse_check(pair: &PairMap, map: &UnitMap) -> Self {
        Self::over(pair, map, &pair.grid(COARSE_GRID))
    }

    fn over(pair: &PairMap, map: &UnitMap, points: &[[f64; 2]]) -> Self {
        let mut residual = Residual {
            efforts: [0.0; 2],
            at: [[0.0; 2]; 2],
            points: 0,
        };
        for &throttles in points {
            residual.look(pair, map, throttles);
        }
        residual
    }

    /// Looks at the efforts of one more pair of throttles.
    pub(crate) fn look(&mut self, pair: &PairMap, map: &UnitMap, throttles: [f64; 2]) {
        let efforts = pair.efforts(throttles);
        let asked = efforts.map(|effort| effort as f32);
        let found = map.throttles(asked);
        let given = pair.efforts(found.map(f64::from));
        self.points += 1;
        for k in 0..2 {
            let missed = (given[k] - efforts[k]).abs();
            if missed > self.efforts[k] {
                self.efforts[k] = missed;
                self.at[k] = throttles;
            }
        }
    }

    /// The residual in units of the tolerance.
    pub(crate) fn ratio(&self, tolerance: [f64; 2]) -> f64 {
        (self.efforts[0] / tolerance[0]).max(self.efforts[1] / tolerance[1])
    }
}
