//! The result of a compilation.

use crate::airframe::Airframe;
use crate::desaturation::attainable::AreaLoss;
use crate::diagnostic::Diagnostics;
use crate::inverse::evaluator::Evaluator;
use crate::model::effectiveness::Effectiveness;
use crate::model::injectivity::Injectivity;
use crate::proof::Certificate;
use crate::proof::residual::Residual;
use crate::tables::MixerTables;

/// A compiled airframe: what emission and reports read.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The source's name, as its user knows it.
    pub source_name: String,
    /// The checked model.
    pub airframe: Airframe,
    /// M and M+.
    pub effectiveness: Effectiveness,
    /// That the forward map can be inverted.
    pub injectivity: Injectivity,
    /// The least idle at which it can.
    pub least_idle: f64,
    /// The chosen evaluator.
    pub evaluator: Evaluator,
    /// What it was observed to miss.
    pub residual: Residual,
    /// Least and largest thrust that is delivered without torque at the reference voltage, N.
    pub thrust_range_n: [f32; 2],
    /// What it is proven to miss at most.
    pub certificate: Certificate,
    /// Share of the attainable set's area that the polygon of the general path loses.
    pub lost_area: AreaLoss,
    /// Share of it that the sides of the closed form lose; `None` without a closed form.
    pub lost_between_sides: Option<f64>,
    /// What is emitted.
    pub tables: MixerTables,
    /// What is plausibly a mistake and yet compiles.
    pub warnings: Diagnostics,
}
