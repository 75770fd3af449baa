//! How far a map may be from its pair, `[pair.uncertainty]`.

use serde::Serialize;
use toml_edit::{Item, value};

use crate::table::table;

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
