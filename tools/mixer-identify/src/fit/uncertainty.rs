//! How far a map may be from its pair, `[pair.uncertainty]`.

use serde::Serialize;
use toml_edit::{Item, value};

use crate::table::table;

/// One standard deviation of the exponent of the voltage that a motor with its propeller has, about the typical one:
/// 1.48 times the median deviation of 102 motors that were measured at two voltages
/// (github.com/StrawsonDesign/motor_propeller_testing).
pub(crate) const EXPONENT_DEVIATION: f64 = 0.093;

/// Thrust of a map over its greatest, rms over the throttles; torque likewise.
const RMS_OF_FULL: f64 = 0.5;

/// What an error of the exponent by its deviation adds to a map whose rows are brought from one voltage to another, rms
/// over the throttles, % of full scale.
pub(crate) fn by_voltage(deviation: f64, from_v: f64, to_v: f64) -> f64 {
    100.0 * RMS_OF_FULL * deviation * libm::log(to_v / from_v).abs()
}

/// One standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Uncertainty {
    /// Of thrust, % of full scale.
    pub thrust_percent: f64,
    /// Of torque, % of full scale.
    pub torque_percent: f64,
    /// Whether the map was predicted from one rotor instead of measured.
    #[serde(skip)]
    pub is_predicted: bool,
}

impl Uncertainty {
    /// Rounded to a tenth, up, at least 0.1 %: an airframe file takes no zero.
    pub fn rounded(thrust_percent: f64, torque_percent: f64) -> Self {
        let tenths = |x: f64| ((10.0 * x - 1e-9).ceil() / 10.0).clamp(0.1, 100.0);
        Uncertainty {
            thrust_percent: tenths(thrust_percent),
            torque_percent: tenths(torque_percent),
            is_predicted: false,
        }
    }

    /// With independent errors `[thrust, torque]`, % of full scale.
    pub(crate) fn with(self, added: [f64; 2]) -> Self {
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

    /// The table of the airframe file.
    pub(crate) fn table(&self) -> Item {
        let mut entries = vec![
            ("thrust_percent", value(self.thrust_percent)),
            ("torque_percent", value(self.torque_percent)),
        ];
        if self.is_predicted {
            entries.push(("source", value("prediction")));
        }
        table("# One standard deviation, % of full scale.\n", entries)
    }
}
