//! `[vehicle]`: what the units carry.

use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec::keys::{Kind, Range, keys};
use crate::spec::{Fields, Spanned, Triple};

keys! { TABLE = "[vehicle]":
    MASS_KG "mass_kg" = "3.2", Kind::Number(Range::UpTo(1e4)),
        "Take-off mass, kg.".required()
        .refusing("expected kilograms", "the take-off mass, battery and payload included");
    INERTIA_KG_M2 "inertia_kg_m2" = "[0.080, 0.087, 0.160]", Kind::Numbers([3, 3]),
        "Moments of inertia about the forward, right and down axes, kg m2, for simulators.";
}

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
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Vehicle> {
    let inertia = table.read(&INERTIA_KG_M2);
    Some(Vehicle {
        inertia_kg_m2: inertia.and_then(|field| inertia_kg_m2(&field, table.faults)),
        mass_kg: table.number(&MASS_KG)?,
    })
}

fn inertia_kg_m2(field: &Spanned<Triple>, faults: &mut Vec<Diagnostic>) -> Option<[f64; 3]> {
    let moments = field.get_ref();
    let Some(wrong) = moments.iter().find(|moment| *moment.get_ref() <= 0.0) else {
        return Some(moments.each_ref().map(|moment| *moment.get_ref()));
    };
    let (key, moment) = ("vehicle.inertia_kg_m2", number(*wrong.get_ref()));
    let message = format!("a moment of inertia of {moment} in `{key}` is not positive");
    faults.push(
        Diagnostic::new(Code::OutOfRange, key, wrong.span(), message)
            .label("must be above 0")
            .help("the moments about the forward, right and down axes, in kg m2; leave the key out where they are not known"),
    );
    None
}
