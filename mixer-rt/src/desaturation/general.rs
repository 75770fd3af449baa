//! Allocation and desaturation of any frame: tilted axes, any number of units, rotors out, every
//! airmode, a reserve of yaw.
//!
//! # Problem
//!
//! Every unit's attainable set is a small convex polygon inside the real one; a unit with a single
//! rotor has a curve. A request is served as far as these allow by one linear programme
//! ([`simplex`]), whose shortages have costs that are so far apart that they act as priorities
//! ([`shortage`]): roll and pitch, which are short together so that their direction stays, before
//! thrust before yaw, or yaw before thrust. A shortage lies between nothing and all that was
//! asked for, so no axis is reversed or exceeded. Thrust is the exception: roll and pitch may raise
//! it.
//!
//! # Iteration
//!
//! ```text
//! 1. efforts of least norm; where they are inside all polygons they are the answer
//! 2. the programme for the request; the curves of single rotors take the place of their chords
//! 3. towards the efforts of least norm as far as the polygons allow
//! ```
//!
//! Where the budget of pivots ends before the programme of 2 is solved:
//!
//! ```text
//! all rotors work   from stored level flight towards the request as far as the polygons allow
//! rotors are out    the same programme goes on to level flight at the thrust asked
//! ```
//!
//! A small bias on every unit's efforts makes the optimum unique, so that it is a Lipschitz
//! function of the request. The step of 3 is complete where 1 would have answered, hence nothing
//! jumps there.
//!
//! So that requests within the attainable set do not end at corners, the programme looks beyond
//! them: along the ray from the units' centres through the request, at a small reward. Its answer
//! is drawn back by as much.
//!
//! # Bound
//!
//! [`Desaturation::budget`](crate::desaturation::Desaturation::budget) bounds the work of 2 while
//! all rotors work. With rotors out [`Budget::with_rotors_out`], [`Budget::for_level_flight`] and
//! [`Budget::ROUNDS`] do. No loop depends on anything else than these, the number of units and the corners of
//! polygons.

use core::hint::black_box;

mod breakpoint;
mod shortage;
mod simplex;
mod variable;

pub use shortage::SHORTAGES;
pub use variable::Variable;

use crate::desaturation::Budget;
use crate::layout::{Tables, Unit};
use crate::pair::Quantity;
use crate::pair::rotors::Rotors;
use crate::{clamp, rolled};
use shortage::RAY;
use simplex::Simplex;
use variable::{between, inside, positive};

/// Largest distance of a single rotor's torque from its curve, as a share of the torque's scale.
const TOUCHING: f32 = 1e-4;

/// How units move by the efforts of least norm for a wrench.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// From the centre to these efforts. Their coordinates mean nothing if they do not arrive.
    FromCentreTo,
    /// From where they are to these efforts.
    To,
    /// From where they are by these efforts.
    By,
}

/// A frame at one voltage.
struct Frame<'a, 't, P, I, S> {
    tables: &'a Tables<'t, P, I, S>,
    /// Rows per N m of roll, pitch and yaw and per N of thrust.
    rows: [f32; 4],
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
    /// True where all rotors work.
    is_whole: bool,
}

/// Writes attainable efforts (`[f, Q]` at the reference voltage, N and N m, in the variables) that
/// serve `request` (`[roll, pitch, yaw, thrust]`, bounded) in the order of priority. `factors` is
/// `[k_f, k_Q]`. There is a variable per unit, which has the unit's rotors, and [`SHORTAGES`] more.
/// `is_whole` tells that all rotors work. True where these are the efforts of least norm, with all
/// rotors.
#[inline(never)]
pub(crate) fn allocate<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: &[f32; 4],
    factors: [f32; 2],
    variables: &mut [Variable],
    is_whole: bool,
) -> bool {
    // With the tables known the compiler would write every loop over them out.
    let frame = Frame::new(black_box(tables), factors, is_whole);
    let units = variables.len().saturating_sub(SHORTAGES);
    let is_least_norm = is_whole && frame.move_by_least_norm(request, variables, Way::FromCentreTo);
    if !is_least_norm {
        frame.serve(request, variables, units);
    }
    for unit in variables.iter_mut().take(units) {
        rolled();
        let [first, second] = frame.efforts(unit.rotors);
        unit.at = [0, 1].map(|k| first[k] * unit.at[0] + second[k] * unit.at[1]);
    }
    is_least_norm
}

impl<'a, 't, P: Quantity, I, S> Frame<'a, 't, P, I, S> {
    #[inline(always)]
    fn new(tables: &'a Tables<'t, P, I, S>, [thrust, torque]: [f32; 2], is_whole: bool) -> Self {
        let [roll, pitch, yaw, lift] = tables.rows;
        Frame {
            tables,
            // In memory: registers that hold them across calls would have to be saved.
            rows: black_box([roll / thrust, pitch / thrust, yaw / torque, lift / thrust]),
            factors: [thrust, torque],
            is_whole,
        }
    }

