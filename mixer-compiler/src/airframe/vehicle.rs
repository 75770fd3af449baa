//! `[vehicle]`: what the units carry.

use crate::diagnostic::{Code, number};
use crate::spec::keys::{Range, ValueKind, keys};
use crate::spec::{Fields, Spanned};

keys! { TABLE = "[vehicle]":
    MASS_KG "mass_kg" = "3.2", ValueKind::Number(Range::UpTo(1e4)),
        "Take-off mass, kg.".required()
        .refusing("expected kilograms", "the take-off mass, battery and payload included");
    INERTIA_KG_M2 "inertia_kg_m2" = "[0.080, 0.087, 0.160]", ValueKind::Numbers([3, 3]),
        "Moments of inertia about the forward, right and down axes, kg m2, for simulators.";
    ROTOR_INERTIA "rotor_inertia_kg_m2" = "0.0003", ValueKind::Number(Range::UpTo(MOST_ROTOR_INERTIA)),
        "Moment of inertia of one rotor with its motor's bell about its axis, kg m2, for simulators; estimated from the largest thrust without it."
        .refusing("not a propeller's inertia", "a propeller of 10 inch has about 0.00005 kg m2, one of 16 inch 0.0004, one of 28 inch 0.003");
    ROTOR_LAG "rotor_lag_s" = "0.06", ValueKind::Number(Range::Within(LAGS_S)),
        "Lag of a rotor's speed in hover, s, of all kinds of units: the time in which it does 63 % of a small step of its throttle; by the inertia without it."
        .refusing("not a rotor's lag", "seconds: 0.03 for propellers of 5 inch, 0.05 for 10 inch, 0.08 for 16 inch, 0.15 for 28 inch, about");
    ROTOR_BRAKES "rotor_brakes" = "false", ValueKind::Flag,
        "Whether the speed controllers brake a rotor that is to turn slower (\"damped light\", complementary PWM); true without it.";
}

/// Largest inertia of a rotor, kg m2: some ten times that of a propeller of 40 inch.
const MOST_ROTOR_INERTIA: f64 = 0.2;

/// Lags of rotors, s.
const LAGS_S: [f64; 2] = [0.001, 2.0];

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
    /// Lag of a rotor's speed in hover, s, 0.001 to 2; `None` where the file does not have it. Not beside an inertia.
    pub rotor_lag_s: Option<f64>,
    /// Whether the speed controllers brake.
    pub rotor_brakes: bool,
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Vehicle> {
    let inertia_kg_m2 = inertia(table);
    let rotor_inertia_kg_m2 = table.number(&ROTOR_INERTIA);
    let rotor_lag_s = table.number(&ROTOR_LAG);
    if rotor_inertia_kg_m2.and(rotor_lag_s).is_some() {
        let message = "`vehicle.rotor_lag_s` and `vehicle.rotor_inertia_kg_m2` say the same".to_owned();
        let help =
            "keep the one that is measured: lag and inertia follow from one another (docs/simulator.md)";
        table.refuse::<()>(
            &ROTOR_LAG,
            Code::Conflict,
            message,
            "a second statement of how rotors follow",
            help,
        );
    }
    let rotor_brakes = table.read::<bool>(&ROTOR_BRAKES);
    Some(Vehicle {
        mass_kg: table.number(&MASS_KG)?,
        inertia_kg_m2,
        rotor_inertia_kg_m2,
        rotor_lag_s,
        rotor_brakes: rotor_brakes.is_none_or(Spanned::into_inner),
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
