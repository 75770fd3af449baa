//! The ISAE-SUPAERO X8: its airframe file, and what section V-B of the paper and this simulation
//! add to it.

use mixer_compiler::Source;
use mixer_compiler::airframe::Airframe;
use mixer_compiler::diagnostic::Diagnostics;
use nalgebra::Vector3;

mixer_macros::airframe!("../../airframes/isae-x8.toml");

/// The airframe file that the mixer's tables come from.
const AIRFRAME_FILE: &str = include_str!("../../../airframes/isae-x8.toml");

/// Number of rotors.
pub const ROTORS: usize = 8;

/// Units of two rotors.
pub const UNITS: usize = ROTORS / 2;

/// Mass, kg (section V-B).
pub const MASS_KG: f64 = 3.2;

/// Principal moments of inertia about x, y, z, kg m2 (section V-B).
pub const INERTIA_KG_M2: Vector3<f64> = Vector3::new(0.0797, 0.0874, 0.1604);

/// Standard gravity, m/s2.
pub const GRAVITY_M_S2: f64 = 9.80665;

/// Weight, N: the thrust that hover takes.
pub const WEIGHT_N: f64 = MASS_KG * GRAVITY_M_S2;

/// Lag of a rotor in hover, s. The paper gives none; 0.05 s is usual for 10 inch propellers.
pub const ROTOR_LAG_S: f64 = 0.05;

/// What of a vehicle is not in the map of its rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Principal moments of inertia about x, y, z, kg m2.
    pub inertia_kg_m2: Vector3<f64>,
    /// Lag of a rotor in hover at the reference voltage, s: with the motor's share of loss, that is the rotor's inertia.
    pub rotor_lag_s: f64,
}

/// Mass, inertia and rotor lag of the paper's vehicle.
pub const BODY: Body = Body {
    mass_kg: MASS_KG,
    inertia_kg_m2: INERTIA_KG_M2,
    rotor_lag_s: ROTOR_LAG_S,
};

/// Reads the airframe file in f64: the plant's model of the rotors.
///
/// # Errors
/// What is wrong with the file. The macro above has compiled it, so nothing is.
pub fn airframe() -> Result<Airframe, Diagnostics> {
    Airframe::read(&Source::new("airframes/isae-x8.toml", AIRFRAME_FILE))
}