    /// `[f, Q]` (N, N m at the reference voltage) per coordinate of a unit with these rotors.
    #[inline(always)]
    fn efforts(&self, rotors: Rotors) -> [[f32; 2]; 2] {
        if self.is_whole || rotors == Rotors::Both {
            let [thrust, torque] = self.tables.attainable.scale;
            return [[thrust, 0.0], [0.0, torque]];
        }
        if rotors == Rotors::None {
            return [[0.0; 2]; 2];
        }
        let [low, high] = rotors.ends(&self.tables.singles, &self.tables.throttle);
        [[high[0] - low[0], high[1] - low[1]], low]
    }

    /// Moves units by or to the efforts of least norm for a wrench in N m and N, as far as all
    /// polygons allow; true if they arrive.
    #[inline(never)]
    fn move_by_least_norm(&self, wrench: &[f32; 4], variables: &mut [Variable], way: Way) -> bool {
        let attainable = &self.tables.attainable;
        let per_effort = [0, 1].map(|k| 1.0 / (self.factors[k] * attainable.scale[k]));
        let mut share = 1.0;
        for (unit, table) in variables.iter_mut().zip(self.tables.units) {
            rolled();
            if way == Way::FromCentreTo {
                unit.at = attainable.centre;
            }
            let efforts = table.efforts(wrench);
            let at = unit.at;
            let start = if way == Way::By { [0.0; 2] } else { at };
            let rate = [0, 1].map(|k| efforts[k] * per_effort[k] - start[k]);
            unit.rate = rate;
            for corner in attainable.corners {
                rolled();
                let out = corner.outward(rate);
                if out > 0.0 {
                    let beyond = corner.beyond(at);
                    if share * out + beyond > 0.0 {
                        share = positive(-beyond) / out;
                        if way == Way::FromCentreTo {
                            return false;
                        }
                    }
                }
            }
        }
        for (unit, _) in variables.iter_mut().zip(self.tables.units) {
            rolled();
            unit.at = [0, 1].map(|k| unit.at[k] + share * unit.rate[k]);
        }
        share >= 1.0
    }

    /// The wrench of a unit's efforts, in rows.
    #[inline(never)]
    fn given(&self, unit: &Unit, efforts: [f32; 2]) -> [f32; 4] {
        let mut wrench = [0.0; 4];
        unit.add_wrench(efforts, self.factors, &mut wrench);
        [0, 1, 2, 3].map(|k| wrench[k] * self.rows[k])
    }

    /// Gives units their columns; returns what they give at their centres, in rows.
    #[inline(never)]
    fn prepare(&self, variables: &mut [Variable]) -> [f32; 4] {
        let attainable = &self.tables.attainable;
        let mut centre = [0.0; 4];
        for (unit, table) in variables.iter_mut().zip(self.tables.units) {
            rolled();
            let efforts = self.efforts(unit.rotors);
            for (column, efforts) in unit.columns.iter_mut().zip(efforts) {
                rolled();
                *column = self.given(table, efforts);
            }
            unit.subtract(inside(attainable.centre, unit.rotors), &mut centre);
        }
        centre.map(|row| -row)
    }

    /// Writes the units' coordinates that serve `request`.
    #[inline(always)]
    fn serve(&self, request: &[f32; 4], variables: &mut [Variable], units: usize) {
        let centre = self.prepare(variables);
        let mut wanted = [0, 1, 2, 3].map(|k| request[k] * self.rows[k]);
        match self.programme(&mut wanted, &centre, variables, self.is_whole) {
            Some(share) => self.draw_back(share, variables, units),
            None => self.retreat(request, variables),
        }
    }

    /// The wrench of all units, N m and N. Both rotors of each work.
    #[inline(never)]
    fn wrench(&self, variables: &[Variable]) -> [f32; 4] {
        let scale = self.tables.attainable.scale;
        let mut wrench = [0.0; 4];
        for (unit, table) in black_box(variables).iter().zip(self.tables.units) {
            rolled();
            let efforts = [0, 1].map(|k| scale[k] * unit.at[k]);
            table.add_wrench(efforts, self.factors, &mut wrench);
        }
        wrench
    }

