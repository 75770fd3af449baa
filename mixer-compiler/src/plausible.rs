//! Warnings: values that are possible and probably mistakes. One rule each, all collected.
//!
//! A rule compares a value with what propellers, frames and packs are like. Its limits are chosen
//! so that no file in `airframes/` warns and none of the fits of real bench maps does
//! (`MIXER_BENCH_DATA=.. cargo nextest run -p cargo-mixer maps_warn`), while the mistakes that it
//! is for lie far outside: a wrong unit is a factor of four at least.

mod facts;
mod geometry;
mod limits;
mod pair;
mod power_bias;
mod rotors;
mod stacks;
mod supply;
mod vehicle;

use facts::Facts;

pub use pair::ARDUPILOT_MOST_SPIN_MIN;

use crate::airframe::Airframe;
use crate::compiled::Compiled;
use crate::diagnostic::Diagnostic;
use crate::model::PairMap;
use crate::model::effectiveness::Effectiveness;

/// A rule adds what it has against an airframe.
type Rule = fn(&Facts<'_>, &mut Vec<Diagnostic>);

const RULES: &[Rule] = &[
    pair::units,
    rotors::slopes,
    rotors::bench_spin,
    rotors::wake,
    pair::sum_of_rotors,
    rotors::lopsided,
    rotors::alone,
    pair::idle,
    stacks::spin_min,
    pair::power,
    geometry::arms,
    geometry::short_arms,
    geometry::radians,
    geometry::centre_of_gravity,
    geometry::channels,
    geometry::many_units,
    supply::missing,
    supply::single_cell,
    supply::exponents,
    supply::factors,
    limits::tolerances,
    limits::yaw_reserve,
    stacks::yaw_before_thrust,
    power_bias::beyond,
    power_bias::idle,
    vehicle::hover,
];

/// Warnings of an airframe that compiles.
pub(crate) fn warnings(compiled: &Compiled) -> Vec<Diagnostic> {
    let thrust_range_n = compiled.thrust_range_n.map(f64::from);
    apply(
        &compiled.airframe,
        &compiled.pair,
        Some(&compiled.effectiveness),
        Some(thrust_range_n),
    )
}

/// Warnings of an airframe that is refused: one of them may be the reason.
pub(crate) fn warnings_of_refused(airframe: &Airframe) -> Vec<Diagnostic> {
    let pair = PairMap::new(&airframe.pair, &airframe.throttle);
    apply(airframe, &pair, None, None)
}

fn apply(
    airframe: &Airframe,
    map: &PairMap,
    effectiveness: Option<&Effectiveness>,
    thrust_range_n: Option<[f64; 2]>,
) -> Vec<Diagnostic> {
    let facts = Facts {
        airframe,
        effectiveness,
        scale: map.scale(),
        map,
        thrust_range_n,
    };
    let mut found = Vec::new();
    // A map without thrust or torque has faults enough.
    if !facts.scale.iter().all(|effort| *effort > 0.0) {
        return found;
    }
    for rule in RULES {
        rule(&facts, &mut found);
    }
    found
}

/// Refuses tolerances that are too wide to mean anything.
///
/// # Errors
/// A tolerance above a tenth of a unit's largest effort.
pub(crate) fn check_tolerances(airframe: &Airframe, pair: &PairMap) -> Result<(), Vec<Diagnostic>> {
    let faults = limits::absurd_tolerances(airframe, pair);
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Refuses rotors that give more of an axis than requests are limited to: what is beyond would be
/// attainable and never be given.
///
/// # Errors
/// The first such axis.
pub(crate) fn check_authority(
    airframe: &Airframe,
    effectiveness: &Effectiveness,
    pair: &PairMap,
) -> Result<(), Vec<Diagnostic>> {
    limits::authority(airframe, effectiveness, pair).map_or(Ok(()), |fault| Err(vec![fault]))
}
