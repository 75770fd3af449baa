//! A bounded dual simplex method in four rows over small convex sets.
//!
//! The programme is
//!
//! ```text
//! most   sum_i bias_i . y_i - sum_j cost_j s_j
//!  over  y_i in the set of unit i,  s_j in [0, 1]
//!  with  sum_i B_i y_i + sum_j a_j s_j = w         rows roll, pitch, yaw, thrust
//! ```
//!
//! Multipliers lambda of the rows put every unit at the corner with the largest gain (B_i^T lambda +
//! bias_i) . y_i, and every segment at an end. Such a choice is optimal but misses the rows. Four
//! slots of the basis make up for that. A pivot has five steps:
//!
//! ```text
//! price       the slot that is furthest outside its bounds
//! release     it goes to its bound; lambda moves in the direction that brings it back
//! ratio test  what turns first takes the slot; units and segments pass on to their next corner or
//!             end while the slot stays outside (long steps, Maros 2003)
//! enter       the column of what takes the slot
//! update      lambda, and the inverse of the basis
//! ```
//!
//! Lambda stays within a price per row. Where it comes to that first, the row is missed: what it is
//! missed by takes the slot.

use super::basis::{Basis, Holds, Slot, TOLERANCE};
use super::breakpoint::{Breakpoint, FirstTwo};
use super::problem::{Problem, SEGMENTS};
use super::variable::{NEVER, Position, Segment, Set, Variable, corner, dot};
use crate::desaturation::Budget;
use crate::layout::Unit;
use crate::{divisor, rolled};

/// A unit that is free is left alone within this distance of its polygon, scaled efforts.
const TOLERANCE_OF_POLYGON: f32 = 1e-5;

/// Rates of multipliers below this are rounding.
const LEAST_RATE: f32 = 1e-4;

/// A slot further outside its bounds has come from a pivot that is rounding. The programme ends there:
/// the squares of what further pivots would make of it overflow.
const SENSELESS: f32 = 1e6;

/// Indices of what may enter: a unit, a segment or a row.
const SEGMENT: u8 = 64;
const ROW: u8 = 128;

/// A slot outside its bounds.
struct Leaving {
    slot: usize,
    is_above: bool,
    violation: f32,
    /// Of a free unit: the edge that it is beyond, and the slot of its torque.
    edge: u8,
    torque: usize,
}

/// A programme and how far it is solved.
pub(super) struct Simplex<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) basis: Basis,
    pub(super) variables: &'a mut [Variable],
    pub(super) segments: [Segment; SEGMENTS],
    /// w less all that does not depend on the basis.
    pub(super) residual: [f32; 4],
    pub(super) multipliers: [f32; 4],
    /// The values of the slots.
    pub(super) values: [f32; 4],
    /// The last dual step, which the gains do not yet have.
    pub(super) step: f32,
    /// The pivots and moves that are left.
    pub(super) budget: Budget,
}