    /// Takes the units from the stored level flight nearest the thrust asked towards the torques
    /// asked, as far as the polygons allow. So no axis is reversed or exceeded, and the direction of
    /// (roll, pitch) is kept, whatever the programme has come to.
    #[inline(never)]
    fn retreat(&self, &[roll, pitch, yaw, thrust]: &[f32; 4], variables: &mut [Variable]) {
        let variables = black_box(variables);
        let level = &self.tables.level;
        let [least, largest] = level.thrust_n;
        let share = clamp((thrust / self.factors[0] - least) / (largest - least), 0.0, 1.0);
        for (unit, [at_least, at_largest]) in variables.iter_mut().zip(level.efforts) {
            rolled();
            unit.at = between(*at_least, *at_largest, share);
        }
        // With tilted axes the stored efforts are level at the reference voltage only. At others yaw,
        // whose authority is the least, is off by most.
        let [off_roll, off_pitch, off_yaw, _] = self.wrench(variables);
        if off_yaw.abs() > self.tables.tolerance.wrench[2] {
            self.move_by_least_norm(&[-off_roll, -off_pitch, -off_yaw, 0.0], variables, Way::By);
        }
        self.move_by_least_norm(&[roll, pitch, yaw, 0.0], variables, Way::By);
    }

    /// Draws the units back to a share of the way from their centres, and from there moves them
    /// towards the efforts of least norm for the same wrench.
    #[inline(never)]
    fn draw_back(&self, share: f32, variables: &mut [Variable], units: usize) {
        let attainable = &self.tables.attainable;
        let (variables, units) = black_box((variables, units));
        for unit in variables.iter_mut().take(units) {
            rolled();
            unit.at = between(inside(attainable.centre, unit.rotors), unit.at, share);
        }
        if self.is_whole {
            self.move_by_least_norm(&self.wrench(variables), variables, Way::To);
        }
    }

    /// The linear programme for a request in rows. Limits the request ([`shortage::write`]), writes
    /// the variables' coordinates, and returns the share to which they have to be drawn back. Where
    /// the budget ends first: `None` while all rotors work, with rotors out level flight. `is_whole`
    /// is the frame's: where it is known, the compiler leaves the other way out of a function that it
    /// is handed to.
    #[inline(never)]
    fn programme(
        &self,
        wanted: &mut [f32; 4],
        centre: &[f32; 4],
        variables: &mut [Variable],
        is_whole: bool,
    ) -> Option<f32> {
        let units = variables.len().saturating_sub(SHORTAGES);
        let desaturation = &self.tables.desaturation;
        let (budget, mut rounds) = if is_whole {
            (desaturation.budget, 0)
        } else {
            (Budget::with_rotors_out(units), Budget::ROUNDS)
        };
        let reserve = desaturation.yaw_reserve_nm * self.rows[2];
        shortage::write(variables, units, wanted, centre, desaturation.airmode, reserve);
        let mut simplex = Simplex::start(
            variables,
            self.tables.attainable.corners,
            wanted,
            centre,
            desaturation.airmode,
            budget,
        );
        let mut share = None;
        loop {
            if !simplex.solve() {
                if is_whole || share.is_some() {
                    // What the round before has placed stays, if there was one.
                    return share;
                }
                simplex.level_off(wanted, Budget::for_level_flight(units));
                simplex.solve();
            }
            simplex.place();
            let beyond = simplex.variables.get(units + RAY).map_or(0.0, |ray| ray.at[0]);
            let drawn_back = 1.0 / (1.0 + positive(beyond) * shortage::REACH);
            share = Some(drawn_back);
            if rounds == 0 || !self.bend(&mut simplex, drawn_back) {
                return share;
            }
            rounds -= 1;
        }
    }

    /// Takes single rotors from their chords to their curves at the thrusts that they have come to
    /// when drawn back by `share`; false where they were there.
    #[inline(never)]
    fn bend(&self, simplex: &mut Simplex<'_>, share: f32) -> bool {
        let tables = self.tables;
        let mut has_moved = false;
        for (unit, table) in simplex.variables.iter_mut().zip(tables.units) {
            rolled();
            if !unit.rotors.is_single() {
                continue;
            }
            let [along, low] = self.efforts(unit.rotors);
            let x = 0.5 + share * (unit.at[0] - 0.5);
            let [f, chord] = [0, 1].map(|k| low[k] + x * along[k]);
            let throttles = unit.rotors.invert(&tables.singles, &tables.throttle, f);
            let [_, torque] = unit.rotors.efforts(tables, throttles);
            let extra = (torque - chord) / share;
            let change = extra - unit.rate[1];
            if change.abs() > TOUCHING * tables.attainable.scale[1] {
                has_moved = true;
                unit.rate[1] = extra;
                let given = self.given(table, [0.0, change]);
                for (residual, row) in simplex.residual.iter_mut().zip(given) {
                    *residual -= row;
                }
            }
        }
        has_moved
    }
}
