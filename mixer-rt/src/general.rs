//! Allocation and desaturation of any frame: tilted axes, any number of units, rotors out, every airmode, a reserve of yaw.
//!
//! # Problem
//!
//! Every unit's attainable set is a small convex polygon inside the real one; a unit with a single rotor has a curve.
//! A request is served as far as these allow by one linear programme ([`simplex`]), whose shortages have costs that are so
//! far apart that they act as priorities ([`shortage`]): roll and pitch, which are short together so that their direction
//! stays, before thrust before yaw, or yaw before thrust. There is no variable for an axis that is exceeded or reversed, but
//! for thrust, which only roll and pitch may raise.
//!
//! # Iteration
//!
//! ```text
//! 1. efforts of least norm; where they are inside all polygons they are the answer
//! 2. the programme for the request; the curves of single rotors take the place of their chords
//! 3. where the budget of pivots has ended first: towards level flight until all bounds are met ([`retreat`])
//! 4. towards the efforts of least norm as far as the polygons allow
//! ```
//!
//! A small bias on every unit's efforts makes the optimum unique, so that it is a Lipschitz function of the request. The
//! step of 4 is complete where 1 would have answered, hence nothing jumps there.
//!
//! So that requests within the attainable set do not end at corners, the programme looks beyond them: along the ray from
//! the units' centres through the request, at a small reward. Its answer is drawn back by as much.
//!
//! # Bound
//!
//! [`PIVOTS`] and [`FLIPS`] bound the work of 2, [`ROUNDS`] that of the curves. No loop depends on anything
//! else than these, the number of units and the corners of polygons.

use core::hint::black_box;

mod retreat;
mod shortage;
mod simplex;
mod unit;

pub use unit::Scratch;

use crate::attainable::Corner;
use crate::rotors::Rotors;
use crate::tables::Tables;
use crate::{Quantity, rolled};
use shortage::{RAY, shortages};
use simplex::{Budget, Simplex};
use unit::{Place, positive};

/// Pivots of the general path at most.
pub const PIVOTS: u8 = 16;

/// Moves of units and shortages to other bounds at most.
pub const FLIPS: u8 = 64;

/// Rounds at most in which the curves of single rotors take the place of their chords.
const ROUNDS: usize = 3;

const BUDGET: Budget = Budget {
    pivots: PIVOTS,
    flips: FLIPS,
};

/// The multipliers at the start, per row of the request's distance from the centres: so units start at corners on the
/// request's side. Chosen for the fewest pivots (0.001 to 1 differ by less than a sixth).
const AHEAD: f32 = 2e-2;

/// Curves are met to this share of the largest torque.
const TOUCHING: f32 = 1e-4;

/// The polygon of a unit without rotors.
const NOTHING: [Corner; 1] = [Corner {
    at: [0.0; 2],
    edge: [0.0; 2],
    before: [0.0; 2],
    bound: 0.0,
}];

/// A frame at one voltage, in rows.
struct Frame<'a> {
    /// Newtons and newton metres per unit of the scaled efforts.
    scale: [f32; 2],
    /// The polygons of units by their [`Rotors`], and a point inside each.
    sets: [&'a [Corner]; 4],
    centres: [[f32; 2]; 4],
}

