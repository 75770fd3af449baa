//! Allocation and desaturation of any frame: tilted axes, any number of units, rotors out, every
//! airmode, a reserve of yaw. `docs/allocation.md` explains it.
//!
//! Every unit's attainable set is a small convex polygon inside the real one; a unit with a single
//! rotor has a curve. A request is served as far as these allow by one linear programme
//! ([`programme`]), which the simplex method solves ([`simplex`]):
//!
//! ```text
//! 1. efforts of least norm; where they are inside all polygons they are the answer
//! 2. the programme for the request
//! 3. towards the efforts of least norm as far as the polygons allow
//! ```
//!
//! Every answer of the programme is judged by what its efforts give ([`Wanted::accepts`]), not by how
//! it came about: an axis that is reversed or exceeded is not accepted. With all rotors the answer
//! then is on the way from stored level flight to there, as far as the polygons and the axes allow.
//!
//! With rotors out the curves of single rotors take the place of their chords until the efforts are
//! on them. Where that answer is not accepted, the throttles of single rotors are decided, and the
//! programme for the others, which is convex, is solved. Where that is not accepted either, the answer
//! is level flight.
//!
//! # Bound
//!
//! [`Desaturation::budget`](crate::desaturation::Desaturation::budget) bounds the work of 2 while
//! all rotors work. With rotors out [`Budget::with_rotors_out`] and [`Budget::ROUNDS`] do, for three
//! programmes at most. No loop depends on anything else than these, the number of units and the
//! corners of polygons.

use core::hint::black_box;

mod basis;
mod breakpoint;
mod problem;
mod programme;
mod simplex;
mod ties;
mod variable;

pub use variable::Variable;

use crate::desaturation::Budget;
use crate::layout::Tables;
use crate::pair::Quantity;
use crate::{clamp, divisor, rolled};
use problem::{ANY, Problem, Wanted};
use programme::{RAY, REACH, start};
use simplex::Simplex;
use variable::{Set, between, positive};

/// A single rotor is on its curve where its torque is off by no more than this share of what yaw may
/// be missed by.
const TOUCHING: f32 = 0.5;

/// A frame at one voltage.
struct Frame<'a, 't, P, I, S> {
    tables: &'a Tables<'t, P, I, S>,
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
}

/// Writes attainable efforts (`[f, Q]` at the reference voltage, N and N m, in the variables) that
/// serve `request` (`[roll, pitch, yaw, thrust]`, bounded) in the order of priority. `factors` is
/// `[k_f, k_Q]`. There is a variable per unit, which has the unit's rotors. `is_whole` tells that
/// all rotors work. True where these are the efforts of least norm, with all rotors.
#[inline(never)]
pub(crate) fn allocate<P: Quantity, I, S>(
    tables: &Tables<'_, P, I, S>,
    request: &[f32; 4],
    factors: [f32; 2],
    variables: &mut [Variable],
    is_whole: bool,
) -> bool {
    // With the tables or the number of units known the compiler would write every loop over them out.
    let (tables, variables) = black_box((tables, variables));
    let frame = Frame { tables, factors };
    let is_least_norm = is_whole && frame.is_least_norm(request, variables);
    if !is_least_norm {
        frame.serve(request, variables, is_whole);
    }
    let scale = tables.attainable.scale;
    for unit in variables {
        rolled();
        unit.at = [0, 1].map(|k| scale[k] * unit.at[k]);
    }
    is_least_norm
}

impl<P: Quantity, I, S> Frame<'_, '_, P, I, S> {
    /// Scaled efforts per N and N m at this voltage.
    #[inline(always)]
    fn per_effort(&self) -> [f32; 2] {
        let scale = self.tables.attainable.scale;
        [0, 1].map(|k| 1.0 / (self.factors[k] * scale[k]))
    }

    /// Puts the units at the efforts of least norm, M+ u; true where all are inside their polygons.
    #[inline(never)]
    fn is_least_norm(&self, request: &[f32; 4], variables: &mut [Variable]) -> bool {
        let per_effort = self.per_effort();
        let corners = black_box(self.tables.attainable.polygon());
        for (variable, unit) in variables.iter_mut().zip(self.tables.units) {
            rolled();
            let [f, q] = unit.efforts(request);
            variable.at = [f * per_effort[0], q * per_effort[1]];
            for corner in corners {
                rolled();
                if corner.outward(variable.at) > corner.bound {
                    return false;
                }
            }
        }
        true
    }

    /// Moves all units along their rates by `share` at most, as far as the polygons allow.
    #[inline(never)]
    fn advance(&self, variables: &mut [Variable], mut share: f32) {
        for variable in variables.iter() {
            rolled();
            for corner in self.tables.attainable.polygon() {
                rolled();
                let out = corner.outward(variable.rate);
                let beyond = corner.beyond(variable.at);
                if out > 0.0 && share * out + beyond > 0.0 {
                    share = positive(-beyond) / divisor(out);
                }
            }
        }
        for variable in variables {
            rolled();
            variable.at = [0, 1].map(|k| variable.at[k] + share * variable.rate[k]);
        }
    }

