//! What the user decides about a fit.

use mixer_compiler::airframe::Basis;

use crate::fit::basis::ThrottleBox;
use crate::rotor::single::RunFacts;

/// What the user decides about the fit.
#[derive(Debug, Clone, Default)]
pub struct FitOptions {
    /// The basis, or nothing to choose by cross-validation.
    pub basis: Option<Basis>,
    /// Leave out the rows that stand out.
    pub robust: bool,
    /// The box to command, or nothing for the measured one.
    pub throttle: Option<ThrottleBox>,
    /// Reference voltage, V, or nothing for the mean of the rows.
    pub reference_v: Option<f64>,
    /// Declared exponents of thrust and of torque, or nothing to identify them.
    pub voltage_exponent: Option<[f64; 2]>,
    /// Whether a throttle commands a speed that the controller holds, whatever the voltage.
    pub closed_loop: bool,
    /// Voltage of the empty and of the full pack, V, or nothing for what the bench had.
    pub pack_v: Option<[f64; 2]>,
    /// What is known of the run of one rotor beside its file.
    pub run: RunFacts,
    /// The name of that rotor.
    pub name: Option<String>,
}
