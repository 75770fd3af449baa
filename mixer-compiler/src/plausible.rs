//! Warnings: values that are possible and probably mistakes. A table of rules, all broken ones told.
//!
//! Every rule says what it is of: each pair, each kind of unit, or the frame. A rule compares a value with what propellers, frames and packs are like. Its limits are chosen
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
use rule::{Facts, KindFacts, Rule};

use crate::airframe::{Airframe, Kind, Pair};
use crate::compiled::Compiled;
use crate::diagnostic::Diagnostic;
use crate::model::effectiveness::Effectiveness;

/// The rules of one part of an airframe, by what they are of.
enum Rules {
    /// Each pair.
    EachPair(fn(&KindFacts<'_>, &Pair) -> Vec<Rule>),
    /// Each kind of unit: pairs and single rotors.
    EachKind(fn(&KindFacts<'_>) -> Vec<Rule>),
    /// The frame.
    Frame(fn(&Facts<'_>) -> Vec<Rule>),
}

use Rules::{EachKind, EachPair, Frame};

/// All rules, those that may be the reason of others before these.
const RULES: [Rules; 24] = [
    EachPair(pair::borrowed),
    EachKind(pair::units),
    EachPair(rotors::order),
    EachPair(pair::wake),
    EachKind(pair::idle),
    Frame(pair::spin_min),
    EachPair(rotors::sizes),
    EachKind(pair::growth),
    EachPair(pair::left),
    EachPair(pair::power),
    Frame(geometry::odd_place),
    Frame(geometry::arms),
    Frame(geometry::radians),
    Frame(geometry::centre_of_gravity),
    Frame(geometry::outputs),
    Frame(supply::voltage),
    Frame(supply::air),
    EachKind(supply::own_laws),
    EachKind(limits::wide_tolerances),
    Frame(allocation::yaw),
    EachPair(allocation::power_bias),
    Frame(allocation::idle_power_bias),
    Frame(vehicle::hover),
    Frame(vehicle::rotor_inertia),
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
    let kinds: Vec<KindFacts<'_>> = airframe
        .views()
        .map(|view| KindFacts::new(view, compiled.is_none()))
        .collect();
    let frame = Facts::new(airframe, &kinds, compiled);
    // With each warning the kind that it is of. It explains no warning of another kind.
    let mut found: Vec<(Option<usize>, Diagnostic)> = Vec::new();
    let mut tell = |of: Option<usize>, rules: Vec<Rule>| {
        for rule in rules {
            let is_reason = |(whose, told): &(Option<usize>, Diagnostic)| {
                rule.explains(told) && (of.is_none() || whose.is_none() || *whose == of)
            };
            if found.iter().any(is_reason) {
                continue;
            }
            let told = match of {
                Some(kind) => rule.told_of(&kinds[kind].view),
                None => rule.told(airframe),
            };
            found.extend(told.map(|told| (of, told)));
        }
    };
    for rules in &RULES {
        match rules {
            // A map without thrust or torque has faults enough.
            Frame(_) if !frame.scale.iter().all(|effort| *effort > 0.0) => {}
            Frame(rules) => tell(None, rules(&frame)),
            EachPair(_) | EachKind(_) => {
                for (index, facts) in kinds.iter().enumerate() {
                    match (rules, facts.view.of) {
                        _ if !facts.scale.iter().all(|effort| *effort > 0.0) => {}
                        (EachKind(rules), _) => tell(Some(index), rules(facts)),
                        (EachPair(rules), Kind::Pair(pair)) => tell(Some(index), rules(facts, pair)),
                        _ => {}
                    }
                }
            }
        }
    }
    found.into_iter().map(|(_, told)| told).collect()
}
