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

/// Checks, a correction of voltage or of density, and each piece of its table.
const PER_MIX: u32 = 240;
const PER_CORRECTION: u32 = 70;
const PER_PIECE: u32 = 10;

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

/// How far yaw reaches: a call, and one unit in it. Calls at the start, where yaw is extended, and where it
/// is bounded.
const REACH: u32 = 35;
const REACH_UNIT: u32 = 45;
const EXTENDED: u32 = 3;
const BOUNDED: u32 = 6;

/// The outlines' top: one unit's knots, one knot passed, and one unit in that.
const KNOTS: u32 = 75;
const KNOT: u32 = 30;
const KNOT_UNIT: u32 = 7;

/// Additional work for a reserve of yaw: rounds, and calls in one of them for how far yaw reaches.
const RESERVE_ROUNDS: u32 = 2;
const RESERVE_REACHES: u32 = 6;

/// The torques, one unit.
const TORQUES: u32 = 40;

/// Beside the iterations: the request in rows and the targets; one unit of both.
const CUT: u32 = 300;
const CUT_UNIT: u32 = 115;

/// An iteration with its share of the correction, and one unit in it: with vertical axes, and tilted.
const ITERATION: u32 = 480;
const ITERATION_UNIT: [u32; 2] = [355, 420];

/// The pair of a unit looked up among several, in least norm or in an iteration.
const KIND: u32 = 25;

/// The throttle of a single rotor found apart.
const SINGLE_APART: u32 = 350;

/// A slack of the request in all iterations: that of a reserve, and that of yaw beyond the request with rotors out.
const SLACK: u32 = MOST_ITERATIONS * 60;

/// Least norm with rotors alone beside that of whole pairs, and one unit in it that has one.
const ROTORS_ALONE: u32 = 1000;
const ROTOR_ALONE: u32 = 800;

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
        Some((evaluator, basis)) => {
            evaluator.instructions(basis)? + forward(basis) + PER_UNIT + kind(compiled)
        }
        None => 0,
    };
    let of_pairs = airframe.pair_units() as u32 * pair;
    let of_alone = match alone as u32 {
        0 => 0,
        alone => ROTORS_ALONE + alone * ROTOR_ALONE,
    };
    Some(of_pairs + airframe.single_units() as u32 * SINGLE_APART + of_alone)
}

/// The interior point method: all iterations, with so many slacks beside that of a reserve.
fn interior(compiled: &Compiled, slacks: u32) -> u32 {
    let n = compiled.tables.units.len() as u32;
    let unit = ITERATION_UNIT[usize::from(!compiled.tables.is_vertical)];
    // Additional instructions for the derivatives of the basis.
    let more = match compiled.inverse() {
        Some((_, Basis::Quartic)) => 45,
        Some((_, Basis::Cubic)) => 10,
        Some((_, Basis::Biquadratic)) | None => 0,
    };
    let slacks = slacks + u32::from(compiled.tables.priorities.yaw_reserve_nm > 0.0);
    MOST_ITERATIONS * (ITERATION + n * (unit + more + kind(compiled))) + slacks * SLACK + CUT + n * CUT_UNIT
}

fn kind(compiled: &Compiled) -> u32 {
    if compiled.airframe.is_unlike() { KIND } else { 0 }
}

/// Checks, and corrections of voltage and density where there are any.
fn per_mix(compiled: &Compiled) -> u32 {
    let corrections = &compiled.tables.corrections;
    let tables = corrections.voltage.iter().chain(&corrections.air);
    let corrections = tables.map(|table| PER_CORRECTION + PER_PIECE * table.pieces.len() as u32);
    PER_MIX + LIMITED + corrections.sum::<u32>()
}

/// The forward map of one unit.
fn forward(basis: Basis) -> u32 {
    match basis {
        Basis::Biquadratic | Basis::Cubic => 50,
        Basis::Quartic => 75,
    }
}

fn closed_form(compiled: &Compiled, table: &ClosedFormTable) -> Option<u32> {
    let (evaluator, basis) = compiled.inverse()?;
    let evaluator = evaluator.instructions(basis)?;
    let n = table.units.len() as u32;
    let inverses = n * (evaluator + forward(basis));
    let reach = REACH + n * REACH_UNIT;
    let step = STEP + FACETS * table.slopes.len() as u32;
    let walls = STEP + FACETS * (table.walls.len() + table.steep.len()) as u32;
    let moved = table.units.iter().filter(|unit| unit.null != 0.0).count() as u32;
    let top = |moved: u32| n * KNOTS + moved * Outline::KNOTS as u32 * (KNOT + n * KNOT_UNIT);
    let extended = if moved == 0 {
        0
    } else {
        EXTENDED * reach + top(moved)
    };
    let reserve = if compiled.tables.priorities.yaw_reserve_nm > 0.0 {
        RESERVE_ROUNDS * (RESERVE_REACHES * reach + top(n) + n * NULL_RANGE)
    } else {
        0
    };
    let ways = (Facets::STEPS * step).max(step + extended);
    let found = walls + ways + n * NULL_RANGE + (1 + BOUNDED) * reach + reserve + n * TORQUES;
    Some(per_mix(compiled) + n * (PER_UNIT + ATTEMPT_UNIT) + 2 * inverses + found)
}
