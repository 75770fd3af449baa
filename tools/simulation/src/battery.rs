//! The battery: voltage falls with the charge that is drawn and, by the internal resistance, with
//! the current.
//!
//! V = V_full - slope * charge - R I; a rotor's current goes with the cube of its speed, as
//! aerodynamic power does.

use nalgebra::SVector;

/// A pack and its rotors' currents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Battery {
    /// Voltage of the full pack without load, V.
    pub full_v: f64,
    /// Fall of the voltage without load per charge drawn, V/(A h).
    pub slope_v_per_ah: f64,
    /// Internal resistance with cables, ohm.
    pub resistance_ohm: f64,
    /// Current of one rotor at full throttle, A.
    pub full_throttle_a: f64,
}

/// Of the paper's vehicle: a 4S pack of 5 Ah over which the voltage falls by 2.6 V. Hover takes
/// some 16 A, 250 W: 80 W per kilogram, which is usual for this class. None of these figures is in
/// the paper. Both mixers measure the voltage alike and correct for it by the same law, the
/// airframe's.
pub const PAPER: Battery = Battery {
    full_v: 16.6,
    slope_v_per_ah: 0.52,
    resistance_ohm: 0.025,
    full_throttle_a: 11.5,
};

impl Battery {
    /// Current of the pack at speeds over those of full throttle, A.
    pub fn current_a<const R: usize>(&self, speed: &SVector<f64, R>) -> f64 {
        speed.map(|w| self.full_throttle_a * w * w * w).sum()
    }

    /// Voltage under load after `charge_ah` has been drawn, V.
    pub fn voltage_v<const R: usize>(&self, charge_ah: f64, speed: &SVector<f64, R>) -> f64 {
        self.full_v - self.slope_v_per_ah * charge_ah - self.resistance_ohm * self.current_a(speed)
    }
}
