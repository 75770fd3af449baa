//! Warnings: values that are possible and probably mistakes. A table of rules, all broken ones told.
//!
//! A rule compares a value with what propellers, frames and packs are like. Its limits are chosen
//! so that no file in `airframes/` warns and none of the fits of real bench maps does
//! (`MIXER_BENCH_DATA=.. cargo nextest run -p cargo-mixer maps_warn`), while the mistakes that it
//! is for lie far outside: a wrong unit is a factor of four at least.

mod allocation;
mod geometry;
mod limits;
mod pair;
mod rotors;
mod rule;
mod supply;
pub mod symmetry;
mod vehicle;

pub(crate) use limits::{check_authority, check_tolerances};
pub use pair::ARDUPILOT_MOST_SPIN_MIN;
use rule::{Facts, Rule};

use crate::airframe::Airframe;
use crate::compiled::Compiled;
use crate::diagnostic::Diagnostic;
use crate::model::effectiveness::Effectiveness;

/// What the rules of a function are of: each pair, or the frame.
enum Of {
    Pair,
    Frame,
}

/// The rules of one part of an airframe.
type Part = fn(&Facts<'_>) -> Vec<Rule>;

/// All rules, those that may be the reason of others before these.
const RULES: [(Of, Part); 20] = [
    (Of::Pair, pair::borrowed),
    (Of::Pair, pair::units),
    (Of::Pair, rotors::order),
    (Of::Pair, pair::thrust),
    (Of::Pair, rotors::sizes),
    (Of::Pair, pair::shape),
    (Of::Pair, pair::power),
    (Of::Frame, geometry::odd_place),
    (Of::Frame, geometry::arms),
    (Of::Frame, geometry::radians),
    (Of::Frame, geometry::centre_of_gravity),
    (Of::Frame, geometry::outputs),
    (Of::Frame, supply::voltage),
    (Of::Frame, supply::air),
    (Of::Pair, limits::wide_tolerances),
    (Of::Frame, allocation::yaw),
    (Of::Pair, allocation::power_bias),
    (Of::Frame, allocation::idle_power_bias),
    (Of::Frame, vehicle::hover),
    (Of::Pair, vehicle::rotor_inertia),
];

/// Warnings of an airframe that compiles.
pub(crate) fn warnings(compiled: &Compiled) -> Vec<Diagnostic> {
    let thrust_range_n = compiled.thrust_range_n.map(f64::from);
    check(
        &compiled.airframe,
        Some((&compiled.effectiveness, thrust_range_n)),
    )
}

/// Warnings of an airframe that is refused: one of them may be the reason.
pub(crate) fn warnings_of_refused(airframe: &Airframe) -> Vec<Diagnostic> {
    check(airframe, None)
}

/// `compiled` has M and the range of level thrust; `None` where the airframe is refused.
fn check(airframe: &Airframe, compiled: Option<(&Effectiveness, [f64; 2])>) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut tell = |airframe: &Airframe, is_of: &dyn Fn(&Of) -> bool| {
        let facts = Facts::new(airframe, compiled);
        let mut own = if airframe.is_unlike() {
            found.clone()
        } else {
            Vec::new()
        };
        let told = own.len();
        // A map without thrust or torque has faults enough.
        if facts.scale.iter().all(|effort| *effort > 0.0) {
            for (_, rules) in RULES.iter().filter(|(of, _)| is_of(of)) {
                for rule in rules(&facts) {
                    rule.check(airframe, &mut own);
                }
            }
        }
        found.extend(own.split_off(told));
    };
    if !airframe.is_unlike() {
        tell(airframe, &|_| true);
        return found;
    }
    for of_pair in airframe.of_each_pair().iter().filter(|_| airframe.has_pairs()) {
        tell(of_pair, &|of| matches!(of, Of::Pair));
    }
    tell(airframe, &|of| matches!(of, Of::Frame));
    found
}
