//! How far a map may be from its pair, `[pair.uncertainty]`.

use std::fmt;

use serde::Serialize;

/// One standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Uncertainty {
    /// Of thrust, % of full scale.
    pub thrust_percent: f64,
    /// Of torque, % of full scale.
    pub torque_percent: f64,
}

impl Uncertainty {
    /// Rounded to a tenth, up, at least 0.1 %: an airframe file takes no zero.
    pub fn rounded(thrust_percent: f64, torque_percent: f64) -> Self {
        let tenths = |x: f64| ((10.0 * x - 1e-9).ceil() / 10.0).clamp(0.1, 100.0);
        Uncertainty {
            thrust_percent: tenths(thrust_percent),
            torque_percent: tenths(torque_percent),
        }
    }
}

/// The table of the airframe file.
impl fmt::Display for Uncertainty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "[pair.uncertainty]                     # one standard deviation, % of full scale\n\
             thrust_percent = {:?}\ntorque_percent = {:?}",
            self.thrust_percent, self.torque_percent
        )
    }
}
