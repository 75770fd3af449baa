//! What fits are judged on.

use std::cell::OnceCell;

use crate::model::PairMap;

/// One throttle pair with its efforts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) throttles: [f64; 2],
    pub(super) efforts: [f64; 2],
}

/// Samples with all that fits ask of them.
#[derive(Debug)]
pub(super) struct Sampled {
    pub(super) samples: Vec<Sample>,
    /// Squares of [`weights`] with an emphasis, once they are needed.
    emphasised: OnceCell<(f64, Vec<f64>)>,
}

impl Sampled {
    pub(super) fn new(pair: &PairMap, points: usize, next_to_a_fold: bool) -> Self {
        let grid = match next_to_a_fold {
            true => pair.edge_grid(points),
            false => pair.grid(points),
        };
        Sampled {
            samples: samples(pair, grid),
            emphasised: OnceCell::new(),
        }
    }

    /// First weights of a fit whose errors count by det J to the power `-emphasis`; one emphasis
    /// other than 0 is remembered.
    pub(super) fn weights(&self, pair: &PairMap, emphasis: f64) -> Vec<f64> {
        let squared = || {
            let weights = weights(pair, &self.samples, emphasis);
            weights.iter().map(|weight| weight * weight).collect()
        };
        if emphasis == 0.0 {
            return vec![1.0; self.samples.len()];
        }
        let (known, weights) = self.emphasised.get_or_init(|| (emphasis, squared()));
        if *known == emphasis {
            weights.clone()
        } else {
            squared()
        }
    }
}

/// Samples at these throttles.
pub(super) fn samples(pair: &PairMap, throttles: Vec<[f64; 2]>) -> Vec<Sample> {
    let throttles = throttles.into_iter();
    throttles
        .map(|throttles| Sample {
            throttles,
            efforts: pair.efforts(throttles),
        })
        .collect()
}

/// True where det J falls to a small share of its mean.
pub(super) fn next_to_a_fold(pair: &PairMap) -> bool {
    const SHARE: f64 = 0.03;
    const GRID: usize = 11;
    let determinants = pair.grid(GRID).into_iter().map(|throttles| {
        let [[f_u, f_l], [q_u, q_l]] = pair.jacobian(throttles);
        f_u * q_l - f_l * q_u
    });
    let (least, sum) = determinants.fold((f64::INFINITY, 0.0), |(least, sum), determinant| {
        (determinant.min(least), sum + determinant)
    });
    least < SHARE * sum / (GRID * GRID) as f64
}

/// Weights of errors: a power of det J over its mean, bounded where det J vanishes.
pub(super) fn weights(pair: &PairMap, samples: &[Sample], emphasis: f64) -> Vec<f64> {
    const FLOOR: f64 = 0.003;
    if emphasis == 0.0 {
        return vec![1.0; samples.len()];
    }
    let determinant = |sample: &Sample| {
        let [[f_u, f_l], [q_u, q_l]] = pair.jacobian(sample.throttles);
        (f_u * q_l - f_l * q_u).max(0.0)
    };
    let determinants: Vec<f64> = samples.iter().map(determinant).collect();
    let mean = determinants.iter().sum::<f64>() / determinants.len() as f64;
    determinants
        .iter()
        .map(|determinant| libm::pow(mean / (determinant + FLOOR * mean), emphasis))
        .collect()
}