    /// Sets the units' rates to the efforts of least norm for a wrench, N m and N.
    #[inline(never)]
    fn aim_at_least_norm(&self, wrench: &[f32; 4], variables: &mut [Variable]) {
        let per_effort = self.per_effort();
        for (variable, unit) in variables.iter_mut().zip(self.tables.units) {
            rolled();
            let efforts = unit.efforts(wrench);
            variable.rate = [0, 1].map(|k| efforts[k] * per_effort[k]);
        }
    }

    /// Moves the units towards the efforts of least norm for the same wrench, as far as the polygons
    /// allow.
    #[inline(never)]
    fn move_to_least_norm(&self, variables: &mut [Variable]) {
        self.aim_at_least_norm(&self.wrench(variables), variables);
        for variable in variables.iter_mut() {
            rolled();
            variable.rate = [0, 1].map(|k| variable.rate[k] - variable.at[k]);
        }
        self.advance(variables, 1.0);
    }

    /// Moves the units of a programme that is solved to the optimum nearest the efforts of least norm
    /// for the same wrench, where optima tie.
    #[inline(never)]
    fn break_ties(&self, simplex: &mut Simplex<'_>) {
        if !simplex.is_tied() {
            return;
        }
        self.aim_at_least_norm(&self.wrench(simplex.variables), simplex.variables);
        simplex.move_to_nearest();
    }

    /// The wrench of all units, N m and N. Both rotors of each work.
    #[inline(never)]
    fn wrench(&self, variables: &[Variable]) -> [f32; 4] {
        let scale = self.tables.attainable.scale;
        let mut wrench = [0.0; 4];
        for (variable, unit) in variables.iter().zip(self.tables.units) {
            rolled();
            let efforts = [0, 1].map(|k| scale[k] * variable.at[k]);
            unit.add_wrench(efforts, self.factors, &mut wrench);
        }
        wrench
    }

    /// Writes the units' scaled efforts that serve `request`. `is_whole` tells that all rotors work:
    /// where it is known, the compiler leaves the other way out of what it is handed to.
    #[inline(always)]
    fn serve(&self, request: &[f32; 4], variables: &mut [Variable], is_whole: bool) {
        let Frame { tables, factors } = *self;
        let per_row = 1.0 / factors[0];
        let problem = Problem::new(tables, factors[1] / factors[0]);
        let rows = [0, 1, 2, 3].map(|k| request[k] * (tables.rows[k] * per_row));
        let reserve = tables.desaturation.yaw_reserve_nm * (tables.rows[2] * per_row);
        let wanted = problem.wanted(rows, reserve);
        if !is_whole {
            self.serve_with_rotors_out(&problem, wanted, variables);
            return;
        }
        let is_solved = self.programme(&problem, &wanted, variables, tables.desaturation.budget, is_whole);
        let missed = problem.missed(&wanted.rows, variables);
        if !is_solved || !wanted.accepts(&missed, variables.len()) {
            self.set_out_from_level_flight(&problem, (&wanted, &missed), request[3], variables);
        }
    }

    /// Programmes until one is accepted: for the request; for the request without a reserve, with the
    /// throttles of single rotors decided; for level flight.
    #[inline(never)]
    fn serve_with_rotors_out(&self, problem: &Problem<'_>, mut wanted: Wanted, variables: &mut [Variable]) {
        if self.is_accepted(problem, &wanted, variables, false) {
            return;
        }
        let is_reserved = wanted.reserve > 0.0;
        wanted.reserve = 0.0;
        let has_single = variables.iter().any(|variable| variable.rotors.is_single());
        if (is_reserved || has_single) && self.is_accepted(problem, &wanted, variables, true) {
            return;
        }
        let [.., thrust] = wanted.rows;
        let level = Wanted::new([0.0, 0.0, 0.0, thrust], 0.0);
        self.is_accepted(problem, &level, variables, false);
    }

    /// Runs a programme with rotors out; true where it is solved and what the units then give neither
    /// reverses nor exceeds a torque. `is_decided` leaves single rotors at the throttles that they have.
    #[inline(never)]
    fn is_accepted(
        &self,
        problem: &Problem<'_>,
        wanted: &Wanted,
        variables: &mut [Variable],
        is_decided: bool,
    ) -> bool {
        for variable in variables.iter_mut() {
            rolled();
            if is_decided {
                variable.decide();
            } else {
                variable.reset();
            }
        }
        let budget = Budget::with_rotors_out(variables.len(), is_decided);
        let is_solved = self.programme(problem, wanted, variables, budget, false);
        let missed = problem.missed(&wanted.rows, variables);
        is_solved && wanted.accepts(&missed, variables.len())
    }

