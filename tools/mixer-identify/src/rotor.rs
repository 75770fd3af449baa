//! One rotor alone: which of the pair it is, and its curves.

use serde::Serialize;

pub mod agreement;
pub mod alone;
pub mod curve;
pub mod interaction;
pub mod posterior;
pub mod predict;
pub mod single;

/// Which rotor turns, and the names of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Turning {
    /// The upper one: `--lower-out`.
    Upper,
    /// The lower one: `--upper-out`.
    Lower,
}

impl Turning {
    /// The key of its table in `[pair]`.
    pub fn key(self) -> &'static str {
        self.table().trim_start_matches("pair.")
    }

    /// The table of the airframe file.
    pub fn table(self) -> &'static str {
        match self {
            Turning::Upper => "pair.lower_out",
            Turning::Lower => "pair.upper_out",
        }
    }

    pub(crate) fn words(self) -> [&'static str; 3] {
        match self {
            Turning::Upper => ["--lower-out", "upper", "lower"],
            Turning::Lower => ["--upper-out", "lower", "upper"],
        }
    }

    /// Throttles of the upper and the lower rotor as those of this rotor and the other one, and the
    /// other way round.
    pub(crate) fn in_order(self, [first, second]: [f64; 2]) -> [f64; 2] {
        match self {
            Turning::Upper => [first, second],
            Turning::Lower => [second, first],
        }
    }

    /// The pair's throttles with the other rotor at rest.
    pub(crate) fn throttles(self, x: f64) -> [f64; 2] {
        self.in_order([x, 0.0])
    }

    /// The sign of its torque in the airframe file.
    pub(crate) fn sign(self) -> f64 {
        if self == Turning::Upper { -1.0 } else { 1.0 }
    }
}

/// One rotor alone.
#[derive(Debug, Clone, Serialize)]
pub struct Alone {
    /// The run.
    pub file: String,
    /// a1, a2, a3 of thrust, N.
    pub thrust_n: [f64; 3],
    /// a1, a2, a3 of torque, N m.
    pub torque_nm: [f64; 3],
    /// Statistics of thrust.
    pub thrust: AloneFit,
    /// Statistics of torque.
    pub torque: AloneFit,
    /// Measured range of throttle.
    pub measured: [f64; 2],
    /// Points.
    pub points: usize,
}

/// Statistics of one channel, N or N m.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct AloneFit {
    /// Root of the mean squared residual.
    pub residual_rms: f64,
    /// Root of the mean squared leave-one-out error.
    pub leave_one_out_rms: f64,
    /// Root of the mean squared error of the pair's polynomial with the other throttle at zero.
    pub of_the_pair_rms: f64,
    /// Greatest measured size: the scale of percentages.
    pub full_scale: f64,
}
