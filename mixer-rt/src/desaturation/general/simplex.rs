//! A bounded dual simplex method in four rows over small convex sets.
//!
//! The linear programme is
//!
//! ```text
//! most   sum_i bias_i . y_i
//!  over  y_i in the set of variable i
//!  with  sum_i B_i y_i = w               rows roll, pitch, yaw, thrust
//! ```
//!
//! Units and shortages are variables alike ([`variable`](super::variable)); the bias of a shortage
//! is its cost, negative.
//!
//! Multipliers lambda of the rows put every variable at the corner with the largest gain (B_i^T
//! lambda + bias_i) . y_i. Such a choice is optimal but misses the rows. Four slots of the basis
//! make up for that: each is the place along a variable's edge, or one of two slots of a unit that
//! is free in its polygon. A pivot takes the slot that is furthest outside its bounds, moves lambda
//! in the direction that brings it back, and lets the variable whose gain turns first take the
//! slot. A variable at a corner moves to its next corner instead, as long as the slot stays outside
//! (long steps, Maros 2003). A slot that has no variable yet is artificial: its bounds are both
//! zero. Lambda stays within a price per row. Where it comes to that first, the row is missed: what
//! it is missed by takes the slot, without a limit.
//!
//! Any lambda may be the start: nothing has to be known about the frame or its health. Work is
//! bounded by the numbers of pivots and of moves to other corners that are allowed.

use core::hint::black_box;
use core::mem::take;

use super::breakpoint::{Breakpoint, FirstTwo, ROW};
use super::shortage::{SHORTAGES, TORQUE_PRICES, ThrustPrice};
use super::variable::{NEVER, Position, Variable, corner, dot, next, set};
use crate::desaturation::attainable::Corner;
use crate::desaturation::{Airmode, Budget};
use crate::pair::rotors::Rotors;
use crate::rolled;

/// Slots within this distance of their bounds are left alone: of an edge's length, or of a row.
const TOLERANCE: f32 = 3e-5;
const TOLERANCE_OF_POLYGON: f32 = 1e-5;

/// The multipliers at the start, per row of the request's distance from the units' centres: so
/// units start at corners on the request's side. Chosen for the fewest pivots (0.005 to 1 differ by
/// less than a tenth).
const AHEAD: f32 = 2e-2;

/// Rates of multipliers below this are rounding.
const LEAST_RATE: f32 = 1e-4;

const IDENTITY: [[f32; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// What a slot of the basis holds.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
enum Holds {
    /// The part of its row that is missed.
    #[default]
    Artificial,
    /// The part of its row that is missed, at its price.
    Elastic,
    /// The share of the edge on which the variable is.
    Edge,
    /// The first and the second coordinate of a free variable.
    First,
    Second,
}

/// A slot of the basis.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct Slot {
    holds: Holds,
    variable: u8,
}

/// A slot outside its bounds.
#[derive(Default)]
struct Leaving {
    slot: usize,
    /// 1 where it is too large, -1 where it is too small.
    sign: f32,
    violation: f32,
    /// For a free variable: the edge that it is beyond, and the slot of the second coordinate.
    edge: u8,
    second: usize,
}

/// The programme and its state.
pub(super) struct Simplex<'a> {
    /// The units, then the shortages.
    pub(super) variables: &'a mut [Variable],
    /// Of the polygon of units with both rotors.
    corners: &'a [Corner],
    slots: [Slot; 4],
    /// Rows of the inverse of the basis.
    inverse: [[f32; 4]; 4],
    /// w less all that does not depend on the basis.
    pub(super) residual: [f32; 4],
    multipliers: [f32; 4],
    thrust_price: ThrustPrice,
    /// The values of the slots.
    values: [f32; 4],
    /// The last dual step, which the gains do not yet have.
    step: f32,
    /// The pivots and moves that are left.
    budget: Budget,
}

impl<'a> Simplex<'a> {
    /// Starts with artificial slots, with multipliers that point from `centre` (rows) to what is
    /// `wanted`, and with the variables, whose gains are their biases, at the corners that these
    /// make best.
    #[inline(never)]
    pub(super) fn start(
        variables: &'a mut [Variable],
        corners: &'a [Corner],
        wanted: &[f32; 4],
        centre: &[f32; 4],
        airmode: Airmode,
        budget: Budget,
    ) -> Self {
        let multipliers = [0, 1, 2, 3].map(|k| AHEAD * (wanted[k] - centre[k]));
        let mut residual = *wanted;
        for variable in variables.iter_mut() {
            rolled();
            let worth = variable.transposed(&multipliers);
            variable.gain = [0, 1].map(|k| variable.gain[k] + worth[k]);
            (variable.rate, variable.position, variable.is_forward) = ([0.0; 2], Position::Corner, true);
            let set = set(corners, variable.rotors);
            variable.choose_corner(set);
            variable.subtract(corner(set, variable.corner).at, &mut residual);
        }
        Simplex {
            variables,
            corners,
            slots: [Slot::default(); 4],
            inverse: IDENTITY,
            residual,
            multipliers,
            thrust_price: ThrustPrice::of(airmode),
            values: [0.0; 4],
            step: 0.0,
            budget,
        }
    }

