//! What a soak holds the compiler and its mixers to: one table.

use std::fmt;

use crate::shortfall::ALLOWED;
use crate::soundness::SLACK;

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Check {
    /// The compiler takes a frame of the zoo.
    Compiled,
    /// What it refuses it refuses with a code of [`REFUSALS`](crate::frames::zoo::REFUSALS).
    Reason,
    /// M is that of the file's places, axes and spins: metres, and shares of a torque.
    Effectiveness,
    /// M M+ is the identity over the served axes, rows and columns per authority.
    PseudoInverse,
    /// A finite request is answered.
    Answered,
    /// Throttles in their range, 0 of rotors that are out.
    Throttle,
    /// The achieved wrench is that of the throttles.
    Truth,
    /// What is missed by more than the tolerance is flagged, and nothing else.
    Flag,
    /// No axis is reversed or exceeded.
    Overstepped,
    /// (roll, pitch) keeps its direction.
    Turned,
    /// Airmode "disabled" does not raise the thrust above the request and the least.
    Raised,
    /// A wrench that throttles give is delivered.
    Delivered,
    /// Throttles follow a small change of the request.
    Jump,
    /// The achieved wrench does.
    Step,
    /// The answer is as good as the linear programme's.
    Optimal,
    /// With rotors out a larger request gets no less of roll and pitch than a smaller one.
    Grown,
    /// With rotors out yaw takes neither roll nor pitch nor thrust, where these come before it.
    YawLast,
}

/// A limit of the table.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// What is looked at.
    pub check: Check,
    /// The name in reports.
    pub name: &'static str,
    /// What counts as a miss: a size above this, mostly as a share of an axis' authority.
    pub size: f64,
    /// Share of misses that is allowed, all rotors turning; 0 allows none. It is of the looks at all
    /// classes of frames together: a class alone has too few for rates of one in ten thousand.
    pub rate: f64,
    /// The same with one rotor out and with two.
    pub rate_out: [f64; 2],
}

const NONE: [f64; 2] = [0.0; 2];

const fn limit(check: Check, name: &'static str, size: f64, rate: f64, rate_out: [f64; 2]) -> Limit {
    Limit {
        check,
        name,
        size,
        rate,
        rate_out,
    }
}

/// The limits, in the order of [`Check`]. Sizes and rates are those that `docs/allocation.md`
/// promises; what has no size is a fault as such.
pub const LIMITS: [Limit; 17] = [
    limit(Check::Compiled, "compiled", 0.0, 0.1, NONE),
    limit(Check::Reason, "reason", 0.0, 0.0, NONE),
    limit(Check::Effectiveness, "effectiveness", 1e-6, 0.0, NONE),
    limit(Check::PseudoInverse, "pseudo-inverse", 1e-12, 0.0, NONE),
    limit(Check::Answered, "answered", 0.0, 0.0, NONE),
    limit(Check::Throttle, "throttle", 0.0, 0.0, NONE),
    limit(Check::Truth, "truth", 0.0, 0.0, NONE),
    limit(Check::Flag, "flag", 0.0, 0.0, NONE),
    // With all rotors: of frames that have no level flight by least norm, and so no guard.
    limit(Check::Overstepped, "overstepped", SLACK, 1e-5, [0.0, 1e-4]),
    limit(Check::Turned, "turned", SLACK, 1e-5, [0.0, 1e-4]),
    limit(Check::Raised, "raised", 0.0, 2e-5, [2e-5; 2]),
    limit(Check::Delivered, "delivered", 0.01, 1e-3, [1e-3; 2]),
    limit(Check::Jump, "jump", 0.02, 2e-4, [1e-4; 2]),
    limit(Check::Step, "step", 0.01, 1e-4, [1e-4; 2]),
    limit(Check::Optimal, "optimal", ALLOWED, 0.01, [0.04, 0.2]),
    limit(Check::Grown, "grown", 0.02, 0.0, [1e-4; 2]),
    limit(Check::YawLast, "yaw last", 0.02, 0.0, [1e-4; 2]),
];

impl Check {
    /// Its row of the table.
    pub fn limit(self) -> &'static Limit {
        &LIMITS[self as usize]
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.limit().name)
    }
}

impl Limit {
    /// The share of misses that is allowed with `rotors_out`.
    pub fn rate(&self, rotors_out: usize) -> f64 {
        match rotors_out {
            0 => self.rate,
            1 => self.rate_out[0],
            _ => self.rate_out[1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_check_has_its_row() {
        for limit in &LIMITS {
            assert_eq!(limit.check.limit().check, limit.check);
        }
    }
}
