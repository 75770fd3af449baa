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

/// The fields, and what of the airframe only the project's packages ask for, are public with the feature `unstable`.
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

        impl Compiled {
            /// Wrench that one unit of PX4's normalised setpoints asks for at the reference voltage: `SCALE`
            /// of the generated module.
            $visibility fn scale(&self) -> mixer_rt::Wrench {
                self.rotors(self.airframe.reference_v()).px4()
            }

            /// Wrench that one unit of ArduPilot's inputs asks for at the highest voltage of the range, as
            /// there with `MOT_BAT_VOLT_MAX` set to it: `ARDUPILOT_SCALE` of the generated module.
            $visibility fn ardupilot_scale(&self) -> mixer_rt::Wrench {
                self.rotors(self.highest_v()).ardupilot()
            }

            /// What ArduPilot multiplies roll, pitch and yaw by for each motor, 0.5 at most, by channel: its
            /// frame of the same geometry has these factors.
            $visibility fn ardupilot_factors(&self) -> Vec<[f64; 3]> {
                self.rotors(self.airframe.reference_v()).ardupilot_factors()
            }

            /// Torques that PID sums of 1000 ask Betaflight for in hover, at the reference voltage, and the thrust of its full
            /// throttle stick, that of all rotors at the highest voltage: `BETAFLIGHT_SCALE` of the generated module.
            $visibility fn betaflight_scale(&self) -> mixer_rt::Wrench {
                mixer_rt::Wrench {
                    thrust_n: self.ardupilot_scale().thrust_n,
                    ..self.rotors(self.airframe.reference_v()).betaflight()
                }
            }

            /// e of the throttle stick in Betaflight, from 0 to 2: up to 1 the thrust is (1 - e) throttle + e throttle^2 of that of the
            /// full stick, above it (2 - e) throttle^2 + (e - 1) throttle^3, and the stick in hover that of Betaflight's own mixer at the
            /// reference voltage. 1 without `[vehicle] mass_kg`.
            $visibility fn betaflight_expo(&self) -> f64 {
                let full_n = self.betaflight_scale().thrust_n.into();
                self.rotors(self.airframe.reference_v()).betaflight_expo(full_n)
            }

            /// Betaflight's factors of roll, pitch and yaw, in its signs, by channel: `mmix` of the same geometry.
            $visibility fn betaflight_factors(&self) -> Vec<[f64; 3]> {
                self.rotors(self.airframe.reference_v()).betaflight_factors()
            }

            /// PX4's `CA_ROTORn_PX`, `_PY`, `_PZ`, `_AX`, `_AY`, `_AZ`, `_CT` and `_KM`, by channel.
            $visibility fn px4_rotors(&self) -> Vec<[f64; 8]> {
                self.rotors(self.airframe.reference_v()).px4_rotors()
            }

            /// The highest voltage of the range, V; 0 where the airframe has no correction.
            $visibility fn highest_v(&self) -> f64 {
                let voltage = self.airframe.voltage.as_ref();
                voltage.map_or(0.0, |voltage| voltage.range[1])
            }

            /// Throttle of all rotors alike that carries the weight at the reference voltage; `None` without
            /// `[vehicle] mass_kg`, or where none does.
            $visibility fn equal_hover_throttle(&self) -> Option<f64> {
                self.rotors(self.airframe.reference_v()).hover_throttle()
            }

            /// Slope in hover at the reference voltage of the share of the largest thrust over the throttle, both rotors alike: what
            /// a stack's loop gain is multiplied by that takes the one for the other. `None` without a hover.
            $visibility fn slope_in_hover(&self) -> Option<f64> {
                self.rotors(self.airframe.reference_v()).slope_in_hover()
            }

            /// What throttles give by the airframe file alone.
            $visibility fn physics(&self) -> Physics<'_> {
                Physics {
                    airframe: &self.airframe,
                    maps: &self.maps,
                }
            }

            /// How pairs are inverted, and their basis; `None` where no unit is one.
            $visibility fn inverse(&self) -> Option<(Evaluator, Basis)> {
                let evaluator = self.of_pairs.first()?.evaluator;
                Some((evaluator, self.airframe.pairs.first()?.basis))
            }

            /// What holds of all pairs; `None` where no unit is one.
            $visibility fn of_all_pairs(&self) -> Option<OfPair> {
                let (first, others) = self.of_pairs.split_first()?;
                Some(others.iter().fold(first.clone(), OfPair::and))
            }
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
