//! The battery: voltage falls with the charge that is drawn and, by the internal resistance, with
//! the current.
//!
//! A 4S pack of 5 Ah. V = V_full - slope * charge - R I; a rotor's current goes with the cube of
//! its throttle, as aerodynamic power goes with the cube of the speed. Hover takes some 16 A, 250
//! W: 80 W per kilogram, which is usual for this class. None of these figures is in the paper. Both
//! mixers measure the voltage alike and correct for it by the same law, the airframe's.

use nalgebra::SVector;

use crate::vehicle::ROTORS;

/// Voltage of the full pack without load, V.
const FULL_V: f64 = 16.6;

/// Fall of the voltage without load per charge drawn, V/(A h): 2.6 V over 5 A h.
const SLOPE_V_PER_AH: f64 = 0.52;

/// Internal resistance with cables, ohm.
const RESISTANCE_OHM: f64 = 0.025;

/// Current of one rotor at full throttle, A.
const FULL_THROTTLE_A: f64 = 19.0;

/// Current of the pack at effective throttles in [0, 1], A.
pub fn current_a(throttle: &SVector<f64, ROTORS>) -> f64 {
    throttle.map(|d| FULL_THROTTLE_A * d * d * d).sum()
}

/// Voltage under load after `charge_ah` has been drawn, V.
pub fn voltage_v(charge_ah: f64, throttle: &SVector<f64, ROTORS>) -> f64 {
    FULL_V - SLOPE_V_PER_AH * charge_ah - RESISTANCE_OHM * current_a(throttle)
}