    /// Puts a unit with a single rotor on the rotor's curve, at the throttle for the unit's thrust.
    #[inline(never)]
    fn put_on_curve(&self, variable: &mut Variable) {
        let Tables {
            singles, throttle, ..
        } = self.tables;
        let scale = self.tables.attainable.scale;
        let curve = variable.rotors.curve(singles);
        variable.throttle = curve.invert(throttle, scale[0] * variable.at[0]);
        let efforts = curve.efforts(variable.throttle);
        variable.at = [0, 1].map(|k| efforts[k] / scale[k]);
    }

    /// Puts the units at the answer of the linear programme; true where it is solved. While some single
    /// rotor is beside its curve, its line moves there, and the programme goes on.
    #[inline(never)]
    fn programme(
        &self,
        problem: &Problem<'_>,
        wanted: &Wanted,
        variables: &mut [Variable],
        budget: Budget,
        is_whole: bool,
    ) -> bool {
        let tables = self.tables;
        let centre = if is_whole {
            let [by_thrust, by_torque] = &tables.centre;
            [0, 1, 2, 3].map(|k| by_thrust[k] + problem.ratio * by_torque[k])
        } else {
            problem.centre(variables)
        };
        let touching = TOUCHING * tables.tolerance.wrench[2] / tables.attainable.scale[1];
        let mut rounds = if is_whole { 0 } else { Budget::ROUNDS };
        let mut simplex = start(
            problem,
            variables,
            wanted,
            centre,
            tables.desaturation.airmode,
            budget,
        );
        loop {
            let is_solved = simplex.solve();
            let beyond = clamp(simplex.place(RAY), -0.5, 1.5);
            let share = 1.0 / (1.0 + beyond * REACH);
            for variable in simplex.variables.iter_mut() {
                rolled();
                variable.at = between(variable.inside(problem.set), variable.at, share);
            }
            if is_whole {
                if is_solved && share >= 1.0 {
                    self.break_ties(&mut simplex);
                } else if is_solved {
                    self.move_to_least_norm(simplex.variables);
                }
                return is_solved;
            }
            let beside = self.bend(&mut simplex, share);
            if !is_solved || rounds == 0 || beside <= touching {
                return is_solved;
            }
            rounds -= 1;
        }
    }

    /// Puts single rotors on their curves at the thrusts that they have come to, drawn back by `share`,
    /// and moves their lines there; returns how far the torques were beside, at most.
    #[inline(never)]
    fn bend(&self, simplex: &mut Simplex<'_>, share: f32) -> f32 {
        let problem = simplex.problem;
        let mut most = 0.0;
        for (variable, unit) in simplex.variables.iter_mut().zip(problem.units) {
            rolled();
            if variable.set != Set::Segment {
                continue;
            }
            let [_, on_line] = variable.at;
            self.put_on_curve(variable);
            let beside = variable.at[1] - on_line;
            if beside.abs() > most {
                most = beside.abs();
            }
            let change = variable.next_move(beside / share);
            variable.curve += change;
            problem.subtract(unit, [0.0, change], &mut simplex.residual);
        }
        most
    }

    /// Takes the units from the stored level flight nearest the thrust asked, N, to where they are, as
    /// far as the polygons allow and no torque is reversed or exceeded. `missed` is what they miss
    /// there.
    #[inline(never)]
    fn set_out_from_level_flight(
        &self,
        problem: &Problem<'_>,
        (wanted, missed): (&Wanted, &[f32; 4]),
        thrust: f32,
        variables: &mut [Variable],
    ) {
        let level = &self.tables.level;
        let [least, largest] = level.thrust_n;
        let along = clamp(
            (thrust / self.factors[0] - least) / divisor(largest - least),
            0.0,
            1.0,
        );
        // With tilted axes the stored efforts are level at the reference voltage only. At others yaw,
        // whose authority is the least, is off by most.
        // The programme's efforts wait in `gain`.
        for (variable, [at_least, at_largest]) in variables.iter_mut().zip(level.efforts) {
            rolled();
            variable.gain = variable.at;
            variable.at = between(*at_least, *at_largest, along);
        }
        let [roll, pitch, yaw, _] = self.wrench(variables);
        if yaw.abs() > self.tables.tolerance.wrench[2] {
            self.aim_at_least_norm(&[-roll, -pitch, -yaw, 0.0], variables);
            self.advance(variables, 1.0);
        }
        let mut from = problem.missed(&wanted.rows, variables);
        if self.tables.desaturation.airmode.may_raise_thrust() {
            from[3] = ANY;
        }
        let share = wanted.sound_share(&from, missed, variables.len());
        for variable in variables.iter_mut() {
            rolled();
            variable.rate = [0, 1].map(|k| variable.gain[k] - variable.at[k]);
        }
        self.advance(variables, share);
    }
}
