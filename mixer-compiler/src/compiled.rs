//! The result of a compilation.

use crate::airframe::Airframe;
use crate::diagnostic::source::Source;
use crate::inverse::evaluator::Evaluator;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;
use crate::model::injectivity::Injectivity;
use crate::proof::Certificate;
use crate::proof::residual::Residual;
use crate::tables::MixerTables;

/// A compiled airframe: what emission and reports read.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The airframe file.
    pub source: Source,
    /// The checked model.
    pub airframe: Airframe,
    /// M and M+.
    pub effectiveness: Effectiveness,
    /// The forward map of a unit at the reference voltage.
    pub pair: PairMap,
    /// Proof that the forward map can be inverted.
    pub injectivity: Injectivity,
    /// Least idle at which the forward map can be inverted.
    pub least_idle: f64,
    /// The chosen evaluator.
    pub evaluator: Evaluator,
    /// Largest errors observed of the evaluator's tables.
    pub residual: Residual,
    /// Least and largest thrust that is delivered without torque at the reference voltage, N.
    pub thrust_range_n: [f32; 2],
    /// Proven bounds of the evaluator's errors.
    pub certificate: Certificate,
    /// Share of the attainable set's area that the sides of the closed form lose, or why the airframe
    /// has no closed form.
    pub lost_between_sides: Result<f64, &'static str>,
    /// What is emitted.
    pub tables: MixerTables,
}
