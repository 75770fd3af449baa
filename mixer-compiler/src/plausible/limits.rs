//! What is refused because its size is absurd: tolerances, and the authority of the rotors.

use mixer_rt::tables::REQUEST_LIMIT;

use crate::airframe::{Airframe, Axis};
use crate::diagnostic::{Code, Diagnostic, number, rounded};
use crate::model::effectiveness::Effectiveness;
use crate::model::{PairMap, voltage};

/// Share of a unit's largest effort above which a tolerance is refused. The evaluators are fitted to
/// the tolerance; nothing is left to fit to here.
const ABSURD: f64 = 0.1;

/// A tolerance beside what it is of.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    pub(super) key: &'static str,
    unit: &'static str,
    pub(super) stated: f64,
    /// A unit's largest effort.
    pub(super) largest: f64,
}

/// Those of thrust and torque, of units of this scale.
pub(super) fn tolerances(airframe: &Airframe, scale: [f64; 2]) -> [Tolerance; 2] {
    let inverse = &airframe.inverse;
    let of = |key, unit, stated, largest| Tolerance {
        key,
        unit,
        stated,
        largest,
    };
    [
        of(
            "inverse.thrust_tolerance_n",
            "N",
            inverse.thrust_tolerance_n,
            scale[0],
        ),
        of(
            "inverse.torque_tolerance_nm",
            "N m",
            inverse.torque_tolerance_nm,
            scale[1],
        ),
    ]
}

impl Tolerance {
    /// Whether the file states a tolerance above a tenth of the largest effort.
    pub(super) fn is_absurd(&self, airframe: &Airframe) -> bool {
        self.largest > 0.0 && self.stated > ABSURD * self.largest && airframe.states(self.key)
    }

    /// Message, label and help where it is above this share of the largest effort.
    pub(super) fn words(&self, most: f64) -> [String; 3] {
        let unit = self.unit;
        // A percentage beyond the largest float is written as a bound.
        let percent = match 100.0 * (self.stated / self.largest) {
            percent if percent.is_finite() => format!("{} %", rounded(percent)),
            _ => "more than 1e308 %".to_owned(),
        };
        [
            format!(
                "a tolerance of {} {unit} is {percent} of a unit's largest effort, {} {unit}",
                number(self.stated),
                rounded(self.largest)
            ),
            format!("expected at most {} %", number(100.0 * most)),
            "the defaults are 0.01 N and 0.0001 N m".to_owned(),
        ]
    }
}

/// Refuses tolerances that are too wide to mean anything.
///
/// # Errors
/// A tolerance above a tenth of a unit's largest effort.
pub(crate) fn check_tolerances(airframe: &Airframe, pair: &PairMap) -> Result<(), Vec<Diagnostic>> {
    let faults: Vec<Diagnostic> = tolerances(airframe, pair.scale())
        .into_iter()
        .filter(|tolerance| tolerance.is_absurd(airframe))
        .map(|tolerance| {
            let [message, label, help] = tolerance.words(ABSURD);
            airframe.diagnostic(Code::ToleranceAbsurd, tolerance.key, message, label, help)
        })
        .collect();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Refuses rotors that give more of an axis, at the voltage where they give most, than requests are
/// limited to: what is beyond would be attainable and never be given.
///
/// # Errors
/// The first such axis.
pub(crate) fn check_authority(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
) -> Result<(), Vec<Diagnostic>> {
    let limit = f64::from(REQUEST_LIMIT);
    let (scale, factors) = (pair.scale(), voltage::largest_factors(airframe));
    let efforts = [0, 1].map(|k| factors[k] * scale[k]);
    let most = |axis: Axis| effectiveness.largest(axis as usize, efforts);
    let Some(axis) = Axis::ALL.into_iter().rev().find(|axis| most(*axis) > limit) else {
        return Ok(());
    };
    let unit = if axis == Axis::Thrust { "N" } else { "N m" };
    let key = if axis == Axis::Yaw {
        "pair.torque_nm"
    } else {
        "pair.thrust_n"
    };
    Err(vec![airframe.diagnostic(
        Code::Authority,
        key,
        format!(
            "the rotors give {} {unit} of {axis}; requests are limited to {} {unit}",
            rounded(most(axis)),
            number(limit)
        ),
        "",
        "expected thrusts in newtons, torques in newton metres and positions in metres",
    )])
}
