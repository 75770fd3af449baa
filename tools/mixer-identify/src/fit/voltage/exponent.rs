//! An exponent of one channel, and the rows that it comes from.

use serde::Serialize;

use mixer_compiler::airframe::EXPONENT_DEVIATION;

/// An exponent, or why there is none.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case", tag = "status")]
pub enum Exponent {
    /// A sound estimate.
    Identified(Estimate),
    /// No number: the data cannot give one.
    Refused {
        /// With the numbers that matter.
        reason: String,
        /// What would serve.
        needed: String,
    },
    /// The user's own, by `--voltage-exponent`.
    Declared {
        /// k in (V / Vref)^k.
        exponent: f64,
        /// The exponent that the files themselves give, where it is sound.
        measured: Option<Estimate>,
    },
    /// The channel is in no file.
    NotMeasured,
}

impl Exponent {
    /// k, if it is known.
    pub fn value(&self) -> Option<f64> {
        match self {
            Exponent::Identified(estimate) => Some(estimate.exponent),
            Exponent::Declared { exponent, .. } => Some(*exponent),
            Exponent::Refused { .. } | Exponent::NotMeasured => None,
        }
    }

    /// One standard deviation of k: of an estimate its own, else that of propellers about the typical exponent.
    pub fn deviation(&self) -> f64 {
        const HALF_WIDTHS: f64 = 1.96;
        self.estimate()
            .map_or(EXPONENT_DEVIATION, |estimate| estimate.ci95 / HALF_WIDTHS)
    }

    /// This channel with the user's own exponent.
    #[must_use]
    pub fn declared(&self, exponent: f64) -> Exponent {
        let measured = self.estimate().cloned();
        Exponent::Declared { exponent, measured }
    }

    /// The estimate, if sound.
    pub fn estimate(&self) -> Option<&Estimate> {
        match self {
            Exponent::Identified(estimate) => Some(estimate),
            _ => None,
        }
    }
}

/// A sound exponent.
#[derive(Debug, Clone, Serialize)]
pub struct Estimate {
    /// k in (V / Vref)^k.
    pub exponent: f64,
    /// Half-width of its 95 % interval.
    pub ci95: f64,
    /// `equal throttles` (levels shared by the files) or `joint map` (a polynomial through all of
    /// them).
    pub method: &'static str,
    /// Throttle levels measured at different voltages.
    pub levels: usize,
    /// Relative root-mean-square residual of the rows, percent.
    pub residual_percent: f64,
}

/// A channel's rows at voltage.
pub(super) struct Row {
    pub(super) throttle: [f64; 2],
    pub(super) level: usize,
    pub(super) voltage: f64,
    pub(super) y: f64,
}