    /// Pivots until all slots are within their bounds; false where the budget ends first.
    #[inline(never)]
    pub(super) fn solve(&mut self) -> bool {
        loop {
            for (value, row) in self.values.iter_mut().zip(&self.inverse) {
                *value = dot(row, &self.residual);
            }
            let leaving = self.furthest_outside();
            if leaving.violation <= 0.0 {
                return true;
            }
            if self.budget.pivots == 0 {
                return false;
            }
            self.budget.pivots -= 1;
            self.pivot(&leaving);
        }
    }

    /// Gives the torques up: from where the pivots have come to, asks for no more than the thrust that
    /// is `wanted` (rows), without the shortages, with another `budget`.
    #[inline(never)]
    pub(super) fn level_off(&mut self, [roll, pitch, yaw, _]: &[f32; 4], budget: Budget) {
        let units = self.variables.len().saturating_sub(SHORTAGES);
        let Some((units, shortages)) = take(&mut self.variables).split_at_mut_checked(units) else {
            return;
        };
        for (row, torque) in self.residual.iter_mut().zip([roll, pitch, yaw]) {
            *row -= torque;
        }
        for shortage in shortages {
            rolled();
            let corner = corner(set(self.corners, shortage.rotors), shortage.corner);
            shortage.subtract(corner.at.map(|part| -part), &mut self.residual);
        }
        // A slot that a shortage has keeps its column, and has to come to zero.
        for slot in &mut self.slots {
            if usize::from(slot.variable) >= units.len() && slot.holds == Holds::Edge {
                slot.holds = Holds::Artificial;
            }
        }
        self.variables = units;
        self.budget = budget;
    }

    /// The variable of this index, its set, and the residual.
    #[inline(always)]
    fn parts(&mut self, index: u8) -> Option<(&mut Variable, &'a [Corner], &mut [f32; 4])> {
        let variable = self.variables.get_mut(usize::from(index))?;
        let set = set(self.corners, variable.rotors);
        Some((variable, set, &mut self.residual))
    }

    #[inline(never)]
    fn slot_of(&self, holds: Holds, variable: u8) -> usize {
        let wanted = Slot { holds, variable };
        self.slots.iter().position(|slot| *slot == wanted).unwrap_or(0) & 3
    }

    /// The slot furthest outside its bounds, each measured by how far lambda moves to bring it back
    /// (steepest edge). Without a violation where all are within.
    #[inline(never)]
    fn furthest_outside(&self) -> Leaving {
        let mut found = Leaving::default();
        let mut best = 0.0;
        for (index, (slot, &value)) in self.slots.iter().zip(&self.values).enumerate() {
            rolled();
            let mut consider = |violation: f32, sign: f32, size: &[f32; 4], edge: u8, second: usize| {
                let score = violation * violation;
                let size = dot(size, size);
                if score > best * size {
                    best = score / size;
                    found = Leaving {
                        slot: index,
                        sign,
                        violation,
                        edge,
                        second,
                    };
                }
            };
            let (violation, sign) = match slot.holds {
                _ if value < 0.0 && slot.holds < Holds::First => (-value, -1.0),
                Holds::Edge => (value - 1.0, 1.0),
                Holds::Artificial => (value, 1.0),
                Holds::Elastic | Holds::Second => continue,
                Holds::First => {
                    let second = self.slot_of(Holds::Second, slot.variable);
                    let point = [value, self.values[second]];
                    for (edge, corner) in (0u8..).zip(self.corners) {
                        rolled();
                        let beyond = corner.beyond(point);
                        if beyond > TOLERANCE_OF_POLYGON {
                            consider(beyond, 1.0, &self.across(corner, index, second), edge, second);
                        }
                    }
                    continue;
                }
            };
            if violation > TOLERANCE {
                consider(violation, sign, &self.inverse[index & 3], 0, 0);
            }
        }
        found
    }

