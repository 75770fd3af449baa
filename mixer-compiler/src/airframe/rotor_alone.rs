//! `[pair.lower_out]`, `[pair.upper_out]`: what one rotor of a unit gives alone, the other one at
//! rest.

use super::limits;
use super::throttle::Throttle;
use crate::bounds::bisected;
use crate::diagnostic::{Code, number};
use crate::spec::Fields;
use crate::spec::keys::{Key, Shape, ValueKind, keys};

keys! { LOWER_OUT = "[pair.lower_out]":
    THRUST_N "thrust_n" = "[0.2, 14.1, -1.7]", ValueKind::Numbers([3, 3]),
        "Thrust of the rotor that turns, N: a1, a2, a3 of a1 x + a2 x2 + a3 x3.".required();
    TORQUE_NM "torque_nm" = "[-0.01, -0.2, 0.02]", ValueKind::Numbers([3, 3]),
        "Its torque, N m, signed as that of the pair.".required();
}

pub(super) const UPPER_OUT: Shape = Shape {
    header: "[pair.upper_out]",
    ..LOWER_OUT
};

/// `[pair.lower_out]`, `[pair.upper_out]` or `[[rotor]]`: a1 x + a2 x2 + a3 x3 in the throttle x of the rotor that turns.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RotorAlone {
    /// a1, a2, a3 of the thrust, N; it grows with the throttle over the throttle range.
    pub thrust_n: [f64; 3],
    /// a1, a2, a3 of the torque, N m: at full throttle below 0 for the upper rotor of a pair, above for its lower one and
    /// for a single rotor.
    pub torque_nm: [f64; 3],
}

impl RotorAlone {
    /// One of its quantities as a pair's in the cubic basis, that of the upper rotor.
    pub(crate) fn in_cubic_terms([a1, a2, a3]: [f64; 3]) -> [f64; 9] {
        [a3, 0.0, 0.0, 0.0, a2, 0.0, 0.0, a1, 0.0]
    }

    /// Thrust and torque, each with its index.
    pub(super) fn terms(&mut self) -> [(usize, &mut [f64]); 2] {
        [(0, &mut self.thrust_n), (1, &mut self.torque_nm)]
    }

    /// The efforts `[f, Q]` at the rotor's throttle, N and N m at the reference voltage.
    pub fn efforts(&self, throttle: f64) -> [f64; 2] {
        [self.thrust_n, self.torque_nm].map(|coefficients| value(coefficients, throttle))
    }

    /// Torque over thrust at half of the largest thrust, m: what M+ takes for its share.
    pub(crate) fn torque_per_thrust(&self, throttle: &Throttle) -> f64 {
        let [most, _] = self.efforts(throttle.max);
        let is_more = |x: f64| self.efforts(x)[0] > 0.5 * most;
        let [f, q] = self.efforts(bisected([throttle.min, throttle.max], is_more));
        q / f
    }
}

/// Whose curves a table has.
pub(super) struct Whose {
    /// The rotor in words.
    pub(super) what: &'static str,
    /// The sign of its torque.
    pub(super) sign: f64,
    /// Help for a torque of the other sign.
    pub(super) torque_help: &'static str,
}

const TORQUE_HELP: &str = "torque is positive where the lower rotor outweighs the upper; in `[pair.lower_out]` the upper rotor turns, in `[pair.upper_out]` the lower";

/// Of `[pair.lower_out]`.
pub(super) const UPPER: Whose = Whose {
    what: "the upper rotor alone",
    sign: -1.0,
    torque_help: TORQUE_HELP,
};

/// Of `[pair.upper_out]`.
pub(super) const LOWER: Whose = Whose {
    what: "the lower rotor alone",
    sign: 1.0,
    torque_help: TORQUE_HELP,
};

/// Reads a table.
pub(super) fn read(
    table: &mut Fields<'_, '_>,
    whose: &Whose,
    throttle: Option<&Throttle>,
) -> Option<RotorAlone> {
    let Whose { what, sign, .. } = whose;
    let keys: [&'static Key; 2] = [&THRUST_N, &TORQUE_NM];
    let terms = "a1, a2, a3 of a1 x + a2 x^2 + a3 x^3 in the throttle x of the rotor";
    let [thrust, torque] = keys.map(|key| {
        let found = limits::coefficients(table, key, ("a rotor alone", 3), |_| terms.to_owned())?;
        <[f64; 3]>::try_from(found).ok()
    });
    let (thrust_n, torque_nm) = (thrust?, torque?);
    let throttle = throttle?;
    let [thrust_path, torque_path] = keys.map(|key| table.key_path(key.name));
    let before = table.faults.len();
    let (slope, at) = least_slope(thrust_n, throttle);
    if slope <= 0.0 {
        let [min, max] = [throttle.min, throttle.max].map(number);
        let message = format!(
            "the thrust of `{thrust_path}` does not grow with the throttle: its slope is {slope:.3} N at {at:.3}"
        );
        let help = "a1 x + a2 x^2 + a3 x^3 with a1, a2, a3 in this order, from a run of that rotor over all throttles";
        let label = format!("must grow from {min} to {max}");
        table.refuse::<()>(keys[0], Code::RotorAlone, message, label, help);
    }
    let full = value(torque_nm, throttle.max);
    if sign * full <= 0.0 {
        let side = if *sign < 0.0 { "below" } else { "above" };
        let message = format!(
            "the torque of `{torque_path}` is {full:.4} N m at full throttle, that of {what} is {side} 0"
        );
        let label = "torque of the other rotor, or of the other sign";
        table.refuse::<()>(keys[1], Code::RotorAlone, message, label, whose.torque_help);
    }
    (table.faults.len() == before).then_some(RotorAlone { thrust_n, torque_nm })
}

fn value([a1, a2, a3]: [f64; 3], x: f64) -> f64 {
    ((a3 * x + a2) * x + a1) * x
}

/// The least slope over the throttle range, N, and the throttle where it is: the slope is a
/// parabola.
fn least_slope([a1, a2, a3]: [f64; 3], throttle: &Throttle) -> (f64, f64) {
    let slope = |x: f64| (3.0 * a3 * x + 2.0 * a2) * x + a1;
    let vertex = (-a2 / (3.0 * a3)).clamp(throttle.min, throttle.max);
    let places = [throttle.min, throttle.max, vertex];
    let finite = places.into_iter().filter(|x| x.is_finite());
    finite
        .map(|x| (slope(x), x))
        .fold((f64::INFINITY, throttle.min), |least, here| {
            if here.0 < least.0 { here } else { least }
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_slope_is_at_an_end_or_at_the_vertex() {
        let throttle = Throttle { min: 0.1, max: 1.0 };
        assert_eq!(least_slope([0.0, 5.0, 0.0], &throttle), (1.0, 0.1));
        assert_eq!(least_slope([3.0, -1.0, 0.0], &throttle), (1.0, 1.0));
        let (slope, at) = least_slope([1.0, -1.5, 1.0], &throttle);
        assert!(
            (slope - 0.25).abs() < 1e-12 && (at - 0.5).abs() < 1e-12,
            "{slope} {at}"
        );
    }
}
