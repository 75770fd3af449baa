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
//! 3. where the budget of pivots has ended first: the programme for level flight at the thrust asked
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

mod shortage;
mod simplex;
mod variable;

pub use variable::Scratch;

use crate::pair::rotors::Rotors;
use crate::tables::Tables;
use crate::{Desaturation, Quantity, rolled};
use shortage::RAY;
use simplex::{Budget, SHORTAGES, Simplex};
use variable::{Polygon, between, positive};

/// Pivots of the general path at most, level flight included.
pub const PIVOTS: u8 = BUDGET.pivots + LEVEL_BUDGET.pivots;

/// Moves of units and shortages to other corners at most, level flight included.
pub const FLIPS: u8 = BUDGET.flips + LEVEL_BUDGET.flips;

/// Rounds at most in which the curves of single rotors take the place of their chords.
const ROUNDS: u8 = 3;

/// Budget of the programme for the request.
const BUDGET: Budget = Budget {
    pivots: 16,
    flips: 64,
};

/// Budget of the programme for level flight, which is solved where that of the request ends first.
const LEVEL_BUDGET: Budget = Budget { pivots: 8, flips: 32 };

/// The multipliers at the start, per row of the request's distance from the centres: so units start at corners on the
/// request's side. Chosen for the fewest pivots (0.001 to 1 differ by less than a sixth).
const AHEAD: f32 = 2e-2;

/// Curves are met to this share of the torque's scale.
const TOUCHING: f32 = 1e-4;

/// A frame at one voltage.
struct Frame<'a, 't, P, I, S> {
    tables: &'a Tables<'t, P, I, S>,
    /// Rows per N m of roll, pitch and yaw and per N of thrust.
    rows: [f32; 4],
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
    polygon: Polygon<'a>,
    /// `[f, Q]` (N, N m at the reference voltage) per coordinate, by the [`Rotors`] of a unit.
    efforts: [[[f32; 2]; 2]; 4],
}

/// Writes attainable efforts (`[f, Q]` at the reference voltage, N and N m, in the scratch) that serve `request` (`[roll,
/// pitch, yaw, thrust]`, bounded) in the order of priority. `factors` is `[k_f, k_Q]`. Units have their rotors. True where
/// these are the efforts of least norm, with all rotors.
#[inline(never)]
pub(crate) fn allocate<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: &[f32; 4],
    factors: [f32; 2],
    units: &mut [Scratch],
) -> bool {
    // With the tables known the compiler would write every loop over them out.
    let tables = black_box(tables);
    let is_whole = units.iter().all(|unit| unit.rotors == Rotors::Both);
    let frame = Frame::new(tables, factors, is_whole);
    let is_least_norm = is_whole && frame.towards_least_norm(request, units, true);
    if !is_least_norm {
        frame.programme(request, units, is_whole);
    }
    for unit in units.iter_mut() {
        rolled();
        let [first, second] = frame.efforts[unit.rotors as usize & 3];
        unit.at = [0, 1].map(|k| first[k] * unit.at[0] + second[k] * unit.at[1]);
    }
    is_least_norm
}

impl<'a, 't, P: Quantity, I, S> Frame<'a, 't, P, I, S> {
    #[inline(always)]
    fn new(tables: &'a Tables<'t, P, I, S>, [thrust, torque]: [f32; 2], is_whole: bool) -> Self {
        let [roll, pitch, yaw, lift] = tables.rows;
        let set = &tables.attainable;
        let mut efforts = [[[0.0; 2]; 2]; 4];
        efforts[Rotors::Both as usize] = [[set.scale[0], 0.0], [0.0, set.scale[1]]];
        if !is_whole {
            for rotors in [Rotors::Upper, Rotors::Lower] {
                rolled();
                let [low, high] = rotors.ends(&tables.singles, &tables.throttle);
                efforts[rotors as usize] = [[high[0] - low[0], high[1] - low[1]], low];
            }
        }
        Frame {
            tables,
            rows: [roll / thrust, pitch / thrust, yaw / torque, lift / thrust],
            factors: [thrust, torque],
            polygon: Polygon {
                corners: set.corners,
                centre: set.centre,
            },
            efforts,
        }
    }

    /// Moves units towards the efforts of least norm for a wrench in N m and N, as far as all polygons allow; true if they arrive.
    /// With `from_centre` they start at the centre; then their coordinates mean nothing if they do not arrive.
    #[inline(never)]
    fn towards_least_norm(&self, wrench: &[f32; 4], units: &mut [Scratch], from_centre: bool) -> bool {
        let scale = self.tables.attainable.scale;
        let per_effort = [0, 1].map(|k| 1.0 / (self.factors[k] * scale[k]));
        let mut share = 1.0;
        for (unit, table) in units.iter_mut().zip(self.tables.units) {
            rolled();
            if from_centre {
                unit.at = self.polygon.centre;
            }
            let efforts = table.efforts(wrench);
            unit.rate = [0, 1].map(|k| efforts[k] * per_effort[k] - unit.at[k]);
            for corner in self.polygon.corners {
                rolled();
                let out = corner.outward(unit.rate);
                if out > 0.0 {
                    let room = positive(-corner.beyond(unit.at));
                    if share * out > room {
                        share = room / out;
                        if from_centre {
                            return false;
                        }
                    }
                }
            }
        }
        for unit in units.iter_mut() {
            rolled();
            unit.at = [0, 1].map(|k| unit.at[k] + share * unit.rate[k]);
        }
        share >= 1.0
    }

