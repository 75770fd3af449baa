//! `[[rotor]]`: a single rotor, which has no partner on its mast.

use super::correction;
use super::measured::{self, Measured};
use super::rotor_alone::{self, RotorAlone, Whose};
use super::throttle::Throttle;
use super::uncertainty;
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
    BENCH_V "bench_v" = "[13.96, 14.9]", ValueKind::Numbers([2, 2]),
        "As that of a pair.";
    VOLTAGE "voltage" = "", ValueKind::Table(&correction::VOLTAGE_TABLE),
        "Law of its own bench, which brings it to the frame's reference.";
    AIR "air" = "", ValueKind::Table(&correction::AIR_TABLE),
        "Likewise of the density.";
}

const WHOSE: Whose = Whose {
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
    /// How it was measured.
    pub measured: Measured,
}

pub(super) fn read(table: &mut Fields<'_, '_>, throttle: Option<&Throttle>) -> Option<SingleRotor> {
    let name = table.read::<String>(&NAME).map(Spanned::into_inner);
    let alone = rotor_alone::read(table, &WHOSE, throttle);
    let measured = measured::read(table, [&UNCERTAINTY, &BENCH_V, &VOLTAGE, &AIR]);
    Some(SingleRotor {
        name: name?,
        alone: alone?,
        measured,
    })
}
