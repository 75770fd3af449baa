//! The range of the throttles.

use crate::diagnostic::{Code, Diagnostic, number};
use crate::spec;

/// Least range from idle to full throttle. A narrower one is a mistake and may vanish in single
/// precision.
const LEAST_THROTTLE_RANGE: f64 = 0.01;

/// Range of the throttle, 0 <= min < max <= 1, at least 0.01 wide.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Throttle {
    /// Idle: no rotor is commanded below.
    pub min: f64,
    /// Full throttle.
    pub max: f64,
}

/// Checks `[throttle]`.
pub(super) fn check(table: &spec::Throttle, faults: &mut Vec<Diagnostic>) -> Option<Throttle> {
    let before = faults.len();
    for (key, field) in [("min", &table.min), ("max", &table.max)] {
        if let Some(field) = field
            && !(0.0..=1.0).contains(field.get_ref())
        {
            let help = match *field.get_ref() {
                percent if (2.0..=100.0).contains(&percent) => {
                    format!("if per cent were meant, write {}", number(percent / 100.0))
                }
                _ => "0 is a rotor at rest, 1 is full throttle".to_string(),
            };
            faults.push(
                Diagnostic::new(
                    Code::ThrottleRange,
                    format!("throttle.{key}"),
                    field.span(),
                    format!(
                        "`throttle.{key}` = {} is not between 0 and 1",
                        number(*field.get_ref())
                    ),
                )
                .label("outside [0, 1]")
                .help(help),
            );
        }
    }
    let (min, max) = (table.min.as_ref()?, table.max.as_ref()?);
    if faults.len() > before {
        return None;
    }
    let (low, high) = (*min.get_ref(), *max.get_ref());
    if high - low < LEAST_THROTTLE_RANGE {
        faults.push(
            Diagnostic::new(
                Code::ThrottleRange,
                "throttle.min",
                min.span(),
                format!(
                    "`throttle.min` = {} is not {LEAST_THROTTLE_RANGE} or more below `throttle.max` = {}",
                    number(low),
                    number(high)
                ),
            )
            .label("too high, or `max` too low")
            .help("`min` is the idle, typically 0.05 to 0.15, and `max` is mostly 1"),
        );
        return None;
    }
    Some(Throttle {
        min: low + 0.0,
        max: high,
    })
}
