//! The vehicle that the units carry.

use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// Standard gravity, m/s^2.
pub const GRAVITY: f64 = 9.806_65;

/// Heaviest vehicle, kg.
const HEAVIEST_KG: f64 = 1e4;

/// `[vehicle]`
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Vehicle {
    /// Mass with battery and payload, kg, above 0, at most 1e4.
    pub mass_kg: f64,
}

pub(super) fn check(vehicle: &spec::Vehicle, faults: &mut Vec<Diagnostic>) -> Option<Vehicle> {
    let field = vehicle.mass_kg.as_ref()?;
    let mass_kg = *field.get_ref();
    if mass_kg > 0.0 && mass_kg <= HEAVIEST_KG {
        return Some(Vehicle { mass_kg });
    }
    faults.push(
        Diagnostic::new(
            Code::OutOfRange,
            "vehicle.mass_kg",
            field.span(),
            format!(
                "`vehicle.mass_kg` = {} is not above 0 and at most {}",
                number(mass_kg),
                number(HEAVIEST_KG)
            ),
        )
        .label("expected kilograms")
        .help("the take-off mass, battery and payload included"),
    );
    None
}