    /// Gives units their columns and takes what they give at their centres from `centre`, in rows.
    #[inline(never)]
    fn prepare(&self, units: &mut [Scratch], centre: &mut [f32; 4]) {
        for (unit, table) in units.iter_mut().zip(self.tables.units) {
            rolled();
            let efforts = self.efforts[unit.rotors as usize & 3];
            for (column, efforts) in unit.columns.iter_mut().zip(efforts) {
                rolled();
                *column = [0.0; 4];
                table.add_wrench(efforts, self.factors, column);
                for (part, row) in column.iter_mut().zip(self.rows) {
                    *part *= row;
                }
            }
            unit.subtract(self.polygon.inside(unit.rotors), centre);
        }
    }

    /// The linear programme: writes the units' coordinates.
    #[inline(always)]
    fn programme(&self, request: &[f32; 4], units: &mut [Scratch], is_whole: bool) {
        let tables = self.tables;
        let mut centre = [0.0; 4];
        self.prepare(units, &mut centre);
        let mut wanted = [0, 1, 2, 3].map(|k| request[k] * self.rows[k]);
        let mut shortages = [Scratch::default(); SHORTAGES];
        let centre = centre.map(|row| -row);
        let Desaturation {
            airmode,
            yaw_reserve_nm,
        } = tables.desaturation;
        let reserve = yaw_reserve_nm * self.rows[2];
        let n = units.len();
        let write = |shortages: &mut _, wanted: &mut _| {
            shortage::write(shortages, wanted, &centre, n, airmode, reserve)
        };
        let count = write(&mut shortages, &mut wanted);
        let ahead = [0, 1, 2, 3].map(|k| AHEAD * (wanted[k] - centre[k]));
        let mut simplex = Simplex::new(units, &mut shortages, self.polygon);
        simplex.start(&wanted, &ahead, count, BUDGET);
        let mut rounds = if is_whole { 0 } else { ROUNDS };
        let (is_solved, share) = loop {
            let is_solved = simplex.solve();
            simplex.place();
            let share = 1.0 / (1.0 + positive(simplex.shortages[RAY].at[0]) * shortage::REACH);
            if rounds == 0 || !is_solved || !self.bend(&mut simplex, share) {
                break (is_solved, share);
            }
            rounds -= 1;
        };
        for unit in simplex.units.iter_mut() {
            rolled();
            unit.at = between(self.polygon.inside(unit.rotors), unit.at, share);
        }
        if !is_solved {
            // The first programme has changed the gains of the shortages.
            write(simplex.shortages, &mut wanted);
            let level = [0.0, 0.0, 0.0, wanted[3]];
            simplex.start(&level, &[0.0; 4], shortage::LEVEL, LEVEL_BUDGET);
            simplex.solve();
            simplex.place();
        } else if is_whole {
            for (index, shortage) in shortages.iter().take(count).enumerate() {
                rolled();
                if index != RAY {
                    shortage.subtract([share * shortage.at[0], 0.0], &mut wanted);
                }
            }
            for (wanted, row) in wanted.iter_mut().zip(self.rows) {
                *wanted = if row > 0.0 { *wanted / row } else { 0.0 };
            }
            self.towards_least_norm(&wanted, units, false);
        }
    }

    /// Takes single rotors from their chords to their curves at the thrusts that they have come to when drawn back by `share`;
    /// false where they were there.
    #[inline(never)]
    fn bend(&self, simplex: &mut Simplex<'_>, share: f32) -> bool {
        let tables = self.tables;
        let mut has_moved = false;
        for (unit, table) in simplex.units.iter_mut().zip(tables.units) {
            rolled();
            if !unit.rotors.is_single() {
                continue;
            }
            let [along, low] = self.efforts[unit.rotors as usize & 3];
            let x = 0.5 + share * (unit.at[0] - 0.5);
            let [f, chord] = [0, 1].map(|k| low[k] + x * along[k]);
            let throttles = unit.rotors.invert(&tables.singles, &tables.throttle, f);
            let [_, torque] = unit.rotors.efforts(tables, throttles);
            let extra = (torque - chord) / share;
            let change = extra - unit.rate[1];
            if change.abs() > TOUCHING * tables.attainable.scale[1] {
                has_moved = true;
                unit.rate[1] = extra;
                let mut wrench = [0.0; 4];
                table.add_wrench([0.0, change], self.factors, &mut wrench);
                for ((residual, part), row) in simplex.residual.iter_mut().zip(wrench).zip(self.rows) {
                    *residual -= part * row;
                }
            }
        }
        has_moved
    }
}
