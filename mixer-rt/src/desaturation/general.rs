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
//! Where the pivots end before the programme of 2 is solved, its basis serves the rows, but units may
//! be outside their polygons: the answer is on the way from stored level flight to there, as far as
//! the polygons allow.
//!
//! With rotors out the curves of single rotors take the place of their chords until the efforts are
//! on them. If they do not settle, or the pivots end, the throttles of single rotors are decided, and
//! the programme for the others, which is convex, is solved. If that serves no torque, the torques are
//! given up.
//!
//! # Bound
//!
//! [`Desaturation::budget`](crate::desaturation::Desaturation::budget) bounds the work of 2 while
//! all rotors work. With rotors out [`Budget::with_rotors_out`], [`Budget::ROUNDS`] and
//! [`Budget::PROGRAMMES`] do. No loop depends on anything else than these, the number of units and
//! the corners of polygons.

use core::hint::black_box;

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
use problem::Problem;
use programme::{RAY, REACH, start};
use simplex::Simplex;
use variable::{Set, between, positive};

/// A single rotor is on its curve where its torque is off by no more than this share of what yaw may
/// be missed by.
const TOUCHING: f32 = 0.25;

/// How far a torque may be from its curve where it does not settle, as a share of the torque's scale.
const BESIDE: f32 = 5e-4;

/// A frame at one voltage.
struct Frame<'a, 't, P, I, S> {
    tables: &'a Tables<'t, P, I, S>,
    /// `[k_f, k_Q]`.
    factors: [f32; 2],
}

/// How a programme has ended; the units are where it has left them.
struct Ending {
    /// To which share of the way from their centres they have to be drawn back.
    share: f32,
    is_solved: bool,
    /// The share of the wrench that exceeds no axis; `None` where a torque is missed.
    served: Option<f32>,
    /// How far the torque of a single rotor is from its curve, scaled.
    beside: f32,
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

    /// The share of its rate by which a unit may move, at most `share`: until it is at the border of
    /// its polygon.
    #[inline(never)]
    fn reach(&self, variable: &Variable, mut share: f32) -> f32 {
        for corner in self.tables.attainable.polygon() {
            rolled();
            let out = corner.outward(variable.rate);
            let beyond = corner.beyond(variable.at);
            if out > 0.0 && share * out + beyond > 0.0 {
                share = positive(-beyond) / divisor(out);
            }
        }
        share
    }

    /// Moves all units along their rates.
    #[inline(never)]
    fn advance(&self, variables: &mut [Variable], share: f32) {
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
        let mut share = 1.0;
        for variable in variables.iter_mut() {
            rolled();
            variable.rate = [0, 1].map(|k| variable.rate[k] - variable.at[k]);
            share = self.reach(variable, share);
        }
        self.advance(variables, share);
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
        let per_row = 1.0 / self.factors[0];
        let wanted = [0, 1, 2, 3].map(|k| request[k] * (self.tables.rows[k] * per_row));
        let reserve = self.tables.desaturation.yaw_reserve_nm * (self.tables.rows[2] * per_row);
        let ending = if is_whole {
            for variable in variables.iter_mut() {
                rolled();
                variable.reset();
            }
            self.programme(
                wanted,
                reserve,
                variables,
                self.tables.desaturation.budget,
                is_whole,
            )
        } else {
            self.serve_with_rotors_out(wanted, reserve, variables)
        };
        if ending.is_solved && ending.share >= 1.0 {
            return;
        }
        let set = &self.tables.attainable;
        for variable in variables.iter_mut() {
            rolled();
            variable.at = between(variable.inside(set), variable.at, ending.share);
        }
        if !is_whole {
            return;
        }
        if ending.is_solved {
            self.move_to_least_norm(variables);
        } else {
            self.set_out_from_level_flight(request, ending.served, variables);
        }
    }

    /// [`programme`](Self::programme) with rotors out, until its answer is on the curves of single
    /// rotors and misses no torque, or none does.
    #[inline(never)]
    fn serve_with_rotors_out(&self, wanted: [f32; 4], reserve: f32, variables: &mut [Variable]) -> Ending {
        let mut ending = self.settle(wanted, reserve, variables);
        if reserve > 0.0 && ending.served.is_none() {
            ending = self.settle(wanted, 0.0, variables);
        }
        if !ending.is_solved {
            let [.., thrust] = wanted;
            ending = self.settle([0.0, 0.0, 0.0, thrust], 0.0, variables);
        }
        ending
    }

