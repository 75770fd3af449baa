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
use crate::model::PairMap;

/// The rules of one part of an airframe, those that may be the reason of others before these.
const RULES: [fn(&Facts<'_>) -> Vec<Rule>; 19] = [
    pair::borrowed,
    pair::units,
    rotors::order,
    pair::thrust,
    rotors::sizes,
    pair::shape,
    pair::power,
    geometry::odd_place,
    geometry::arms,
    geometry::radians,
    geometry::centre_of_gravity,
    geometry::outputs,
    supply::voltage,
    supply::air,
    limits::wide_tolerances,
    allocation::yaw,
    allocation::power_bias,
    vehicle::hover,
    vehicle::rotor_inertia,
];

/// Warnings of an airframe that compiles.
pub(crate) fn warnings(compiled: &Compiled) -> Vec<Diagnostic> {
    let thrust_range_n = compiled.thrust_range_n.map(f64::from);
    check(&Facts::new(
        &compiled.airframe,
        &compiled.pair,
        Some(&compiled.effectiveness),
        Some(thrust_range_n),
    ))
}

/// Warnings of an airframe that is refused: one of them may be the reason.
pub(crate) fn warnings_of_refused(airframe: &Airframe) -> Vec<Diagnostic> {
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    check(&Facts::new(airframe, &pair, None, None))
}

fn check(facts: &Facts<'_>) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    // A map without thrust or torque has faults enough.
    if facts.scale.iter().all(|effort| *effort > 0.0) {
        for rule in RULES.iter().flat_map(|rules| rules(facts)) {
            rule.check(facts.airframe, &mut found);
        }
    }
    found
}
