//! The vehicle that the units carry.

use toml::Spanned;

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
    /// Moments of inertia about the forward, right and down axes, kg m^2, each above 0; `None` where
    /// the file does not have them.
    pub inertia_kg_m2: Option<[f64; 3]>,
}

pub(super) fn check(vehicle: &spec::Vehicle, faults: &mut Vec<Diagnostic>) -> Option<Vehicle> {
    let mass_kg = vehicle.mass_kg.as_ref().and_then(|field| mass(field, faults));
    let inertia_kg_m2 = vehicle.inertia_kg_m2.as_ref().map(|field| inertia(field, faults));
    Some(Vehicle {
        mass_kg: mass_kg?,
        inertia_kg_m2: inertia_kg_m2.map_or(Some(None), |checked| checked.map(Some))?,
    })
}

fn mass(field: &Spanned<f64>, faults: &mut Vec<Diagnostic>) -> Option<f64> {
    let mass_kg = *field.get_ref();
    if mass_kg > 0.0 && mass_kg <= HEAVIEST_KG {
        return Some(mass_kg);
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

fn inertia(field: &Spanned<spec::Triple>, faults: &mut Vec<Diagnostic>) -> Option<[f64; 3]> {
    let moments = field.get_ref();
    let Some(wrong) = moments.iter().find(|moment| *moment.get_ref() <= 0.0) else {
        return Some(moments.each_ref().map(|moment| *moment.get_ref()));
    };
    let key = "vehicle.inertia_kg_m2";
    let message = format!(
        "a moment of inertia of {} in `{key}` is not positive",
        number(*wrong.get_ref())
    );
    faults.push(
        Diagnostic::new(Code::OutOfRange, key, wrong.span(), message)
            .label("must be above 0")
            .help("the moments about the forward, right and down axes, in kg m2; leave the key out where they are not known"),
    );
    None
}