    /// A programme, and if its single rotors do not settle on their curves or its pivots end, another
    /// one in which their throttles are decided. One that misses a torque then is not solved.
    #[inline(never)]
    fn settle(&self, wanted: [f32; 4], reserve: f32, variables: &mut [Variable]) -> Ending {
        let budget = Budget::with_rotors_out(variables.len());
        for variable in variables.iter_mut() {
            rolled();
            variable.reset();
        }
        let ending = self.programme(wanted, reserve, variables, budget, false);
        if ending.is_solved && ending.beside <= BESIDE {
            return ending;
        }
        for variable in variables.iter_mut() {
            rolled();
            if variable.set == Set::Segment {
                variable.at = self.on_curve(variable, ending.share);
                variable.set = Set::Point;
            }
        }
        let budget = Budget::with_throttles_decided(variables.len());
        let mut ending = self.programme(wanted, reserve, variables, budget, false);
        ending.is_solved &= ending.served.is_some();
        ending
    }

    /// What the single rotor of a unit gives, scaled, at the thrust to which it is drawn back.
    #[inline(never)]
    fn on_curve(&self, variable: &Variable, share: f32) -> [f32; 2] {
        let tables = self.tables;
        let set = &tables.attainable;
        let [f, _] = between(variable.inside(set), variable.at, share);
        let Tables { pair, singles, .. } = tables;
        let throttles = variable
            .rotors
            .invert(singles, &tables.throttle, set.scale[0] * f);
        let efforts = variable.rotors.efforts(pair, singles, throttles);
        [0, 1].map(|k| efforts[k] / set.scale[k])
    }

    /// The linear programme for a request in rows. While some single rotor is beside its curve, its
    /// line moves there, and the programme goes on.
    #[inline(never)]
    fn programme(
        &self,
        wanted: [f32; 4],
        reserve: f32,
        variables: &mut [Variable],
        budget: Budget,
        is_whole: bool,
    ) -> Ending {
        let Frame { tables, factors } = *self;
        let airmode = tables.desaturation.airmode;
        let ratio = factors[1] / factors[0];
        let problem = Problem::new(tables, ratio);
        let centre = if is_whole {
            let [by_thrust, by_torque] = &tables.centre;
            [0, 1, 2, 3].map(|k| by_thrust[k] + ratio * by_torque[k])
        } else {
            problem.centre(variables)
        };
        let touching = TOUCHING * tables.tolerance.wrench[2] / tables.attainable.scale[1];
        let mut rounds = if is_whole { 0 } else { Budget::ROUNDS };
        let mut simplex = start(&problem, variables, [wanted, centre], reserve, airmode, budget);
        loop {
            let mut beside = 0.0;
            let is_solved = simplex.solve();
            let beyond = clamp(simplex.place(RAY), -0.5, 1.5);
            let share = 1.0 / (1.0 + beyond * REACH);
            if !is_whole {
                beside = self.bend(&mut simplex, share);
            }
            if !is_solved || rounds == 0 || beside <= touching {
                if is_whole && is_solved && share >= 1.0 {
                    self.break_ties(&mut simplex);
                }
                // A programme that is solved with all rotors misses no torque.
                let served = if is_whole && is_solved {
                    Some(1.0)
                } else {
                    simplex.served(RAY)
                };
                return Ending {
                    share,
                    is_solved,
                    served,
                    beside,
                };
            }
            rounds -= 1;
        }
    }

    /// Moves the lines of single rotors to their curves at the thrusts that they have come to when
    /// drawn back by `share`; returns how far the torques were beside, at most.
    #[inline(never)]
    fn bend(&self, simplex: &mut Simplex<'_>, share: f32) -> f32 {
        let set = &self.tables.attainable;
        let problem = simplex.problem;
        let mut most = 0.0;
        for (variable, unit) in simplex.variables.iter_mut().zip(self.tables.units) {
            rolled();
            if variable.set != Set::Segment {
                continue;
            }
            let [_, on_line] = between(variable.inside(set), variable.at, share);
            let [_, on_curve] = self.on_curve(variable, share);
            let beside = on_curve - on_line;
            if beside.abs() > most {
                most = beside.abs();
            }
            let change = variable.next_move(beside / share);
            variable.curve += change;
            problem.subtract(unit, [0.0, change], &mut simplex.residual);
        }
        most
    }

    /// Takes the units from the stored level flight nearest the thrust asked to where they are, as far
    /// as the polygons allow and by `served` at most. So no axis is reversed or exceeded, and the
    /// direction of (roll, pitch) is kept.
    #[inline(never)]
    fn set_out_from_level_flight(
        &self,
        &[.., thrust]: &[f32; 4],
        served: Option<f32>,
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
            let mut share = 1.0;
            for variable in variables.iter() {
                rolled();
                share = self.reach(variable, share);
            }
            self.advance(variables, share);
        }
        let Some(mut share) = served else { return };
        for variable in variables.iter_mut() {
            rolled();
            variable.rate = [0, 1].map(|k| variable.gain[k] - variable.at[k]);
            share = self.reach(variable, share);
        }
        self.advance(variables, share);
    }
}
