//! `[[rotor]]`: a single rotor, which has no partner on its mast.

use super::rotor_alone::{self, RotorAlone, Whose};
use super::throttle::Throttle;
use super::uncertainty::{self, Uncertainty};
use crate::spec::keys::{ValueKind, keys};
use crate::spec::{Fields, Spanned};

keys! { TABLE = "[[rotor]]":
    NAME "name" = "\"tail\"", ValueKind::Text,
        "The name by which a unit has it.".required();
    THRUST_N "thrust_n" = "[0.2, 14.1, -1.7]", ValueKind::Numbers([3, 3]),
        "Thrust at the reference voltage, N: a1, a2, a3 of a1 x + a2 x2 + a3 x3 in the throttle x.".required();
    TORQUE_NM "torque_nm" = "[0.01, 0.2, -0.02]", ValueKind::Numbers([3, 3]),
        "Torque likewise, N m, positive whichever way it turns.".required();
    UNCERTAINTY "uncertainty" = "", ValueKind::Table(&uncertainty::TABLE),
        "How far the model of the rotor may be from the rotor.";
}

const WHOSE: Whose = Whose {
    keys: [&THRUST_N, &TORQUE_NM],
    what: "a single rotor",
    sign: 1.0,
    torque_help: "the size of the torque counts; `upper_spin` of the unit says which way it turns",
};

/// A kind of single rotor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SingleRotor {
    /// The name by which units have it.
    pub name: String,
    /// Its thrust and torque; the torque is positive.
    pub alone: RotorAlone,
    /// Error of the model; `None` where the file has no `[rotor.uncertainty]`.
    pub uncertainty: Option<Uncertainty>,
}

pub(super) fn read(table: &mut Fields<'_, '_>, throttle: Option<&Throttle>) -> Option<SingleRotor> {
    let name = table.read::<String>(&NAME).map(Spanned::into_inner);
    let alone = rotor_alone::read(table, &WHOSE, throttle);
    let uncertainty = table.table(&UNCERTAINTY, uncertainty::read);
    Some(SingleRotor {
        name: name?,
        alone: alone?,
        uncertainty: uncertainty.flatten(),
    })
}
