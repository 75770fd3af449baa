//! The result of a compilation.

use crate::airframe::{Airframe, Basis};
use crate::diagnostic::source::Source;
use crate::dynamics::Dynamics;
use crate::inverse::evaluator::Evaluator;
use crate::model::effectiveness::Effectiveness;
use crate::model::injectivity::Injectivity;
use crate::model::{PairMap, Physics};
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
            /// The forward map of each unit at the reference voltage.
            $visibility maps: Vec<PairMap>,
            /// What is known of each pair, in the order of the file.
            $visibility of_pairs: Vec<OfPair>,
            /// Least and largest thrust that is delivered without torque at the reference voltage, N.
            $visibility thrust_range_n: [f32; 2],
            /// What thrust and torque of any unit may miss at any voltage and density of the ranges, N and N m.
            $visibility stated: [f64; 2],
            /// Share of the attainable set's area that the sides of the closed form lose, or why the airframe
            /// has no closed form.
            $visibility lost_outside_border: Result<f64, &'static str>,
            /// How the rotors of each kind of unit follow their throttles; `None` where `mix_dynamic` is not proven.
            $visibility dynamics: Option<Vec<Dynamics>>,
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
        self.stated
    }

    /// What throttles give by the airframe file alone.
    pub fn physics(&self) -> Physics<'_> {
        Physics {
            airframe: &self.airframe,
            maps: &self.maps,
        }
    }

    /// How pairs are inverted, and their basis; `None` where no unit is one.
    pub fn inverse(&self) -> Option<(Evaluator, Basis)> {
        let evaluator = self.of_pairs.first()?.evaluator;
        Some((evaluator, self.airframe.pairs.first()?.basis))
    }

    /// What holds of all pairs; `None` where no unit is one.
    pub fn of_all_pairs(&self) -> Option<OfPair> {
        let (first, others) = self.of_pairs.split_first()?;
        Some(others.iter().fold(first.clone(), OfPair::and))
    }
}

/// What is known of a pair.
#[derive(Clone, Debug)]
pub struct OfPair {
    /// Proof that the forward map can be inverted.
    pub injectivity: Injectivity,
    /// Least idle at which it can be.
    pub least_idle: f64,
    /// The chosen evaluator, the same of all pairs.
    pub evaluator: Evaluator,
    /// Largest errors observed of the evaluator's tables.
    pub residual: Residual,
    /// Proven bounds of the evaluator's errors.
    pub certificate: Certificate,
}

impl OfPair {
    /// What holds of another pair, too.
    fn and(mut self, other: &OfPair) -> OfPair {
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
        self
    }
}