    /// The row of the inverse for how far a free unit is beyond an edge.
    #[inline(always)]
    fn across(&self, corner: &Corner, first: usize, second: usize) -> [f32; 4] {
        let (first, second) = (&self.inverse[first & 3], &self.inverse[second & 3]);
        [0, 1, 2, 3].map(|k| corner.outward([first[k], second[k]]))
    }

    /// Moves the leaving variable to its bound; returns the slot that becomes free and the
    /// direction of lambda.
    #[inline(never)]
    fn release(&mut self, leaving: &Leaving) -> (usize, [f32; 4]) {
        let slot = leaving.slot & 3;
        let Slot { holds, variable } = self.slots[slot];
        if holds == Holds::First {
            let second = leaving.second & 3;
            let corner = corner(self.corners, leaving.edge);
            let direction = self.across(corner, slot, second);
            let [e0, e1] = corner.edge;
            let per_square = 1.0 / (e0 * e0 + e1 * e1);
            self.turn(slot, second, [e0 * per_square, e1 * per_square]);
            self.slots[slot].holds = Holds::Edge;
            if let Some((unit, _, residual)) = self.parts(variable) {
                (unit.position, unit.corner) = (Position::Edge, leaving.edge);
                (unit.gain, unit.rate) = ([0.0; 2], [0.0; 2]);
                unit.subtract(corner.at, residual);
            }
            return (second, direction);
        }
        if holds == Holds::Edge
            && let Some((variable, set, residual)) = self.parts(variable)
        {
            variable.position = Position::Corner;
            if variable.rotors != Rotors::Both {
                (variable.gain[0], variable.rate[0]) = (0.0, 0.0);
            }
            if leaving.sign > 0.0 {
                variable.subtract(corner(set, variable.corner).edge, residual);
                variable.corner = next(set, variable.corner);
            }
        }
        (slot, self.inverse[slot].map(|part| leaving.sign * part))
    }

    /// Takes the last dual step, and finds the breakpoints of all variables in a direction of
    /// lambda.
    #[inline(never)]
    fn look_ahead(&mut self, direction: &[f32; 4]) {
        for variable in self.variables.iter_mut() {
            rolled();
            variable.look_ahead(self.corners, self.step, direction);
        }
    }

    /// The breakpoints that come first.
    #[inline(always)]
    fn first_two(&self, limit: Breakpoint) -> FirstTwo {
        let mut found = FirstTwo::new(limit);
        for (index, variable) in (0u8..).zip(self.variables.iter()) {
            rolled();
            found.consider(index, variable.breakpoint);
        }
        found
    }

    /// Passes breakpoints in a direction of lambda while the leaving variable stays outside its
    /// bounds; returns the dual step and what enters: a variable, or the shortage of a row.
    #[inline(never)]
    fn long_step(&mut self, limit: Breakpoint, mut violation: f32) -> (f32, u8) {
        let (mut first, mut second) = (Breakpoint::UNKNOWN, Breakpoint::UNKNOWN);
        loop {
            if first.bits == Breakpoint::UNKNOWN.bits {
                FirstTwo([first, second]) = self.first_two(limit);
            }
            let entering = (first.step(), first.variable);
            if self.budget.flips == 0 {
                return entering;
            }
            let Some((variable, set, residual)) = self.parts(first.variable) else {
                return entering;
            };
            let (_, way) = variable.way(set);
            violation -= (way[0] * variable.rate[0] + way[1] * variable.rate[1]).abs();
            if variable.position == Position::Edge || violation <= 0.0 {
                return entering;
            }
            variable.subtract_inline(way, residual);
            first.bits = variable.flip(set, entering.0).to_bits() as i32;
            self.budget.flips -= 1;
            if second.bits == Breakpoint::UNKNOWN.bits || first.bits > second.bits {
                (first, second) = (second, Breakpoint::UNKNOWN);
            }
        }
    }

