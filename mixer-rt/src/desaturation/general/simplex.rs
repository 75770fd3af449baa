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
//! Units and shortages are variables alike ([`variable`](super::variable)); the bias of a shortage is its cost, negative.
//!
//! Multipliers lambda of the rows put every variable at the corner with the largest gain (B_i^T lambda + bias_i) . y_i. Such a
//! choice is optimal but misses the rows. Four slots of the basis make up for that: each is the place along a variable's
//! edge, or one of two slots of a unit that is free in its polygon. A pivot takes the slot that is furthest outside its
//! bounds, moves lambda in the direction that brings it back, and lets the variable whose gain turns first take the slot. A
//! variable at a corner moves to its next corner instead, as long as the slot stays outside (long steps, Maros 2003). A
//! slot that has no variable yet is artificial: its bounds are both zero.
//!
//! Any lambda may be the start: nothing has to be known about the frame or its health. Work is bounded by the numbers of pivots
//! and of moves to other corners that are allowed.

use super::variable::{NEVER, Place, Polygon, Scratch, corner, dot, next, positive};
use crate::desaturation::attainable::Corner;
use crate::rolled;

/// Slots further outside their bounds are brought back: of an edge's length, or of a row.
const TOLERANCE: f32 = 3e-5;
const TOLERANCE_OF_POLYGON: f32 = 1e-5;

/// Multipliers up to which rows are met. Where not even roll = pitch = yaw = 0 is attainable, rows are missed at this price.
const LARGEST_MULTIPLIER: f32 = 4e4;

/// Bias of a unit's efforts: small beside the least cost, large beside rounding.
const BIAS: f32 = 4e-3;

const IDENTITY: [[f32; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// The number of shortages, the one along the ray included.
pub(super) const SHORTAGES: usize = 6;

/// What a slot of the basis holds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Holds {
    /// What its row misses.
    Artificial,
    /// What its row misses, at the largest multiplier.
    Elastic,
    /// The share of the edge on which the variable is.
    Edge,
    /// The first and the second coordinate of a free variable.
    First,
    Second,
}

/// A slot of the basis.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Slot {
    holds: Holds,
    variable: u8,
}

const ARTIFICIAL: Slot = Slot {
    holds: Holds::Artificial,
    variable: 0,
};

/// A slot outside its bounds.
struct Leaving {
    slot: usize,
    /// 1 where it is too large, -1 where it is too small.
    sign: f32,
    violation: f32,
    /// For a free variable: the edge that it is beyond, and the slot of the second coordinate.
    edge: u8,
    second: usize,
}

/// Pivots and moves to other corners that are left.
#[derive(Clone, Copy)]
pub(super) struct Budget {
    pub(super) pivots: u8,
    pub(super) flips: u8,
}

/// The programme and its state.
pub(super) struct Simplex<'a> {
    pub(super) units: &'a mut [Scratch],
    pub(super) shortages: &'a mut [Scratch; SHORTAGES],
    /// How many of the shortages there are at present.
    count: usize,
    polygon: Polygon<'a>,
    slots: [Slot; 4],
    /// Rows of the inverse of the basis.
    inverse: [[f32; 4]; 4],
    /// w less all that does not depend on the basis.
    pub(super) residual: [f32; 4],
    multipliers: [f32; 4],
    /// The values of the slots.
    values: [f32; 4],
    /// The last dual step, which the gains do not yet have.
    step: f32,
    budget: Budget,
}

/// Puts variables, whose gains are their bias, at the corners that the multipliers make best; takes what they give there from
/// `residual`.
#[inline(never)]
fn put_at_corners(
    variables: &mut [Scratch],
    polygon: &Polygon<'_>,
    multipliers: &[f32; 4],
    residual: &mut [f32; 4],
) {
    for variable in variables {
        rolled();
        let worth = variable.transposed(multipliers);
        variable.gain = [0, 1].map(|k| variable.gain[k] + worth[k]);
        (variable.rate, variable.place) = ([0.0; 2], Place::Corner);
        let set = polygon.set(variable.rotors);
        variable.choose_corner(set);
        variable.subtract(corner(set, variable.corner).at, residual);
    }
}

