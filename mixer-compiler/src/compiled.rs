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

/// The fields are the project's own: with the feature `unstable` they are public.
macro_rules! compiled {
    ($visibility:vis) => {
        /// A compiled airframe: what emission and reports read.
        #[derive(Clone, Debug)]
        pub struct Compiled {
            /// The airframe file.
            $visibility source: Source,
            /// The checked model.
            $visibility airframe: Airframe,
            /// M and M+.
            $visibility effectiveness: Effectiveness,
            /// The forward map of a unit at the reference voltage.
            $visibility pair: PairMap,
            /// Proof that the forward map can be inverted.
            $visibility injectivity: Injectivity,
            /// Least idle at which the forward map can be inverted.
            $visibility least_idle: f64,
            /// The chosen evaluator.
            $visibility evaluator: Evaluator,
            /// Largest errors observed of the evaluator's tables.
            $visibility residual: Residual,
            /// Least and largest thrust that is delivered without torque at the reference voltage, N.
            $visibility thrust_range_n: [f32; 2],
            /// Proven bounds of the evaluator's errors.
            $visibility certificate: Certificate,
            /// Share of the attainable set's area that the sides of the closed form lose, or why the airframe
            /// has no closed form.
            $visibility lost_between_sides: Result<f64, &'static str>,
            /// What is emitted.
            $visibility tables: MixerTables,
        }
    };
}

#[cfg(feature = "unstable")]
compiled!(pub);
#[cfg(not(feature = "unstable"))]
compiled!(pub(crate));

impl Compiled {
    /// The name in the airframe file.
    pub fn name(&self) -> &str {
        &self.airframe.name
    }

    /// Output channels: two per unit.
    pub fn channels(&self) -> usize {
        2 * self.airframe.units.len()
    }

    /// Least and largest thrust that is delivered without torque at the reference voltage, N.
    pub fn thrust_range_n(&self) -> [f32; 2] {
        self.thrust_range_n
    }

    /// What thrust and torque of a unit may miss at any voltage and density of the ranges, `[N, N m]`: proven.
    pub fn bounds(&self) -> [f64; 2] {
        self.certificate.stated
    }
}
