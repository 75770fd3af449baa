//! The most instructions that a mix takes, whatever is asked: the sum of what the code does at most.
//!
//! In closed form that is least norm, an attempt at it next to the border, and one of two ways: the
//! facets in several steps where they change the request, or yaw extended along the null space where
//! they do not; after either yaw is bounded, and its reserve kept. Else it is least norm and
//! the iterations of the interior point method: a product of their largest number and the
//! cost of one (`cargo counts`). The tests hold the sum to the counts of whole mixers.

use mixer_rt::tables::{Facets, GUARD_LEAST_NORMS, MOST_ITERATIONS, Outline};

use mixer_compiler::Compiled;
use mixer_compiler::airframe::Basis;
use mixer_compiler::tables::ClosedFormTable;

/// Checks, a request brought down to what products do not overflow with; a correction of voltage or of density,
/// and each piece of its table.
const MIX: u32 = 310;
const CORRECTION: u32 = 70;
const PIECE: u32 = 10;

/// One unit beside its inverse and forward map: least norm twice, its throttles, its share of the achieved wrench.
const UNIT: u32 = 235;
const FORWARD: u32 = 60;

/// A step of the facets' linear programme, and one pair of facets in it.
const STEP: u32 = 30;
const FACETS: u32 = 18;

/// How far yaw reaches: a call, and one unit in it. Calls at the start and where yaw is bounded, where it is extended,
/// and for a reserve.
const REACH: u32 = 35;
const REACH_UNIT: u32 = 45;
const REACHES: u32 = 7;
const EXTENDED: u32 = 3;
const RESERVED: u32 = 12;

/// The outlines' top: one unit's knots, one knot passed, and one unit in that. A reserve looks for it twice.
const KNOTS: u32 = 75;
const KNOT: u32 = 30;
const KNOT_UNIT: u32 = 7;

/// An iteration with its share of what is around it, one unit in it, what tilted axes, a quartic or several kinds add
/// to that; a slack of the request.
const ITERATION: u32 = 490;
const ITERATION_UNIT: u32 = 360;
const TILTED: u32 = 65;
const QUARTIC: u32 = 45;
const KIND: u32 = 25;
const SLACK: u32 = 60;

/// A unit of one rotor or none in least norm, and what is done once where there is one.
const ALONE: u32 = 1000;

/// The bound for a compiled airframe while all rotors turn; `None` for an evaluator that has not been
/// counted.
pub(super) fn bound(compiled: &Compiled) -> Option<u32> {
    match &compiled.tables.closed_form {
        Some(table) => closed_form(compiled, table),
        None => general(compiled, compiled.airframe.single_units(), false),
    }
}

/// The bound with any number of rotors out, of every frame.
pub(super) fn with_rotors_out(compiled: &Compiled) -> Option<u32> {
    general(compiled, compiled.airframe.units.len(), true)
}

/// Least norm of the request, the interior point method, and the guard, where so many units have one rotor or none. With
/// rotors out there is a slack more.
fn general(compiled: &Compiled, alone: usize, is_out: bool) -> Option<u32> {
    let guard = GUARD_LEAST_NORMS[usize::from(is_out)];
    let least_norms = (1 + guard) * least_norm(compiled, alone)?;
    Some(least_norms + per_mix(compiled) + interior(compiled, u32::from(is_out)))
}

/// Least norm of all units, so many of which have one rotor or none.
fn least_norm(compiled: &Compiled, alone: usize) -> Option<u32> {
    let airframe = &compiled.airframe;
    let pair = match compiled.inverse() {
        Some((evaluator, basis)) => evaluator.instructions(basis)? + FORWARD + UNIT,
        None => 0,
    };
    let once = u32::from(alone > 0);
    Some(airframe.pair_units() as u32 * pair + (alone as u32 + once) * ALONE)
}

/// The interior point method: all iterations, with so many slacks beside that of a reserve.
fn interior(compiled: &Compiled, slacks: u32) -> u32 {
    let tables = &compiled.tables;
    let is_quartic = matches!(compiled.inverse(), Some((_, Basis::Quartic)));
    let unit = ITERATION_UNIT
        + u32::from(!tables.is_vertical) * TILTED
        + u32::from(is_quartic) * QUARTIC
        + u32::from(compiled.airframe.is_unlike()) * KIND;
    let slacks = slacks + u32::from(tables.priorities.yaw_reserve_nm > 0.0);
    MOST_ITERATIONS * (ITERATION + tables.units.len() as u32 * unit + slacks * SLACK)
}

/// Checks, and corrections of voltage and density where there are any.
fn per_mix(compiled: &Compiled) -> u32 {
    let corrections = &compiled.tables.corrections;
    let tables = corrections.voltage.iter().chain(&corrections.air);
    let corrections = tables.map(|table| CORRECTION + PIECE * table.pieces.len() as u32);
    MIX + corrections.sum::<u32>()
}

fn closed_form(compiled: &Compiled, table: &ClosedFormTable) -> Option<u32> {
    let (evaluator, basis) = compiled.inverse()?;
    let n = table.units.len() as u32;
    let units = n * (2 * (evaluator.instructions(basis)? + FORWARD) + UNIT);
    let reach = REACH + n * REACH_UNIT;
    let step = STEP + FACETS * table.slopes.len() as u32;
    let walls = STEP + FACETS * (table.walls.len() + table.steep.len()) as u32;
    let top = |moved: u32| n * KNOTS + moved * Outline::KNOTS as u32 * (KNOT + n * KNOT_UNIT);
    let extended = match table.units.iter().filter(|unit| unit.null != 0.0).count() as u32 {
        0 => 0,
        moved => EXTENDED * reach + top(moved),
    };
    let reserve = match compiled.tables.priorities.yaw_reserve_nm {
        none if none <= 0.0 => 0,
        _ => RESERVED * reach + 2 * top(n),
    };
    let ways = (Facets::STEPS * step).max(step + extended);
    Some(per_mix(compiled) + units + walls + ways + REACHES * reach + reserve)
}
