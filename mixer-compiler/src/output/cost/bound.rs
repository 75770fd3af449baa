//! The most instructions that a mix takes, whatever is asked: the sum of what the code does at
//! most.
//!
//! In closed form that is least norm, an attempt at it next to the border, and one of two ways: the
//! facets in several steps where they change the request, or the climb along the null space where
//! they do not; after either the retreat, or what a reserve of yaw asks for. The general path is its pivots, its moves to other corners,
//! and what stands around them. The instructions of each part are the most that were counted of that
//! part over thousands of saturated requests, rounded up; the tests hold the sum to the counts of
//! whole mixers.

use mixer_rt::tables::{Budget, Facets, Outline};

use crate::airframe::Basis;
use crate::compiled::Compiled;
use crate::tables::ClosedFormTable;

/// Checks, and voltage where there is a correction.
const PER_MIX: u32 = 240;
const PER_VOLTAGE: u32 = 78;

/// A request brought down to what products do not overflow with.
const LIMITED: u32 = 70;

/// One unit's least norm, its throttles written, and its share of the achieved wrench.
const PER_UNIT: u32 = 90;

/// One unit of an attempt next to the border: its throttles written, its efforts compared.
const ATTEMPT_UNIT: u32 = 45;

/// A step of the facets' linear programme, and one pair of facets in it.
const STEP: u32 = 30;
const FACETS: u32 = 18;

/// The range of the null space, one unit.
const NULL_RANGE: u32 = 40;

/// How far yaw reaches: a call, and one unit in it. Calls at the start, in the climb, and in the
/// retreat.
const REACH: u32 = 35;
const REACH_UNIT: u32 = 45;
const CLIMB: u32 = 3;
const RETREAT: u32 = 6;

/// The outlines' top: one unit's knots, one knot passed, and one unit in that.
const KNOTS: u32 = 75;
const KNOT: u32 = 30;
const KNOT_UNIT: u32 = 7;

/// What a reserve of yaw calls more often: how far yaw reaches at level flight, at the roomy thrusts and
/// on the lines to and from them; the outlines' top, and the range of a direction in one unit.
const RESERVE_REACHES: u32 = 27;
const RESERVE_TOPS: u32 = 4;
const DIRECTION_UNIT: u32 = 110;

/// The torques, one unit.
const TORQUES: u32 = 40;

/// The general path beside its pivots, and one unit in it.
const GENERAL: u32 = 2400;
const GENERAL_UNIT: u32 = 530;

/// The moves by least norm while all rotors work, or the choice among optima that tie, which takes
/// more: three Newton steps, and one unit in them.
const TIES: u32 = 1500;
const TIES_UNIT: u32 = 900;

/// Another programme with rotors out, and one unit in it.
const PROGRAMME: u32 = 1500;
const PROGRAMME_UNIT: u32 = 300;

/// A pivot of the simplex method, and one unit in it.
const PIVOT: u32 = 900;
const PIVOT_UNIT: u32 = 100;

/// A move to another corner, and one unit in the search for the next.
const FLIP: u32 = 120;
const FLIP_UNIT: u32 = 8;

/// A round in which the curves of single rotors take the place of their chords, and one unit in it.
const ROUND: u32 = 860;
const ROUND_UNIT: u32 = 320;

/// The bound for a compiled airframe while all rotors work; `None` for an evaluator that has not
/// been counted.
pub(super) fn bound(compiled: &Compiled) -> Option<u32> {
    match &compiled.tables.closed_form {
        Some(table) => closed_form(compiled, table),
        None => {
            let ties = TIES + compiled.tables.units.len() as u32 * TIES_UNIT;
            Some(general(compiled, &[compiled.tables.desaturation.budget])? + ties)
        }
    }
}

/// The bound with any number of rotors out: the general path of every frame, up to level flight.
pub(super) fn with_rotors_out(compiled: &Compiled) -> Option<u32> {
    let units = compiled.tables.units.len();
    let n = units as u32;
    let budgets = [false, true, false].map(|is_decided| Budget::with_rotors_out(units, is_decided));
    let curves = 2 * u32::from(Budget::ROUNDS) * (ROUND + n * ROUND_UNIT);
    let starts = (budgets.len() as u32 - 1) * (PROGRAMME + n * PROGRAMME_UNIT);
    Some(general(compiled, &budgets)? + curves + starts)
}

/// The general path: the pivots and moves that are allowed, and what is before and after them.
fn general(compiled: &Compiled, budgets: &[Budget]) -> Option<u32> {
    let basis = compiled.airframe.pair.basis;
    let n = compiled.tables.units.len() as u32;
    let unit = compiled.evaluator.instructions(basis)? + forward(basis) + GENERAL_UNIT;
    let voltage = compiled.airframe.voltage.as_ref().map_or(0, |_| PER_VOLTAGE);
    let work = budgets.iter().map(|budget| {
        u32::from(budget.pivots) * (PIVOT + n * PIVOT_UNIT) + u32::from(budget.flips) * (FLIP + n * FLIP_UNIT)
    });
    Some(GENERAL + voltage + n * unit + work.sum::<u32>())
}

/// The forward map of one unit.
fn forward(basis: Basis) -> u32 {
    match basis {
        Basis::Biquadratic | Basis::Cubic => 50,
        Basis::Quartic => 75,
    }
}

fn closed_form(compiled: &Compiled, table: &ClosedFormTable) -> Option<u32> {
    let basis = compiled.airframe.pair.basis;
    let evaluator = compiled.evaluator.instructions(basis)?;
    let n = table.units.len() as u32;
    let inverses = n * (evaluator + forward(basis));
    let reach = REACH + n * REACH_UNIT;
    let step = STEP + FACETS * table.slopes.len() as u32;
    let walls = STEP + FACETS * table.walls.len() as u32;
    let moved = table.units.iter().filter(|unit| unit.null != 0.0).count() as u32;
    let top = |moved: u32| n * KNOTS + moved * Outline::KNOTS as u32 * (KNOT + n * KNOT_UNIT);
    let climb = if moved == 0 { 0 } else { CLIMB * reach + top(moved) };
    let reserve = if compiled.tables.desaturation.yaw_reserve_nm > 0.0 {
        RESERVE_REACHES * reach + RESERVE_TOPS * (top(n) + n * DIRECTION_UNIT)
    } else {
        0
    };
    let voltage = compiled.airframe.voltage.as_ref().map_or(0, |_| PER_VOLTAGE);
    let ways = (Facets::STEPS * step).max(step + climb);
    let found = walls + ways + n * NULL_RANGE + (1 + RETREAT) * reach + reserve + n * TORQUES;
    Some(PER_MIX + LIMITED + voltage + n * (PER_UNIT + ATTEMPT_UNIT) + 2 * inverses + found)
}