    /// One pivot.
    #[inline(always)]
    fn pivot(&mut self, leaving: &Leaving) {
        let (slot, direction) = self.release(leaving);
        let limit = self.first_price(&direction);
        self.look_ahead(&direction);
        let (step, entering) = self.long_step(limit, leaving.violation);
        let mut column = [0.0; 4];
        let mut is_freed = false;
        self.step = step;
        if let Some((variable, set, residual)) = self.parts(entering) {
            let mut way;
            is_freed = variable.position == Position::Edge;
            if is_freed {
                let [e0, e1] = corner(set, variable.corner).edge;
                way = [-e1, e0];
            } else {
                (variable.corner, way) = variable.way(set);
                variable.position = match variable.rotors {
                    Rotors::Both => Position::Edge,
                    _ => Position::Free,
                };
                if variable.is_forward {
                    way = way.map(|part| -part);
                } else {
                    // The place along an edge counts from its start.
                    variable.subtract(way, residual);
                }
            }
            variable.subtract(way, &mut column);
            if !is_freed {
                self.slots[slot & 3] = Slot {
                    holds: Holds::Edge,
                    variable: entering,
                };
            }
        } else {
            // A multiplier is at its price first: its row is missed.
            let row = usize::from(entering & 3);
            column[row] = if direction[row] > 0.0 { 1.0 } else { -1.0 };
            self.slots[slot & 3].holds = Holds::Elastic;
        }
        for (multiplier, part) in self.multipliers.iter_mut().zip(direction) {
            *multiplier += self.step * part;
        }
        self.exchange(slot, &column);
        if is_freed {
            self.free(entering, slot);
        }
    }

    /// The dual step at which the first multiplier is at its row's price.
    #[inline(never)]
    fn first_price(&self, direction: &[f32; 4]) -> Breakpoint {
        let [.., thrust] = *direction;
        let ThrustPrice { too_little, too_much } = self.thrust_price;
        let [roll, pitch, yaw] = TORQUE_PRICES;
        let prices = [roll, pitch, yaw, if thrust > 0.0 { too_little } else { too_much }];
        let (mut least, mut variable) = (NEVER, ROW);
        for k in 0..4 {
            let rate = direction[k];
            let multiplier = self.multipliers[k];
            let room = prices[k] - if rate > 0.0 { multiplier } else { -multiplier };
            if room < least * (rate.abs() - LEAST_RATE) {
                (least, variable) = (room / rate.abs(), ROW | k as u8);
            }
        }
        let bits = least.to_bits() as i32;
        Breakpoint { bits, variable }
    }

    /// Puts a column into a slot: a rank-1 update of the inverse.
    #[inline(never)]
    fn exchange(&mut self, slot: usize, column: &[f32; 4]) {
        let row = self.inverse[slot & 3];
        let per_pivot = 1.0 / dot(&row, column);
        let row = row.map(|part| part * per_pivot);
        for other in &mut self.inverse {
            let share = dot(other, column);
            for (other, part) in other.iter_mut().zip(row) {
                *other -= share * part;
            }
        }
        self.inverse[slot & 3] = row;
    }

    /// Changes the coordinates of two slots: place along an edge and distance from it, thrust and
    /// torque.
    #[inline(never)]
    fn turn(&mut self, first: usize, second: usize, [e0, e1]: [f32; 2]) {
        for k in 0..4 {
            let (x, y) = (self.inverse[first & 3][k & 3], self.inverse[second & 3][k & 3]);
            self.inverse[first & 3][k & 3] = e0 * x + e1 * y;
            self.inverse[second & 3][k & 3] = e1 * x - e0 * y;
        }
    }

    /// A unit leaves its edge: place along the edge and distance from it become thrust and torque.
    #[inline(never)]
    fn free(&mut self, index: u8, slot: usize) {
        let along = self.slot_of(Holds::Edge, index);
        let slot = slot & 3;
        let Some((unit, set, residual)) = self.parts(index) else {
            return;
        };
        let corner = corner(set, unit.corner);
        unit.position = Position::Free;
        unit.subtract(corner.at.map(|part| -part), residual);
        self.turn(along, slot, corner.edge);
        self.slots[along].holds = Holds::First;
        self.slots[slot] = Slot {
            holds: Holds::Second,
            variable: index,
        };
    }

    /// Writes the coordinates of all variables.
    #[inline(never)]
    pub(super) fn place(&mut self) {
        for variable in self.variables.iter_mut() {
            rolled();
            variable.at = corner(set(self.corners, variable.rotors), variable.corner).at;
        }
        for (slot, &value) in black_box(self.slots.as_slice())
            .iter()
            .zip(black_box(self.values.as_slice()))
        {
            rolled();
            let Some(variable) = self.variables.get_mut(usize::from(slot.variable)) else {
                continue;
            };
            match slot.holds {
                Holds::Edge => {
                    let edge = corner(set(self.corners, variable.rotors), variable.corner).edge;
                    variable.at = [0, 1].map(|k| variable.at[k] + value * edge[k]);
                }
                Holds::First => variable.at[0] = value,
                Holds::Second => variable.at[1] = value,
                _ => {}
            }
        }
    }
}