/// Gives variables the coordinates of their corners.
#[inline(never)]
fn take_corners(variables: &mut [Scratch], polygon: &Polygon<'_>) {
    for variable in variables {
        rolled();
        variable.at = corner(polygon.set(variable.rotors), variable.corner).at;
    }
}

impl<'a> Simplex<'a> {
    /// The programme before [`Simplex::start`].
    #[inline(always)]
    pub(super) fn new(
        units: &'a mut [Scratch],
        shortages: &'a mut [Scratch; SHORTAGES],
        polygon: Polygon<'a>,
    ) -> Self {
        Simplex {
            units,
            shortages,
            count: 0,
            polygon,
            slots: [ARTIFICIAL; 4],
            inverse: IDENTITY,
            residual: [0.0; 4],
            multipliers: [0.0; 4],
            values: [0.0; 4],
            step: 0.0,
            budget: Budget { pivots: 0, flips: 0 },
        }
    }

    /// Starts with artificial slots and with the variables at the corners that `multipliers` put them at: all units, and the
    /// first `count` shortages, whose gains are their costs.
    #[inline(never)]
    pub(super) fn start(&mut self, wanted: &[f32; 4], multipliers: &[f32; 4], count: usize, budget: Budget) {
        self.budget = budget;
        self.residual = *wanted;
        self.inverse = IDENTITY;
        self.slots = [ARTIFICIAL; 4];
        (self.multipliers, self.step, self.count) = (*multipliers, 0.0, count);
        let mut weyl = 0.5;
        for variable in self.units.iter_mut() {
            rolled();
            variable.gain = [BIAS * (weyl - 0.5), BIAS * (0.75 - weyl)];
            // Weyl's sequence: spread over [0, 1) for any number of units.
            weyl += 0.618_034;
            weyl -= if weyl >= 1.0 { 1.0 } else { 0.0 };
        }
        let shortages = self.shortages.get_mut(..count).unwrap_or_default();
        put_at_corners(self.units, &self.polygon, multipliers, &mut self.residual);
        put_at_corners(shortages, &self.polygon, multipliers, &mut self.residual);
    }

    /// Pivots until all slots are within their bounds; false where the budget ends first.
    #[inline(never)]
    pub(super) fn solve(&mut self) -> bool {
        loop {
            for (value, row) in self.values.iter_mut().zip(&self.inverse) {
                rolled();
                *value = dot(row, &self.residual);
            }
            let Some(leaving) = self.furthest_outside() else {
                return true;
            };
            if self.budget.pivots == 0 {
                return false;
            }
            self.budget.pivots -= 1;
            self.pivot(&leaving);
        }
    }

    /// The variable of this index, units first, its set, and the residual.
    #[inline(always)]
    fn parts(&mut self, index: usize) -> (&mut Scratch, &'a [Corner], &mut [f32; 4]) {
        let shortage = index.wrapping_sub(self.units.len());
        let variable = match self.units.get_mut(index) {
            Some(unit) => unit,
            None => &mut self.shortages[shortage.min(SHORTAGES - 1)],
        };
        let set = self.polygon.set(variable.rotors);
        (variable, set, &mut self.residual)
    }

    #[inline(never)]
    fn slot_of(&self, holds: Holds, variable: u8) -> usize {
        let wanted = Slot { holds, variable };
        self.slots.iter().position(|slot| *slot == wanted).unwrap_or(0) & 3
    }

