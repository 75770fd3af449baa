//! The mixer that the paper compares with (section V): rotors as if each stood alone.
//!
//! Every rotor gives the upper one's thrust in free air, f(d, 0), and a torque Q = kappa f against its spin, kappa by
//! least squares through the origin over the throttle range. The wrench is then linear in the 2n thrusts; the least
//! norm of them that gives it is pseudo-inverted, and each thrust becomes a throttle by the one-dimensional map, limited to
//! the range. What these throttles really give is the business of the pair's map.

use mixer_compiler::Compiled;
use mixer_compiler::model::PairMap;
use nalgebra::{DMatrix, DVector};

/// The conventional mixer of an airframe.
#[derive(Clone, Debug)]
pub struct Conventional {
    alone: PairMap,
    kappa_m: f64,
    /// 2n x 4: thrusts of all upper rotors, then of all lower ones, per `[roll, pitch, yaw, thrust]`.
    allocation: DMatrix<f64>,
    units: usize,
}

/// Throttles at which kappa is fitted.
const POINTS: usize = 51;

/// Singular values below this share of the largest count as zero, as in the compiler.
const RANK_TOLERANCE: f64 = 1e-6;

impl Conventional {
    /// The conventional mixer of `compiled`, serving the same axes.
    pub fn new(compiled: &Compiled) -> Self {
        let airframe = &compiled.airframe;
        let alone = PairMap::new(&airframe.pair, &airframe.throttle);
        let [low, high] = alone.range();
        let (products, squares) = (0..POINTS)
            .map(|k| alone.efforts([low + (high - low) * k as f64 / (POINTS - 1) as f64, 0.0]))
            .fold((0.0, 0.0), |(products, squares), [f, q]| {
                (products + q.abs() * f, squares + f * f)
            });
        let kappa_m = products / squares;

        let n = airframe.units.len();
        let m = &compiled.effectiveness.matrix;
        // The upper rotor's torque counts negative (the pair's is positive where the lower one outweighs it).
        let column = |rotor: usize, axis: usize| {
            let (sign, unit) = if rotor < n {
                (-1.0, rotor)
            } else {
                (1.0, rotor - n)
            };
            m[(axis, unit)] + sign * kappa_m * m[(axis, n + unit)]
        };
        let served: Vec<usize> = airframe
            .allocation
            .axes
            .iter()
            .map(|&axis| axis as usize)
            .collect();
        let rows = DMatrix::from_fn(served.len(), 2 * n, |row, rotor| column(rotor, served[row]));
        let svd = rows.svd(true, true);
        let threshold = RANK_TOLERANCE * svd.singular_values.max();
        let mut allocation = DMatrix::zeros(2 * n, 4);
        // Both factors were asked for, so there is a pseudo-inverse.
        if let Ok(inverse) = svd.pseudo_inverse(threshold) {
            for (k, &axis) in served.iter().enumerate() {
                allocation.set_column(axis, &inverse.column(k));
            }
        }
        Conventional {
            alone,
            kappa_m,
            allocation,
            units: n,
        }
    }

    /// kappa = Q / f of one rotor, m.
    pub fn kappa_m(&self) -> f64 {
        self.kappa_m
    }

    /// Throttles `[u, l]` of every unit for `[roll, pitch, yaw (N m), thrust (N)]` at the reference voltage, and whether
    /// none had to be limited.
    pub fn throttles(&self, wrench: [f64; 4]) -> (Vec<[f64; 2]>, bool) {
        let thrusts = &self.allocation * DVector::from_row_slice(&wrench);
        let mut free = true;
        let mut throttle = |thrust: f64| {
            let (value, within) = self.isolated(thrust);
            free &= within;
            value
        };
        let throttles = (0..self.units)
            .map(|i| [throttle(thrusts[i]), throttle(thrusts[self.units + i])])
            .collect();
        (throttles, free)
    }

    /// d with f(d, 0) = `thrust` (N) by bisection, limited to the range, and whether it lay within.
    fn isolated(&self, thrust: f64) -> (f64, bool) {
        let [low, high] = self.alone.range();
        let gives = |d: f64| self.alone.efforts([d, 0.0])[0];
        if thrust <= gives(low) {
            return (low, thrust == gives(low));
        }
        if thrust >= gives(high) {
            return (high, thrust == gives(high));
        }
        let (mut below, mut above) = (low, high);
        for _ in 0..60 {
            let middle = 0.5 * (below + above);
            if gives(middle) < thrust {
                below = middle;
            } else {
                above = middle;
            }
        }
        (0.5 * (below + above), true)
    }
}
