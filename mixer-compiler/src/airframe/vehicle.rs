//! `[vehicle]`: what the units carry.

use crate::diagnostic::{Code, number};
use crate::spec::Fields;
use crate::spec::keys::{Range, ValueKind, keys};

keys! { TABLE = "[vehicle]":
    MASS_KG "mass_kg" = "3.2", ValueKind::Number(Range::UpTo(1e4)),
        "Take-off mass, kg.".required()
        .refusing("expected kilograms", "the take-off mass, battery and payload included");
    INERTIA_KG_M2 "inertia_kg_m2" = "[0.080, 0.087, 0.160]", ValueKind::Numbers([3, 3]),
        "Moments of inertia about the forward, right and down axes, kg m2, for simulators.";
    ROTOR_INERTIA "rotor_inertia_kg_m2" = "0.0003", ValueKind::Number(Range::UpTo(MOST_ROTOR_INERTIA)),
        "Moment of inertia of one rotor with its motor's bell about its axis, kg m2, for simulators; estimated from the largest thrust without it."
        .refusing("not a propeller's inertia", "a propeller of 10 inch has about 0.00005 kg m2, one of 16 inch 0.0004, one of 28 inch 0.003");
}

/// Largest inertia of a rotor, kg m2: some ten times that of a propeller of 40 inch.
const MOST_ROTOR_INERTIA: f64 = 0.2;

/// Standard gravity, m/s^2.
pub const GRAVITY: f64 = 9.806_65;

/// `[vehicle]`
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Vehicle {
    /// Mass with battery and payload, kg, above 0, at most 1e4.
    pub mass_kg: f64,
    /// Moments of inertia about the forward, right and down axes, kg m^2, each above 0; `None` where
    /// the file does not have them.
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// Moment of inertia of one rotor with its motor's bell, kg m2, above 0, at most 0.2; `None` where the file does not
    /// have it.
    pub rotor_inertia_kg_m2: Option<f64>,
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Vehicle> {
    let inertia_kg_m2 = inertia(table);
    let rotor_inertia_kg_m2 = table.number(&ROTOR_INERTIA);
    Some(Vehicle {
        mass_kg: table.number(&MASS_KG)?,
        inertia_kg_m2,
        rotor_inertia_kg_m2,
    })
}

fn inertia(table: &mut Fields<'_, '_>) -> Option<[f64; 3]> {
    let moments = table.array(&INERTIA_KG_M2)?;
    let Some(wrong) = moments.iter().find(|moment| **moment <= 0.0) else {
        return Some(moments);
    };
    let message = format!(
        "a moment of inertia of {} in `vehicle.inertia_kg_m2` is not positive",
        number(*wrong)
    );
    let help = "the moments about the forward, right and down axes, in kg m2; leave the key out where they are not known";
    table.refuse(&INERTIA_KG_M2, Code::OutOfRange, message, "must be above 0", help)
}
