//! What a rotor gives alone, rounded.

use mixer_rt::tables;

use crate::airframe::{Pair, RotorAlone};
use crate::model::PairMap;

/// Rounds what the upper and the lower rotor give alone: as declared, else the pair's polynomials
/// with the other throttle at zero, so that the runtime has one form for both.
pub(super) fn rotors_alone(pair: &Pair, map: &PairMap) -> [tables::RotorAlone; 2] {
    let declared = [&pair.lower_out, &pair.upper_out];
    [0, 1].map(|side| match declared[side] {
        Some(alone) => curve_table(alone),
        None => rounded(map.along(side)),
    })
}

/// Rounds a curve.
pub(super) fn curve_table(curve: &RotorAlone) -> tables::RotorAlone {
    let of = |power: usize| [curve.thrust_n[power - 1], curve.torque_nm[power - 1]];
    rounded([[0.0; 2], of(3), of(2), of(1)])
}

fn rounded(terms: [[f64; 2]; 4]) -> tables::RotorAlone {
    tables::RotorAlone {
        thrust: terms.map(|[f, _]| f as f32),
        torque: terms.map(|[_, q]| q as f32),
    }
}
