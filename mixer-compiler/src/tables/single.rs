//! What a rotor gives alone, rounded.

use mixer_rt::tables::SingleRotor;

use crate::airframe::{Airframe, Basis, RotorAlone};

/// Rounds what the upper and the lower rotor give alone: as declared, else the pair's polynomials
/// with the other throttle at zero, so that the runtime has one form for both.
pub(super) fn single_tables(airframe: &Airframe) -> [SingleRotor; 2] {
    let pair = &airframe.pair;
    let table = |declared: &Option<RotorAlone>, exponents: fn(u8) -> (u8, u8)| {
        let [thrust, torque] = match declared {
            Some(alone) => return curve_table(alone),
            None => [&pair.thrust_n, &pair.torque_nm].map(|c| along(pair.basis, c, exponents)),
        };
        rounded(thrust, torque)
    };
    [
        table(&pair.lower_out, |power| (power, 0)),
        table(&pair.upper_out, |power| (0, power)),
    ]
}

/// Rounds a curve.
pub(super) fn curve_table(curve: &RotorAlone) -> SingleRotor {
    let [thrust, torque] = [&curve.thrust_n, &curve.torque_nm].map(|[a1, a2, a3]| [0.0, *a3, *a2, *a1]);
    rounded(thrust, torque)
}

fn rounded(thrust: [f64; 4], torque: [f64; 4]) -> SingleRotor {
    SingleRotor {
        thrust: thrust.map(|c| c as f32),
        torque: torque.map(|c| c as f32),
    }
}

/// The coefficients of one throttle's powers, from the fourth down.
fn along(basis: Basis, coefficients: &[f64], exponents: fn(u8) -> (u8, u8)) -> [f64; 4] {
    [4, 3, 2, 1].map(|power| {
        let mut terms = basis.exponents().iter().zip(coefficients);
        let term = terms.find(|(exponent, _)| **exponent == exponents(power));
        term.map_or(0.0, |(_, &coefficient)| coefficient)
    })
}
