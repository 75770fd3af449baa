//! `[pair.uncertainty]`, `[rotor.uncertainty]`: how far the model may be from what it is of.

use crate::spec::Fields;
use crate::spec::keys::{Range, ValueKind, keys};

const PERCENT: ValueKind = ValueKind::Number(Range::UpTo(100.0));
const LABEL: &str = "expected per cent of full scale";
const HELP: &str = "one standard deviation; leave the table out where it is not known";

keys! { TABLE = "[pair.uncertainty]":
    THRUST_PERCENT "thrust_percent" = "1.5", PERCENT,
        "Standard deviation of the thrust, % of the thrust at full throttle.".required().refusing(LABEL, HELP);
    TORQUE_PERCENT "torque_percent" = "3.7", PERCENT,
        "Standard deviation of the torque, % of the largest torque.".required().refusing(LABEL, HELP);
    SOURCE "source" = "\"prediction\"", ValueKind::Word(&["bench", "prediction"]),
        "Whether it was measured, or a pair was predicted from one rotor; bench without it.";
}

/// `[pair.uncertainty]` or `[rotor.uncertainty]`: one standard deviation of the model's error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Uncertainty {
    /// Of the thrust, % of full scale, above 0, at most 100.
    pub thrust_percent: f64,
    /// Of the torque, % of full scale, above 0, at most 100.
    pub torque_percent: f64,
    /// Whether the pair was predicted from one rotor instead of measured.
    pub is_predicted: bool,
}

impl Uncertainty {
    /// `predicted` or `measured`.
    pub fn source(&self) -> &'static str {
        if self.is_predicted {
            "predicted"
        } else {
            "measured"
        }
    }
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Uncertainty> {
    let [thrust, torque] = [&THRUST_PERCENT, &TORQUE_PERCENT].map(|key| table.number(key));
    let is_predicted = table.word(&SOURCE, &[false, true]);
    Some(Uncertainty {
        thrust_percent: thrust?,
        torque_percent: torque?,
        is_predicted: is_predicted.unwrap_or(false),
    })
}