/// Writes attainable efforts (`[f, Q]` at the reference voltage, N and N m, in the scratch) that serve `request` (`[roll,
/// pitch, yaw, thrust]`, bounded) in the order of priority. `factors` is `[k_f, k_Q]`. Units have their rotors.
#[inline(never)]
pub(crate) fn allocate<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: [f32; 4],
    factors: [f32; 2],
    units: &mut [Scratch],
) {
    // With the tables known the compiler would write every loop over them out.
    let tables = black_box(tables);
    let rows = per_row(tables, factors);
    let is_whole = prepare(tables, &rows, &factors, units);
    let set = &tables.attainable;
    if is_whole && least_norm(tables, request, factors, units) {
        return;
    }
    let chords = [Rotors::Upper, Rotors::Lower].map(|rotors| {
        let [low, high] = rotors
            .ends(&tables.singles, &tables.throttle)
            .map(|[f, q]| [f / set.scale[0], q / set.scale[1]]);
        [Corner::between(high, low, high), Corner::between(low, high, low)]
    });
    let middle = |[low, _]: [Corner; 2]| [0, 1].map(|k| low.at[k] + 0.5 * low.edge[k]);
    let frame = Frame {
        scale: set.scale,
        sets: [set.corners, &chords[0], &chords[1], &NOTHING],
        centres: [set.centre, middle(chords[0]), middle(chords[1]), [0.0; 2]],
    };
    let mut centre = [0.0; 4];
    for unit in units.iter() {
        rolled();
        unit.subtract(
            frame.centres[unit.rotors as usize & 3].map(|effort| -effort),
            &mut centre,
        );
    }
    let mut wanted = [0, 1, 2, 3].map(|k| request[k] * rows[k]);
    let priorities = &tables.desaturation;
    let reserve = priorities.yaw_reserve_nm * rows[2];
    let mut simplex = Simplex::new(units, frame.sets, BUDGET);
    let count = shortages(
        &mut simplex.columns,
        &mut wanted,
        &centre,
        simplex.units.len(),
        priorities.airmode,
        reserve,
    );
    let ahead = [0, 1, 2, 3].map(|k| AHEAD * (wanted[k] + centre[k]));
    simplex.start(&wanted, ahead);
    simplex.add_columns(count);
    let mut is_solved = simplex.solve();
    for _ in 0..ROUNDS {
        if is_whole || !is_solved || !frame.bend(&mut simplex, tables) {
            break;
        }
        is_solved = simplex.solve();
    }
    simplex.place_units();
    let share = 1.0 / (1.0 + positive(simplex.value(RAY as u8)) * shortage::REACH);
    let delivered = simplex.delivered(wanted, share);
    for unit in simplex.units.iter_mut() {
        rolled();
        let centre = frame.centres[unit.rotors as usize & 3];
        unit.efforts = [0, 1].map(|k| centre[k] + share * (unit.efforts[k] - centre[k]));
    }
    if !is_solved {
        simplex.retreat(tables.level.as_ref().filter(|_| is_whole), wanted[3], set.scale);
    }
    if is_whole && is_solved {
        draw_to_least_norm(tables, delivered, rows, factors, units);
    }
    for unit in units.iter_mut() {
        rolled();
        unit.efforts = [0, 1].map(|k| unit.efforts[k] * set.scale[k]);
    }
}

/// The efforts of level flight at a thrust in N, for the compiler.
pub fn level_efforts<P: Quantity, I, S>(tables: &Tables<'_, P, I, S>, thrust_n: f32, units: &mut [Scratch]) {
    allocate(tables, [0.0, 0.0, 0.0, thrust_n], [1.0; 2], units);
}

/// Gives units their columns in `rows` per N m and N; true where all rotors work.
#[inline(never)]
fn prepare<P, I, S>(
    tables: &Tables<'_, P, I, S>,
    rows: &[f32; 4],
    factors: &[f32; 2],
    units: &mut [Scratch],
) -> bool {
    let mut is_whole = true;
    for (unit, table) in units.iter_mut().zip(tables.units) {
        rolled();
        unit.columns = [0, 1].map(|k| {
            let size = factors[k] * tables.attainable.scale[k];
            [0, 1, 2, 3].map(|axis| table.effectiveness[k][axis] * (rows[axis] * size))
        });
        is_whole &= unit.rotors == Rotors::Both;
        unit.place = Place::Corner;
        unit.bend = 0.0;
    }
    is_whole
}

/// Scaled efforts of least norm per wrench in N m and N.
#[inline(always)]
fn scaled(efforts: [f32; 2], per_effort: [f32; 2]) -> [f32; 2] {
    [0, 1].map(|k| efforts[k] * per_effort[k])
}

