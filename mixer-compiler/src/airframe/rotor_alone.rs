//! What one rotor of a unit gives alone, the other one at rest.

use toml::Spanned;

use super::check::LARGEST_EFFORT;
use super::throttle::Throttle;
use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// `[pair.lower_out]` or `[pair.upper_out]`: a1 x + a2 x2 + a3 x3 in the throttle x of the rotor
/// that turns.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RotorAlone {
    /// a1, a2, a3 of the thrust, N; it grows with the throttle over the throttle range.
    pub thrust_n: [f64; 3],
    /// a1, a2, a3 of the torque, N m, signed as on the bench: at full throttle below 0 for the
    /// upper rotor, above for the lower one.
    pub torque_nm: [f64; 3],
}

impl RotorAlone {
    /// The efforts `[f, Q]` at the rotor's throttle, N and N m at the reference voltage.
    pub fn efforts(&self, throttle: f64) -> [f64; 2] {
        [self.thrust_n, self.torque_nm].map(|coefficients| value(coefficients, throttle))
    }
}

/// Checks `pair.KEY`; `sign` is that of its torque.
pub(super) fn check(
    key: &str,
    table: &spec::RotorAlone,
    sign: f64,
    throttle: Option<&Throttle>,
    faults: &mut Vec<Diagnostic>,
) -> Option<RotorAlone> {
    let coefficients =
        |name: &str, field: &Option<Spanned<[Spanned<f64>; 3]>>, faults: &mut Vec<Diagnostic>| {
            let field = field.as_ref()?;
            let coefficients = field.get_ref().each_ref().map(|c| *c.get_ref());
            let beyond = coefficients.iter().find(|c| c.abs() > LARGEST_EFFORT);
            if let Some(beyond) = beyond {
                let key = format!("pair.{key}.{name}");
                let message = format!(
                    "a coefficient of {} in `{key}` is beyond {}",
                    number(*beyond),
                    number(LARGEST_EFFORT)
                );
                let fault = Diagnostic::new(Code::OutOfRange, key, field.span(), message)
                    .label("no rotor gives that")
                    .help("the throttle of the polynomial runs from 0 to 1, not in microseconds");
                faults.push(fault);
                return None;
            }
            Some((coefficients, field.span()))
        };
    let thrust = coefficients("thrust_n", &table.thrust_n, faults);
    let torque = coefficients("torque_nm", &table.torque_nm, faults);
    let ((thrust_n, thrust_place), (torque_nm, torque_place)) = (thrust?, torque?);
    let throttle = throttle?;
    let before = faults.len();
    let (slope, at) = least_slope(thrust_n, throttle);
    if slope <= 0.0 {
        let key = format!("pair.{key}.thrust_n");
        let message = format!(
            "the thrust of `{key}` does not grow with the throttle: its slope is {slope:.3} N at {at:.3}"
        );
        faults.push(
            Diagnostic::new(Code::RotorAlone, key, thrust_place, message)
                .label(format!(
                    "must grow from {} to {}",
                    number(throttle.min),
                    number(throttle.max)
                ))
                .help("a1 x + a2 x^2 + a3 x^3 with a1, a2, a3 in this order, from a run of that rotor over all throttles"),
        );
    }
    let full = value(torque_nm, throttle.max);
    if sign * full <= 0.0 {
        let key_of = format!("pair.{key}.torque_nm");
        let (turning, side) = if sign < 0.0 {
            ("upper", "below")
        } else {
            ("lower", "above")
        };
        let message = format!(
            "the torque of `{key_of}` is {full:.4} N m at full throttle, that of the {turning} rotor alone is {side} 0"
        );
        faults.push(
            Diagnostic::new(Code::RotorAlone, key_of, torque_place, message)
                .label("torque of the other rotor, or of the other sign")
                .help(format!(
                    "torque is positive where the lower rotor outweighs the upper; in `[pair.{key}]` the {turning} rotor turns"
                )),
        );
    }
    (faults.len() == before).then_some(RotorAlone { thrust_n, torque_nm })
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
