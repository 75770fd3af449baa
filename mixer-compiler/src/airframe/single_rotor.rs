//! `[[rotor]]`: a single rotor, which has no partner on its mast.

use super::basis::Basis;
use super::pair::{Pair, Spin};
use super::rotor_alone::{self, RotorAlone, Whose};
use super::throttle::Throttle;
use crate::spec::keys::{ValueKind, keys};
use crate::spec::{Fields, Spanned};

keys! { TABLE = "[[rotor]]":
    NAME "name" = "\"tail\"", ValueKind::Text,
        "The name by which a unit has it.".required();
    THRUST_N "thrust_n" = "[0.2, 14.1, -1.7]", ValueKind::Numbers([3, 3]),
        "Thrust at the reference voltage, N: a1, a2, a3 of a1 x + a2 x2 + a3 x3 in the throttle x.".required();
    TORQUE_NM "torque_nm" = "[0.01, 0.2, -0.02]", ValueKind::Numbers([3, 3]),
        "Torque likewise, N m, positive whichever way it turns.".required();
}

const WHOSE: Whose = Whose {
    keys: [&THRUST_N, &TORQUE_NM],
    what: "a single rotor",
    sign: 1.0,
    torque_help: "the size of the torque counts; `upper_spin` of the unit says which way it turns",
};

/// A single rotor as a pair whose lower rotor never turns, with the torque of an upper one.
pub(super) fn read(table: &mut Fields<'_, '_>, throttle: Option<&Throttle>) -> Option<Pair> {
    let name = table.read::<String>(&NAME).map(Spanned::into_inner);
    let mut curve = rotor_alone::read(table, &WHOSE, throttle)?;
    curve.torque_nm = curve.torque_nm.map(|term| -term);
    let terms = |[a1, a2, a3]: [f64; 3]| vec![a3, 0.0, 0.0, 0.0, a2, 0.0, 0.0, a1, 0.0];
    Some(Pair {
        name: name?,
        basis: Basis::Cubic,
        thrust_n: terms(curve.thrust_n),
        torque_nm: terms(curve.torque_nm),
        upper_spin: Spin::Cw,
        lower_is_stronger: false,
        lower_out: Some(curve),
        upper_out: None,
        power: None,
        uncertainty: None,
        borrowed_from: String::new(),
        bench_options: Vec::new(),
        bench_v: None,
    })
}

/// Two of a single rotor as a pair without a wake between them.
pub(super) fn two_of(rotor: &Pair) -> Option<Pair> {
    let upper = rotor.lower_out.clone()?;
    let lower = RotorAlone {
        torque_nm: upper.torque_nm.map(|term| -term),
        ..upper.clone()
    };
    let terms = |[u1, u2, u3]: [f64; 3], [l1, l2, l3]: [f64; 3]| vec![u3, 0.0, 0.0, l3, u2, 0.0, l2, u1, l1];
    Some(Pair {
        thrust_n: terms(upper.thrust_n, lower.thrust_n),
        torque_nm: terms(upper.torque_nm, lower.torque_nm),
        upper_out: Some(lower),
        ..rotor.clone()
    })
}

/// Torque over thrust of a single rotor at half of its largest thrust, m: what M+ takes for its share.
pub(crate) fn torque_per_thrust(curve: &RotorAlone, throttle: &Throttle) -> f64 {
    let [most, _] = curve.efforts(throttle.max);
    let [f, q] = curve.efforts(throttle_of(curve, throttle, 0.5 * most));
    q / f
}

/// The throttle of a thrust, N, by bisection within the range.
pub(crate) fn throttle_of(curve: &RotorAlone, throttle: &Throttle, thrust_n: f64) -> f64 {
    const HALVINGS: usize = 60;
    let [mut low, mut high] = [throttle.min, throttle.max];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if curve.efforts(middle)[0] > thrust_n {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}