    /// The slot furthest outside its bounds, each measured by how far lambda moves to bring it back (steepest edge).
    #[inline(never)]
    fn furthest_outside(&self) -> Option<Leaving> {
        let mut found = Leaving {
            slot: 0,
            sign: 1.0,
            violation: 0.0,
            edge: 0,
            second: 0,
        };
        let mut best = 0.0;
        for (index, (slot, value)) in self.slots.iter().zip(self.values).enumerate() {
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
                    for (edge, corner) in (0u8..).zip(self.polygon.corners) {
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
        if best > 0.0 { Some(found) } else { None }
    }

    /// The row of the inverse for how far a free unit is beyond an edge.
    #[inline(always)]
    fn across(&self, corner: &Corner, first: usize, second: usize) -> [f32; 4] {
        let (first, second) = (&self.inverse[first & 3], &self.inverse[second & 3]);
        [0, 1, 2, 3].map(|k| corner.outward([first[k], second[k]]))
    }

    /// Moves the leaving variable to its bound; returns the slot that becomes free and the direction of lambda.
    #[inline(never)]
    fn release(&mut self, leaving: &Leaving) -> (usize, [f32; 4]) {
        let slot = leaving.slot & 3;
        let Slot { holds, variable } = self.slots[slot];
        if holds == Holds::First {
            let second = leaving.second & 3;
            let corner = corner(self.polygon.corners, leaving.edge);
            let direction = self.across(corner, slot, second);
            let [e0, e1] = corner.edge;
            let per_square = 1.0 / (e0 * e0 + e1 * e1);
            for (k, across) in direction.iter().enumerate() {
                rolled();
                let along = e0 * self.inverse[slot][k] + e1 * self.inverse[second][k];
                self.inverse[slot][k] = along * per_square;
                self.inverse[second][k] = across * per_square;
            }
            self.slots[slot].holds = Holds::Edge;
            let (unit, _, residual) = self.parts(usize::from(variable));
            (unit.place, unit.corner) = (Place::Edge, leaving.edge);
            (unit.gain, unit.rate) = ([0.0; 2], [0.0; 2]);
            unit.subtract(corner.at, residual);
            return (second, direction);
        }
        if holds == Holds::Edge {
            let (variable, set, residual) = self.parts(usize::from(variable));
            variable.place = Place::Corner;
            if leaving.sign > 0.0 {
                variable.subtract(corner(set, variable.corner).edge, residual);
                variable.corner = next(set, variable.corner);
            }
        }
        (slot, self.inverse[slot].map(|part| leaving.sign * part))
    }

    /// Breakpoints of the variables outside the basis in a direction of lambda.
    #[inline(never)]
    fn look_ahead(&mut self, direction: &[f32; 4]) {
        for unit in self.units.iter_mut() {
            rolled();
            unit.look_ahead(self.polygon.set(unit.rotors), self.step, direction);
        }
        let shortages = self.shortages.get_mut(..self.count).unwrap_or_default();
        for shortage in shortages {
            rolled();
            shortage.look_ahead_on_segment(self.step, direction);
        }
    }

    /// The breakpoint that comes first, and its variable. Breakpoints are not negative: their bits are in their order, which
    /// spares the transfers of comparisons between floats.
    #[inline(always)]
    fn first_breakpoint(&self) -> (f32, usize) {
        let (mut least, mut first) = (NEVER.to_bits(), usize::MAX);
        for (index, unit) in self.units.iter().enumerate() {
            rolled();
            if unit.breakpoint.to_bits() < least {
                (least, first) = (unit.breakpoint.to_bits(), index);
            }
        }
        for (index, shortage) in self.shortages.iter().enumerate() {
            rolled();
            if shortage.breakpoint.to_bits() < least {
                (least, first) = (shortage.breakpoint.to_bits(), self.units.len() + index);
            }
        }
        (f32::from_bits(least), first)
    }

    /// Passes breakpoints while the leaving variable stays outside its bounds; returns the dual step and the entering
    /// variable, none where nothing enters.
    #[inline(never)]
    fn long_step(&mut self, mut violation: f32) -> (f32, usize) {
        loop {
            let (step, entering) = self.first_breakpoint();
            if self.budget.flips == 0 || entering == usize::MAX {
                return (step, entering);
            }
            let (variable, set, residual) = self.parts(entering);
            if variable.place == Place::Edge {
                return (step, entering);
            }
            let (_, way) = variable.way(set);
            violation -= (way[0] * variable.rate[0] + way[1] * variable.rate[1]).abs();
            if violation <= 0.0 {
                return (step, entering);
            }
            variable.subtract(way, residual);
            variable.flip(set, step);
            self.budget.flips -= 1;
        }
    }

    /// One pivot.
    #[inline(always)]
    fn pivot(&mut self, leaving: &Leaving) {
        let (slot, direction) = self.release(leaving);
        self.look_ahead(&direction);
        let (step, entering) = self.long_step(leaving.violation);
        let mut column = [0.0; 4];
        let mut is_freed = false;
        self.step = step;
        if entering == usize::MAX {
            let row = self.largest_multiplier(&direction);
            column[row & 3] = if direction[row & 3] > 0.0 { 1.0 } else { -1.0 };
            self.slots[slot & 3].holds = Holds::Elastic;
        } else {
            let (variable, set, residual) = self.parts(entering);
            let mut way;
            if variable.place == Place::Edge {
                is_freed = true;
                let [e0, e1] = corner(set, variable.corner).edge;
                way = [e1, -e0];
            } else {
                (variable.corner, way) = variable.way(set);
                variable.place = Place::Edge;
                if !variable.is_forward {
                    // The place along an edge counts from its start.
                    variable.subtract(way, residual);
                    way = way.map(|part| -part);
                }
                self.slots[slot & 3] = Slot {
                    holds: Holds::Edge,
                    variable: entering as u8,
                };
            }
            let (variable, ..) = self.parts(entering);
            variable.subtract(way.map(|part| -part), &mut column);
        }
        for (multiplier, part) in self.multipliers.iter_mut().zip(direction) {
            rolled();
            *multiplier += self.step * part;
        }
        self.exchange(slot, &column);
        if is_freed {
            self.free(entering as u8, slot);
        }
    }

    /// Takes the dual step to the first multiplier that becomes largest; returns its row.
    #[cold]
    #[inline(never)]
    fn largest_multiplier(&mut self, direction: &[f32; 4]) -> usize {
        let mut row = 0;
        for (k, (multiplier, rate)) in self.multipliers.iter().zip(direction).enumerate() {
            rolled();
            let limit = if *rate > 0.0 {
                LARGEST_MULTIPLIER
            } else {
                -LARGEST_MULTIPLIER
            };
            let room = positive((limit - multiplier) / rate);
            if *rate != 0.0 && room < self.step {
                (self.step, row) = (room, k);
            }
        }
        row
    }

    /// Puts a column into a slot: a rank-1 update of the inverse.
    #[inline(never)]
    fn exchange(&mut self, slot: usize, column: &[f32; 4]) {
        let row = self.inverse[slot & 3];
        let per_pivot = 1.0 / dot(&row, column);
        let row = row.map(|part| part * per_pivot);
        for other in &mut self.inverse {
            rolled();
            let share = dot(other, column);
            for (other, part) in other.iter_mut().zip(row) {
                *other -= share * part;
            }
        }
        self.inverse[slot & 3] = row;
    }

    /// A unit leaves its edge: place along the edge and distance from it become thrust and torque.
    #[inline(never)]
    fn free(&mut self, index: u8, slot: usize) {
        let along = self.slot_of(Holds::Edge, index);
        let slot = slot & 3;
        let (unit, set, residual) = self.parts(usize::from(index));
        let corner = corner(set, unit.corner);
        unit.place = Place::Free;
        unit.subtract(corner.at.map(|part| -part), residual);
        let [e0, e1] = corner.edge;
        for k in 0..4 {
            rolled();
            let (by_along, by_across) = (self.inverse[along][k], self.inverse[slot][k]);
            self.inverse[along][k] = e0 * by_along + e1 * by_across;
            self.inverse[slot][k] = e1 * by_along - e0 * by_across;
        }
        self.slots[along].holds = Holds::First;
        self.slots[slot] = Slot {
            holds: Holds::Second,
            variable: index,
        };
    }

    /// Writes the coordinates of all variables.
    #[inline(never)]
    pub(super) fn place(&mut self) {
        take_corners(self.units, &self.polygon);
        take_corners(self.shortages, &self.polygon);
        for (slot, value) in self.slots.into_iter().zip(self.values) {
            rolled();
            let (variable, set, _) = self.parts(usize::from(slot.variable));
            match slot.holds {
                Holds::Edge => {
                    let edge = corner(set, variable.corner).edge;
                    variable.at = [0, 1].map(|k| variable.at[k] + value * edge[k]);
                }
                Holds::First => variable.at[0] = value,
                Holds::Second => variable.at[1] = value,
                _ => {}
            }
        }
    }
}
