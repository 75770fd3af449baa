//! `[throttle]`: the range of every rotor's throttle.

use crate::diagnostic::{Code, number};
use crate::spec::Fields;
use crate::spec::keys::{Range, ValueKind, keys};

/// A share of full throttle.
const SHARE: ValueKind = ValueKind::Number(Range::Within([0.0, 1.0]));

keys! { TABLE = "[throttle]":
    MIN "min" = "0.10", SHARE,
        "Idle: no rotor is ever commanded below. Below some idle the map of every pair folds; the compiler names the least that works.".required();
    MAX "max" = "1.0", SHARE,
        "No rotor is ever commanded above.".required();
}

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

impl Throttle {
    /// Both ends.
    pub fn range(&self) -> [f64; 2] {
        [self.min, self.max]
    }
}

pub(super) fn read(table: &mut Fields<'_, '_>) -> Option<Throttle> {
    let [min, max] = [&MIN, &MAX].map(|key| {
        let field = table.read::<f64>(key)?;
        let x = *field.get_ref();
        if (0.0..=1.0).contains(&x) {
            return Some(x);
        }
        let help = match x {
            percent if (2.0..=100.0).contains(&percent) => {
                format!("if per cent were meant, write {}", number(percent / 100.0))
            }
            _ => "0 is a rotor at rest, 1 is full throttle".to_string(),
        };
        let path = table.key_path(key.name);
        let message = format!("`{path}` = {} is not between 0 and 1", number(x));
        table.refuse(key, Code::ThrottleRange, message, "outside [0, 1]", help)
    });
    let (min, max) = (min?, max?);
    if max - min < LEAST_THROTTLE_RANGE {
        let message = format!(
            "`throttle.min` = {} is not {LEAST_THROTTLE_RANGE} or more below `throttle.max` = {}",
            number(min),
            number(max)
        );
        let help = "`min` is the idle, typically 0.05 to 0.15, and `max` is mostly 1";
        return table.refuse(
            &MIN,
            Code::ThrottleRange,
            message,
            "too high, or `max` too low",
            help,
        );
    }
    Some(Throttle { min, max })
}