impl Simplex<'_> {
    /// Pivots until all slots are within their bounds; false where the budget ends first.
    #[inline(never)]
    pub(super) fn solve(&mut self) -> bool {
        loop {
            let leaving = self.price();
            if leaving.violation <= 0.0 {
                return true;
            }
            if self.budget.pivots == 0 || leaving.violation > SENSELESS {
                return false;
            }
            self.budget.pivots -= 1;
            let (slot, direction) = self.release(&leaving);
            let (step, entering) = self.ratio_test(&direction, leaving.violation);
            self.step = step;
            for (multiplier, part) in self.multipliers.iter_mut().zip(direction) {
                *multiplier += step * part;
            }
            self.enter(entering, slot, &direction);
        }
    }

    /// The slot furthest outside its bounds, each measured by how far lambda moves to bring it back
    /// (steepest edge). Without a violation where all are within.
    #[inline(always)]
    fn price(&mut self) -> Leaving {
        let mut found = Leaving {
            slot: 0,
            is_above: false,
            violation: 0.0,
            edge: 0,
            torque: 0,
        };
        let mut best = 0.0;
        let rows = self.basis.inverse.iter().zip(&self.basis.slots);
        for (index, ((row, slot), value)) in rows.zip(&mut self.values).enumerate() {
            let x = dot(row, &self.residual);
            *value = x;
            if x.to_bits() > slot.limit {
                let is_above = x > 0.0;
                let violation = if is_above { x - slot.high } else { -x };
                let (score, size) = (violation * violation, dot(row, row));
                if violation > TOLERANCE && score > best * size && size > 0.0 {
                    best = score / divisor(size);
                    (found.slot, found.is_above, found.violation) = (index, is_above, violation);
                }
            }
        }
        if self.basis.has_free {
            self.price_free(&mut found, best);
        }
        found
    }

    /// As [`price`](Self::price), of units that are free in their polygons.
    #[inline(never)]
    fn price_free(&self, found: &mut Leaving, mut best: f32) {
        for (index, slot) in self.basis.slots.iter().enumerate() {
            rolled();
            if slot.holds != Holds::Thrust {
                continue;
            }
            let torque = self.basis.slot_of(Holds::Torque, slot.of);
            let point = [self.values[index & 3], self.values[torque & 3]];
            for (edge, corner) in (0u8..).zip(self.problem.set.polygon()) {
                rolled();
                let beyond = corner.beyond(point);
                if beyond > TOLERANCE_OF_POLYGON {
                    let across = self.basis.across(corner, index, torque);
                    let (score, size) = (beyond * beyond, dot(&across, &across));
                    if score > best * size && size > 0.0 {
                        best = score / divisor(size);
                        *found = Leaving {
                            slot: index,
                            is_above: true,
                            violation: beyond,
                            edge,
                            torque,
                        };
                    }
                }
            }
        }
    }

    /// A unit of this index with its table, and the residual.
    #[inline(always)]
    fn parts(&mut self, index: u8) -> Option<(&mut Variable, &Unit, &mut [f32; 4])> {
        let variable = self.variables.get_mut(usize::from(index))?;
        let unit = self.problem.units.get(usize::from(index))?;
        Some((variable, unit, &mut self.residual))
    }

    /// Moves what leaves to its bound; returns the slot that becomes free and the direction of
    /// lambda.
    #[inline(always)]
    fn release(&mut self, leaving: &Leaving) -> (usize, [f32; 4]) {
        let slot = leaving.slot & 3;
        let Slot { holds, of, .. } = self.basis.slots[slot];
        match holds {
            Holds::Thrust | Holds::Torque => return self.release_free(leaving),
            Holds::Edge => {
                let problem = self.problem;
                if let Some((variable, unit, residual)) = self.parts(of) {
                    variable.position = Position::Corner;
                    if variable.set == Set::Segment {
                        (variable.gain, variable.rate) = ([0.0; 2], [0.0; 2]);
                    }
                    if leaving.is_above {
                        let corner = corner(problem.set.corners, variable.corner);
                        problem.subtract(unit, corner.ways[0], residual);
                        variable.corner = corner.links[0];
                    }
                }
            }
            Holds::Along => {
                if let Some(segment) = self.segments.get_mut(usize::from(of)) {
                    (segment.is_basic, segment.gain, segment.rate) = (false, 0.0, 0.0);
                    if leaving.is_above {
                        segment.turn(&mut self.residual);
                    }
                }
            }
            Holds::Row => {}
        }
        let sign = if leaving.is_above { 1.0 } else { -1.0 };
        (slot, self.basis.inverse[slot].map(|part| sign * part))
    }

    /// As [`release`](Self::release), of a unit that is free in its polygon: it goes to the edge that
    /// it is beyond.
    #[inline(never)]
    fn release_free(&mut self, leaving: &Leaving) -> (usize, [f32; 4]) {
        let (slot, torque) = (leaving.slot & 3, leaving.torque & 3);
        let of = self.basis.slots[slot].of;
        let problem = self.problem;
        let corner = corner(problem.set.corners, leaving.edge);
        let direction = self.basis.across(corner, slot, torque);
        let [e0, e1] = corner.ways[0];
        let per_square = 1.0 / (e0 * e0 + e1 * e1);
        self.basis.turn(slot, torque, [e0 * per_square, e1 * per_square]);
        self.basis.slots[slot] = Slot::new(1.0, Holds::Edge, of);
        self.basis.has_free = self.basis.slots.iter().any(|slot| slot.holds == Holds::Thrust);
        if let Some((variable, unit, residual)) = self.parts(of) {
            (variable.position, variable.corner) = (Position::Edge, leaving.edge);
            (variable.gain, variable.rate) = ([0.0; 2], [0.0; 2]);
            problem.subtract(unit, corner.at, residual);
        }
        (torque, direction)
    }

    /// Passes breakpoints in a direction of lambda while what leaves stays outside its bounds;
    /// returns the dual step and what enters.
    #[inline(always)]
    fn ratio_test(&mut self, direction: &[f32; 4], mut violation: f32) -> (f32, u8) {
        let limit = self.first_price(direction);
        let FirstTwo([mut first, mut second]) = self.look_ahead(direction, limit);
        loop {
            let entering = (first.step(), first.of);
            if self.budget.flips == 0 || first.of >= ROW {
                return entering;
            }
            let corners = self.problem.set.corners;
            let problem = self.problem;
            if first.of >= SEGMENT {
                let Some(segment) = self.segments.get_mut(usize::from(first.of - SEGMENT)) else {
                    return entering;
                };
                violation -= segment.rate;
                if violation <= 0.0 {
                    return entering;
                }
                segment.turn(&mut self.residual);
                segment.breakpoint = NEVER;
                first.bits = i32::MAX;
            } else {
                let Some((variable, unit, residual)) = self.parts(first.of) else {
                    return entering;
                };
                let (way, _) = variable.way(corners);
                violation -= way[0] * variable.rate[0] + way[1] * variable.rate[1];
                if variable.position == Position::Edge || violation <= 0.0 {
                    return entering;
                }
                problem.subtract_inline(unit, way, residual);
                first.bits = variable.flip(corners, entering.0).to_bits() as i32;
            }
            self.budget.flips -= 1;
            if second.bits == Breakpoint::UNKNOWN {
                first = self.first(limit);
            } else if first.bits > second.bits {
                first = second;
                second.bits = Breakpoint::UNKNOWN;
            }
        }
    }

    /// The dual step at which the first multiplier is at its row's price.
    #[inline(always)]
    fn first_price(&self, direction: &[f32; 4]) -> Breakpoint {
        let [roll, pitch, yaw, too_little, too_much] = self.problem.prices;
        let [.., thrust] = *direction;
        let prices = [roll, pitch, yaw, if thrust > 0.0 { too_little } else { too_much }];
        let (mut least, mut of) = (NEVER, ROW);
        let rows = direction.iter().zip(&self.multipliers).zip(prices);
        for (row, ((&rate, &multiplier), price)) in (ROW..).zip(rows) {
            let room = price - if rate > 0.0 { multiplier } else { -multiplier };
            let size = rate.abs();
            if room < least * (size - LEAST_RATE) {
                // Without a branch the compiler divides by all rates, also by zero.
                let size = if size > LEAST_RATE { size } else { LEAST_RATE };
                (least, of) = (room / divisor(size), row);
            }
        }
        Breakpoint::new(least, of)
    }

    /// Takes the last dual step, and finds the breakpoints in a direction of lambda: the two that
    /// come first.
    #[inline(always)]
    fn look_ahead(&mut self, direction: &[f32; 4], limit: Breakpoint) -> FirstTwo {
        let mut found = FirstTwo::new(limit);
        let (problem, step) = (self.problem, self.step);
        for (index, (variable, unit)) in (0u8..).zip(self.variables.iter_mut().zip(problem.units)) {
            rolled();
            let mut breakpoint = NEVER;
            if variable.position != Position::Free {
                let rate = problem.gains(unit, direction);
                breakpoint = variable.look_ahead(problem.set.corners, step, rate);
            }
            variable.breakpoint = breakpoint;
            found.consider(index, breakpoint);
        }
        for (index, segment) in (SEGMENT..).zip(&mut self.segments) {
            found.consider(index, segment.look_ahead(step, direction));
        }
        found
    }

    /// The breakpoint that comes first, as they are now.
    #[inline(never)]
    fn first(&self, limit: Breakpoint) -> Breakpoint {
        let mut found = limit;
        for (index, variable) in (0u8..).zip(self.variables.iter()) {
            rolled();
            found.consider(index, variable.breakpoint);
        }
        for (index, segment) in (SEGMENT..).zip(&self.segments) {
            found.consider(index, segment.breakpoint);
        }
        found
    }

    /// Puts what enters into the slot, and its column into the inverse.
    #[inline(always)]
    fn enter(&mut self, entering: u8, slot: usize, direction: &[f32; 4]) {
        let problem = self.problem;
        let mut column = [0.0; 4];
        let mut new = Slot::new(1.0, Holds::Edge, entering);
        let mut is_freed = false;
        if entering >= ROW {
            // A multiplier is at its price: its row is missed.
            let row = entering & 3;
            column[usize::from(row)] = if direction[usize::from(row)] > 0.0 {
                1.0
            } else {
                -1.0
            };
            new = Slot::missed(row);
        } else if entering >= SEGMENT {
            let of = entering - SEGMENT;
            if let Some(segment) = self.segments.get_mut(usize::from(of)) {
                segment.is_basic = true;
                column = segment.column;
            }
            (new.holds, new.of) = (Holds::Along, of);
        } else if let Some((variable, unit, residual)) = self.parts(entering) {
            let from = corner(problem.set.corners, variable.corner);
            is_freed = variable.position == Position::Edge;
            let mut way;
            if is_freed {
                let [e0, e1] = from.ways[0];
                way = [-e1, e0];
            } else {
                variable.position = match variable.set {
                    Set::Polygon => Position::Edge,
                    _ => Position::Free,
                };
                // The place along an edge counts from its start.
                way = from.ways[usize::from(variable.way & 1)];
                if variable.way == 0 {
                    way = way.map(|part| -part);
                } else {
                    variable.corner = from.links[1];
                    problem.subtract(unit, way, residual);
                }
            }
            problem.subtract(unit, way, &mut column);
        }
        if !is_freed {
            self.basis.slots[slot & 3] = new;
        }
        self.basis.exchange(slot, &column);
        if is_freed {
            self.free(entering, slot);
        }
    }

    /// A unit leaves its edge: place along the edge and distance from it become thrust and torque.
    #[inline(never)]
    fn free(&mut self, index: u8, slot: usize) {
        let along = self.basis.slot_of(Holds::Edge, index);
        let problem = self.problem;
        let Some((variable, unit, residual)) = self.parts(index) else {
            return;
        };
        let corner = corner(problem.set.corners, variable.corner);
        variable.position = Position::Free;
        problem.subtract(unit, corner.at.map(|part| -part), residual);
        self.basis.turn(along, slot, corner.ways[0]);
        self.basis.slots[along & 3] = Slot::effort(Holds::Thrust, index);
        self.basis.slots[slot & 3] = Slot::effort(Holds::Torque, index);
        self.basis.has_free = true;
    }

    /// Writes the efforts of all units; returns the share of the ray.
    #[inline(never)]
    pub(super) fn place(&mut self, ray: usize) -> f32 {
        let corners = self.problem.set.corners;
        for variable in self.variables.iter_mut() {
            rolled();
            if variable.set != Set::Point {
                let [f, q] = corner(corners, variable.corner).at;
                variable.at = [f, q + variable.curve];
            }
        }
        let mut beyond = 0.0;
        if let Some(segment) = self.segments.get(ray) {
            beyond = segment.share(0.0);
        }
        for (slot, &value) in self.basis.slots.iter().zip(&self.values) {
            rolled();
            if slot.holds == Holds::Along && usize::from(slot.of) == ray {
                beyond = self.segments.get(ray).map_or(0.0, |segment| segment.share(value));
            }
            let Some(variable) = self.variables.get_mut(usize::from(slot.of)) else {
                continue;
            };
            match slot.holds {
                Holds::Edge => {
                    let edge = corner(corners, variable.corner).ways[0];
                    variable.at = [0, 1].map(|k| variable.at[k] + value * edge[k]);
                }
                Holds::Thrust => variable.at[0] = value,
                Holds::Torque => variable.at[1] = value,
                Holds::Row | Holds::Along => {}
            }
        }
        beyond
    }
}
