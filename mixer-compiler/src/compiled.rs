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
            /// The forward map of a unit at the reference voltage: of the first pair, where units differ.
            $visibility pair: PairMap,
            /// Proof that the forward map can be inverted: of the least determinant, where units differ.
            $visibility injectivity: Injectivity,
            /// Least idle at which all forward maps can be inverted.
            $visibility least_idle: f64,
            /// The chosen evaluator, of all units.
            $visibility evaluator: Evaluator,
            /// Largest errors observed of the evaluator's tables, in any unit.
            $visibility residual: Residual,
            /// Least and largest thrust that is delivered without torque at the reference voltage, N.
            $visibility thrust_range_n: [f32; 2],
            /// Proven bounds of the evaluator's errors, in any unit.
            $visibility certificate: Certificate,
            /// What is known of each pair, in the order of the file.
            pub(crate) of_pairs: Vec<OfPair>,
            /// Share of the attainable set's area that the sides of the closed form lose, or why the airframe
            /// has no closed form.
            $visibility lost_outside_border: Result<f64, &'static str>,
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

    /// Output channels: one per rotor.
    pub fn channels(&self) -> usize {
        self.airframe.rotors()
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

/// What is known of a pair.
#[derive(Clone, Debug)]
pub(crate) struct OfPair {
    pub(crate) injectivity: Injectivity,
    pub(crate) least_idle: f64,
    pub(crate) residual: Residual,
    pub(crate) certificate: Certificate,
}

impl OfPair {
    /// Makes this what holds of another pair, too.
    pub(crate) fn include(&mut self, other: &OfPair) {
        if other.injectivity.least_determinant < self.injectivity.least_determinant {
            self.injectivity = other.injectivity;
        }
        self.least_idle = self.least_idle.max(other.least_idle);
        self.residual.points += other.residual.points;
        self.certificate.cells += other.certificate.cells;
        for k in 0..2 {
            let (own, of) = (&mut self.certificate, &other.certificate);
            if of.reference[k] > own.reference[k] {
                own.at[k] = of.at[k];
            }
            own.reference[k] = own.reference[k].max(of.reference[k]);
            own.stated[k] = own.stated[k].max(of.stated[k]);
            self.residual.efforts[k] = self.residual.efforts[k].max(other.residual.efforts[k]);
        }
    }
}

impl Compiled {
    /// The airframe once for each of its pairs, as if all units had that one: for what is said of a pair. M, the range of
    /// thrust and the closed form stay those of the frame.
    #[cfg(feature = "unstable")]
    pub fn of_each_pair(&self) -> Vec<Compiled> {
        let views = self.airframe.of_each_pair().into_iter().zip(&self.of_pairs);
        let view = |(k, (airframe, of)): (usize, (Airframe, &OfPair))| Compiled {
            pair: PairMap::new(&airframe.pair, &airframe.throttle),
            injectivity: of.injectivity,
            least_idle: of.least_idle,
            residual: of.residual,
            certificate: of.certificate,
            of_pairs: vec![of.clone()],
            tables: self.tables.of_pair(k),
            airframe,
            ..self.clone()
        };
        views.enumerate().map(view).collect()
    }
}
