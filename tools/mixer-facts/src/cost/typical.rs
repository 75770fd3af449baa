//! The instructions of a mix that delivers its request: about
//!
//! ```text
//! per mix + n (per unit + evaluator) + PER_CORRECTION for each of voltage and density that is corrected for
//! ```
//!
//! The inverse maps are counted on their own ([`mixer_compiler::evaluator::Evaluator::instructions`]). The overheads are
//! rounded from the counts of whole mixers in `docs/costs.md`; a test holds the sum to these counts,
//! within the errors stated.

use mixer_compiler::Compiled;

/// Instructions beside the evaluators'.
struct Overhead {
    /// Checks, voltage, allocation.
    per_mix: u32,
    /// Allocation, channels, the achieved wrench.
    per_unit: u32,
    /// Largest error of the sum, as a share of what was counted.
    error: f64,
}

const PER_CORRECTION: u32 = 50;

/// The pair of a unit looked up among several.
const PER_KIND: u32 = 35;

/// Least norm with single rotors beside that of pairs, and one of these in it.
const WITH_SINGLE_ROTORS: u32 = 300;
const PER_SINGLE: u32 = 950;

/// Requests that least norm delivers: the median over attainable ones.
const CLOSED_FORM: Overhead = Overhead {
    per_mix: 100,
    per_unit: 100,
    error: 0.12,
};
const GENERAL: Overhead = Overhead {
    per_mix: 130,
    per_unit: 122,
    error: 0.05,
};

/// The mean over attainable requests, some of which least norm does not deliver. In closed form only:
/// beyond it the share of these depends on the frame.
const CLOSED_FORM_MEAN: Overhead = Overhead {
    per_mix: 65,
    per_unit: 160,
    error: 0.13,
};

/// Instructions, and the largest error of this number as a share.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    pub(super) instructions: u32,
    pub(super) error: f64,
}

/// A request that least norm delivers; `None` for an evaluator that has not been counted.
pub(super) fn delivered(compiled: &Compiled) -> Option<Estimate> {
    let overhead = if compiled.tables.closed_form.is_some() {
        CLOSED_FORM
    } else {
        GENERAL
    };
    overhead.estimate(compiled)
}

/// The mean over attainable requests; `None` where it depends on the frame too much.
pub(super) fn attainable(compiled: &Compiled) -> Option<Estimate> {
    compiled.tables.closed_form.as_ref()?;
    CLOSED_FORM_MEAN.estimate(compiled)
}

impl Overhead {
    fn estimate(&self, compiled: &Compiled) -> Option<Estimate> {
        let airframe = &compiled.airframe;
        let single = airframe.single_units() as u32;
        let singles = match single {
            0 => 0,
            _ => WITH_SINGLE_ROTORS + single * PER_SINGLE,
        };
        let corrections = airframe.voltage.iter().chain(&airframe.air).count() as u32;
        let kind = if airframe.is_unlike() { PER_KIND } else { 0 };
        let pair = match compiled.inverse() {
            Some((evaluator, basis)) => self.per_unit + evaluator.instructions(basis)? + kind,
            None => 0,
        };
        Some(Estimate {
            instructions: self.per_mix
                + airframe.pair_units() as u32 * pair
                + singles
                + PER_CORRECTION * corrections,
            error: self.error,
        })
    }
}