/// Writes the efforts of least norm, N and N m; true where all are inside the polygon.
#[inline(never)]
fn least_norm<P, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: [f32; 4],
    factors: [f32; 2],
    units: &mut [Scratch],
) -> bool {
    let set = &tables.attainable;
    let per_factor = factors.map(|factor| 1.0 / factor);
    let per_effort = [0, 1].map(|k| per_factor[k] / set.scale[k]);
    for (unit, table) in units.iter_mut().zip(tables.units) {
        rolled();
        let efforts = table.efforts(&request);
        unit.efforts = scaled(efforts, per_factor);
        let scaled = scaled(efforts, per_effort);
        for corner in set.corners {
            rolled();
            if corner.beyond(scaled) > 0.0 {
                return false;
            }
        }
    }
    true
}

/// Moves scaled efforts towards those of least norm for what is `delivered`, in rows, as far as all polygons allow.
#[inline(never)]
fn draw_to_least_norm<P, I, S>(
    tables: &Tables<'_, P, I, S>,
    delivered: [f32; 4],
    rows: [f32; 4],
    factors: [f32; 2],
    units: &mut [Scratch],
) {
    let wrench = [0, 1, 2, 3].map(|k| {
        if rows[k] > 0.0 {
            delivered[k] / rows[k]
        } else {
            0.0
        }
    });
    let set = &tables.attainable;
    let per_effort = [0, 1].map(|k| 1.0 / (factors[k] * set.scale[k]));
    let mut share = 1.0;
    for (unit, table) in units.iter_mut().zip(tables.units) {
        rolled();
        let target = scaled(table.efforts(&wrench), per_effort);
        unit.rate = [0, 1].map(|k| target[k] - unit.efforts[k]);
        for corner in set.corners {
            rolled();
            let out = corner.outward(unit.rate);
            if out > 0.0 {
                let room = positive(-corner.beyond(unit.efforts));
                if share * out > room {
                    share = room / out;
                }
            }
        }
    }
    for unit in units.iter_mut() {
        rolled();
        unit.efforts = [0, 1].map(|k| unit.efforts[k] + share * unit.rate[k]);
    }
}

/// Rows per N m and per N at `[k_f, k_Q]`.
#[inline(always)]
fn per_row<P, I, S>(tables: &Tables<'_, P, I, S>, [thrust, torque]: [f32; 2]) -> [f32; 4] {
    let [roll, pitch, yaw, lift] = tables.rows;
    [roll / thrust, pitch / thrust, yaw / torque, lift / thrust]
}

impl Frame<'_> {
    /// Takes single rotors from their chords to their curves at the thrusts that they have come to; false where they were
    /// there.
    #[inline(never)]
    fn bend<P: Quantity, I, S>(&self, simplex: &mut Simplex<'_>, tables: &Tables<'_, P, I, S>) -> bool {
        simplex.place_units();
        let beyond = positive(simplex.value(RAY as u8)) * shortage::REACH;
        let mut has_moved = false;
        for unit in simplex.units.iter_mut() {
            rolled();
            let kind = unit.rotors as usize & 3;
            if !unit.rotors.is_single() {
                continue;
            }
            // Where the answer, drawn back from the ray, will be.
            let centre = self.centres[kind];
            let share = 1.0 / (1.0 + beyond);
            let f = centre[0] + share * (unit.efforts[0] - centre[0]);
            let throttles = unit
                .rotors
                .invert(&tables.singles, &tables.throttle, f * self.scale[0]);
            let [_, torque] = unit.rotors.efforts(tables, throttles);
            let torque = torque / self.scale[1];
            let wanted = centre[1] + (torque - centre[1]) * (1.0 + beyond);
            let change = wanted - unit.efforts[1];
            if change.abs() > TOUCHING {
                has_moved = true;
                unit.bend += change;
                unit.subtract([0.0, change], &mut simplex.residual);
            }
        }
        has_moved
    }
}
