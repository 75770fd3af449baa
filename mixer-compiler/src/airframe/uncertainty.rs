//! `[pair.uncertainty]`, `[rotor.uncertainty]`: how far the model may be from what it is of.

use serde::Serialize;

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

/// One standard deviation of the exponent of the voltage that a motor with its propeller has, about the typical one:
/// 1.48 times the median deviation of 102 motors that were measured at two voltages
/// (github.com/StrawsonDesign/motor_propeller_testing).
pub const EXPONENT_DEVIATION: f64 = 0.093;

/// Thrust of a map over its greatest, rms over the throttles; torque likewise.
const RMS_OF_FULL: f64 = 0.5;

/// What an error of the exponent by its deviation adds to a map that is brought from one voltage, or density, to another,
/// rms over the throttles, % of full scale.
pub fn by_voltage(deviation: f64, from: f64, to: f64) -> f64 {
    100.0 * RMS_OF_FULL * deviation * libm::log(to / from).abs()
}

/// `[pair.uncertainty]` or `[rotor.uncertainty]`: one standard deviation of the model's error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Uncertainty {
    /// Of the thrust, % of full scale, above 0, at most 100.
    pub thrust_percent: f64,
    /// Of the torque, % of full scale, above 0, at most 100.
    pub torque_percent: f64,
    /// Whether the pair was predicted from one rotor instead of measured.
    #[serde(skip)]
    pub is_predicted: bool,
}

impl Uncertainty {
    /// Of a measurement, rounded to a tenth, up, at least 0.1 %: an airframe file takes no zero.
    pub fn rounded(thrust_percent: f64, torque_percent: f64) -> Self {
        let tenths = |x: f64| ((10.0 * x - 1e-9).ceil() / 10.0).clamp(0.1, 100.0);
        Uncertainty {
            thrust_percent: tenths(thrust_percent),
            torque_percent: tenths(torque_percent),
            is_predicted: false,
        }
    }

    /// With independent errors `[thrust, torque]`, % of full scale.
    #[must_use]
    pub fn with(self, added: [f64; 2]) -> Self {
        if added == [0.0; 2] {
            return self;
        }
        let sum = |own: f64, added: f64| (own * own + added * added).sqrt();
        Uncertainty {
            is_predicted: self.is_predicted,
            ..Uncertainty::rounded(
                sum(self.thrust_percent, added[0]),
                sum(self.torque_percent, added[1]),
            )
        }
    }

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
