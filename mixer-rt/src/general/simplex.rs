//! A bounded dual simplex method in four rows over small polygons.
//!
//! The linear programme is
//!
//! ```text
//! least  sum_j c_j s_j + sum_i bias_i . y_i
//!  over  y_i in the polygon of unit i,  s_j in [0, 1]
//!  with  sum_i B_i y_i + sum_j a_j s_j = w          rows roll, pitch, yaw, thrust
//! ```
//!
//! Multipliers lambda of the rows put every unit at the corner with the largest gain (B_i^T lambda + bias_i) . y_i, and
//! every shortage s_j at 1 where a_j . lambda > c_j, else at 0. Such a choice is optimal but misses the rows. Four
//! slots of the basis make up for that: each is a shortage, the place along a unit's edge, or one of two slots of a unit
//! that is free in its polygon. A pivot takes the slot that is furthest outside its bounds, moves lambda in the
//! direction that brings it back, and lets the variable whose gain turns first take the slot. A bounded variable is moved
//! to its other bound instead, as long as the slot stays outside (long steps, Maros 2003). A slot that has no variable
//! yet is artificial: its bounds are both zero.
//!
//! Any lambda may be the start: nothing has to be known about the frame or its health. Work is bounded by the numbers of pivots
//! and of moves to other bounds that are allowed.

use super::unit::{NEVER, Place, Scratch, corner, next, positive};
use crate::attainable::Corner;
use crate::rolled;

/// Slots further outside their bounds are brought back: of a shortage's or an edge's length, or of a row.
const TOLERANCE: f32 = 3e-5;
const TOLERANCE_OF_POLYGON: f32 = 1e-5;

/// Multipliers up to which rows are met. Where not even roll = pitch = yaw = 0 is attainable, rows are missed at this price.
const LARGEST_MULTIPLIER: f32 = 4e4;
const LEAST_RATE: f32 = 1e-6;

/// Bias of a unit's efforts: small beside the least cost, large beside rounding.
const BIAS: f32 = 4e-3;

const IDENTITY: [[f32; 4]; 4] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// The number of shortages and of the column along the ray.
pub(super) const COLUMNS: usize = 6;

/// Marks a column among entering variables, which otherwise are units.
const COLUMN: usize = 64;

/// A variable in [0, 1] beside the units.
#[derive(Clone, Copy, Default)]
pub(super) struct Column {
    /// Rows at 1.
    pub(super) rows: [f32; 4],
    pub(super) cost: f32,
    gain: f32,
    rate: f32,
    breakpoint: f32,
    pub(super) is_one: bool,
    pub(super) is_basic: bool,
}

/// What a slot of the basis holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// What its row misses.
    Artificial,
    /// What its row misses, at the largest multiplier.
    Elastic,
    Column(u8),
    /// The share of the edge on which this unit is.
    Edge(u8),
    /// The scaled thrust and torque of a free unit.
    Thrust(u8),
    Torque(u8),
}

/// A slot outside its bounds.
struct Leaving {
    slot: usize,
    /// 1 where it is too large, -1 where it is too small.
    sign: f32,
    violation: f32,
    /// For a free unit: the edge that it is beyond, and the slot of the other coordinate.
    across: Option<(u8, usize)>,
}

/// Pivots and moves to other bounds that are left.
#[derive(Clone, Copy)]
pub(super) struct Budget {
    pub(super) pivots: u8,
    pub(super) flips: u8,
}

/// The programme and its state.
pub(super) struct Simplex<'a> {
    pub(super) units: &'a mut [Scratch],
    /// The polygons of units, by [`Rotors`](crate::rotors::Rotors).
    pub(super) sets: [&'a [Corner]; 4],
    pub(super) columns: [Column; COLUMNS],
    /// How many of the columns there are at present.
    pub(super) count: usize,
    pub(super) slots: [Slot; 4],
    /// Rows of the inverse of the basis.
    inverse: [[f32; 4]; 4],
    /// w less all that does not depend on the basis.
    pub(super) residual: [f32; 4],
    multipliers: [f32; 4],
    /// The values of the slots.
    pub(super) values: [f32; 4],
    /// The last dual step, which the gains do not yet have.
    step: f32,
    pub(super) budget: Budget,
}

#[inline(always)]
fn dot(a: &[f32; 4], b: &[f32; 4]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

#[inline(always)]
fn subtract(rows: &mut [f32; 4], share: f32, column: &[f32; 4]) {
    for (row, part) in rows.iter_mut().zip(column) {
        rolled();
        *row -= share * part;
    }
}

impl<'a> Simplex<'a> {
    /// The programme without columns and without units in their places: see [`Simplex::start`].
    #[inline(always)]
    pub(super) fn new(units: &'a mut [Scratch], sets: [&'a [Corner]; 4], budget: Budget) -> Self {
        Simplex {
            units,
            sets,
            columns: [Column::default(); COLUMNS],
            count: 0,
            slots: [Slot::Artificial; 4],
            inverse: [[0.0; 4]; 4],
            residual: [0.0; 4],
            multipliers: [0.0; 4],
            values: [0.0; 4],
            step: 0.0,
            budget,
        }
    }

    /// Puts units at corners and starts with artificial slots and multipliers of zero, without columns.
    #[inline(never)]
    pub(super) fn start(&mut self, wanted: &[f32; 4], multipliers: [f32; 4]) {
        self.residual = *wanted;
        self.inverse = IDENTITY;
        self.slots = [Slot::Artificial; 4];
        (self.multipliers, self.step) = (multipliers, 0.0);
        for column in &mut self.columns {
            rolled();
            (column.is_one, column.is_basic) = (false, false);
        }
        self.count = 0;
        let mut weyl = 0.5;
        for unit in self.units.iter_mut() {
            rolled();
            let set = self.sets[unit.rotors as usize & 3];
            (unit.gain, unit.rate) = ([BIAS * (weyl - 0.5), BIAS * (0.75 - weyl)], [0.0; 2]);
            // Weyl's sequence: spread over [0, 1) for any number of units.
            weyl += 0.618_034;
            weyl -= if weyl >= 1.0 { 1.0 } else { 0.0 };
            let worth = unit.transposed(&multipliers);
            unit.gain = [0, 1].map(|k| unit.gain[k] + worth[k]);
            unit.choose_corner(set);
            unit.subtract(corner(set, unit.corner).at, &mut self.residual);
        }
    }

    /// Adds the columns up to `count`, each at the bound that the multipliers put it at.
    #[inline(never)]
    pub(super) fn add_columns(&mut self, count: usize) {
        for column in self.columns.iter_mut().take(count).skip(self.count) {
            rolled();
            column.gain = dot(&column.rows, &self.multipliers) - column.cost;
            column.is_one = column.gain > 0.0;
            if column.is_one {
                subtract(&mut self.residual, 1.0, &column.rows);
            }
        }
        self.count = count;
    }

    /// What is delivered of a request in rows: less all shortages that are within their bounds, each times `share`.
    #[inline(never)]
    pub(super) fn delivered(&self, mut wanted: [f32; 4], share: f32) -> [f32; 4] {
        for (index, column) in (0u8..).zip(&self.columns).take(self.count) {
            rolled();
            if usize::from(index) != super::shortage::RAY {
                subtract(&mut wanted, share * self.value(index), &column.rows);
            }
        }
        wanted
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

    #[inline(always)]
    fn set_of(&self, unit: usize) -> &'a [Corner] {
        let rotors = self.units.get(unit).map_or(0, |unit| unit.rotors as usize);
        self.sets[rotors & 3]
    }

    #[inline(never)]
    fn slot_of(&self, slot: Slot) -> usize {
        self.slots.iter().position(|other| *other == slot).unwrap_or(0)
    }

    /// The slot furthest outside its bounds, each measured by how far lambda moves to bring it back (steepest edge).
    #[inline(never)]
    fn furthest_outside(&self) -> Option<Leaving> {
        let mut found = None;
        let mut best = 0.0;
        for (slot, (kind, value)) in self.slots.iter().zip(self.values).enumerate() {
            rolled();
            let mut consider = |violation: f32, size: f32, sign: f32, across: Option<(u8, usize)>| {
                let score = violation * violation;
                if score > best * size {
                    best = score / size;
                    found = Some(Leaving {
                        slot,
                        sign,
                        violation,
                        across,
                    });
                }
            };
            let row = &self.inverse[slot & 3];
            let (violation, sign) = match *kind {
                Slot::Column(_) | Slot::Edge(_) if value < 0.0 => (-value, -1.0),
                Slot::Column(_) | Slot::Edge(_) => (value - 1.0, 1.0),
                Slot::Artificial if value < 0.0 => (-value, -1.0),
                Slot::Artificial => (value, 1.0),
                Slot::Elastic => (-value, -1.0),
                Slot::Torque(_) => continue,
                Slot::Thrust(unit) => {
                    let other = self.slot_of(Slot::Torque(unit));
                    let point = [value, self.values[other & 3]];
                    for (index, corner) in (0u8..).zip(self.set_of(usize::from(unit))) {
                        rolled();
                        let beyond = corner.beyond(point);
                        if beyond > TOLERANCE_OF_POLYGON {
                            let across = self.across(corner, slot, other);
                            consider(beyond, dot(&across, &across), 1.0, Some((index, other)));
                        }
                    }
                    continue;
                }
            };
            if violation > TOLERANCE {
                consider(violation, dot(row, row), sign, None);
            }
        }
        found
    }

    /// The row of the inverse for how far a free unit is beyond an edge.
    #[inline(always)]
    fn across(&self, corner: &Corner, thrust: usize, torque: usize) -> [f32; 4] {
        let (by_f, by_q) = (&self.inverse[thrust & 3], &self.inverse[torque & 3]);
        [0, 1, 2, 3].map(|k| corner.outward([by_f[k], by_q[k]]))
    }

    /// Moves the leaving variable to its bound; returns the slot that becomes free and the direction of lambda.
    #[inline(never)]
    fn release(&mut self, leaving: &Leaving) -> (usize, [f32; 4]) {
        let slot = leaving.slot & 3;
        if let (Some((edge, torque)), Slot::Thrust(index)) = (leaving.across, self.slots[slot]) {
            let torque = torque & 3;
            let corner = corner(self.set_of(usize::from(index)), edge);
            let direction = self.across(corner, slot, torque);
            let [e0, e1] = corner.edge;
            let per_square = 1.0 / (e0 * e0 + e1 * e1);
            let (by_f, by_q) = (self.inverse[slot], self.inverse[torque]);
            self.inverse[slot] = [0, 1, 2, 3].map(|k| (e0 * by_f[k] + e1 * by_q[k]) * per_square);
            self.inverse[torque] = direction.map(|part| part * per_square);
            self.slots[slot] = Slot::Edge(index);
            if let Some(unit) = self.units.get_mut(usize::from(index)) {
                unit.place = Place::Edge;
                unit.corner = edge;
                (unit.gain, unit.rate) = ([0.0; 2], [0.0; 2]);
                unit.subtract(corner.at, &mut self.residual);
            }
            return (torque, direction);
        }
        let is_upper = leaving.sign > 0.0;
        match self.slots[slot] {
            Slot::Column(index) => {
                if let Some(column) = self.columns.get_mut(usize::from(index)) {
                    column.is_basic = false;
                    column.is_one = is_upper;
                    (column.gain, column.rate) = (0.0, 0.0);
                    if is_upper {
                        subtract(&mut self.residual, 1.0, &column.rows);
                    }
                }
            }
            Slot::Edge(index) => {
                let set = self.set_of(usize::from(index));
                if let Some(unit) = self.units.get_mut(usize::from(index)) {
                    unit.place = Place::Corner;
                    if is_upper {
                        unit.subtract(corner(set, unit.corner).edge, &mut self.residual);
                        unit.corner = next(set, unit.corner);
                    }
                }
            }
            _ => {}
        }
        (slot, self.inverse[slot].map(|part| leaving.sign * part))
    }

    /// The breakpoint that comes first, and whose it is. Breakpoints are not negative: their bits are in their order, which
    /// spares the transfers of comparisons between floats.
    #[inline(always)]
    fn first_breakpoint(&self) -> (f32, Option<usize>) {
        let (mut least, mut first) = (NEVER.to_bits(), usize::MAX);
        for (index, unit) in self.units.iter().enumerate() {
            rolled();
            if unit.breakpoint.to_bits() < least {
                (least, first) = (unit.breakpoint.to_bits(), index);
            }
        }
        for (index, column) in self.columns.iter().take(self.count).enumerate() {
            rolled();
            if column.breakpoint.to_bits() < least {
                (least, first) = (column.breakpoint.to_bits(), COLUMN + index);
            }
        }
        let first = if first == usize::MAX { None } else { Some(first) };
        (f32::from_bits(least), first)
    }

    /// Breakpoints of all variables outside the basis in a direction of lambda.
    #[inline(never)]
    fn look_ahead(&mut self, direction: &[f32; 4]) {
        for unit in self.units.iter_mut() {
            rolled();
            let rate = unit.transposed(direction);
            unit.look_ahead(self.sets[unit.rotors as usize & 3], self.step, rate);
        }
        for column in self.columns.iter_mut().take(self.count) {
            rolled();
            column.breakpoint = NEVER;
            if column.is_basic {
                continue;
            }
            column.gain += self.step * column.rate;
            column.rate = dot(&column.rows, direction);
            let (gain, rate) = if column.is_one {
                (column.gain, -column.rate)
            } else {
                (-column.gain, column.rate)
            };
            if rate > LEAST_RATE {
                column.breakpoint = positive(gain) / rate;
            }
        }
    }

    /// Passes breakpoints while the leaving variable stays outside its bounds; returns the dual step and the entering
    /// variable.
    #[inline(never)]
    fn long_step(&mut self, mut violation: f32) -> (f32, Option<usize>) {
        loop {
            let (step, entering) = self.first_breakpoint();
            let Some(index) = entering else {
                return (step, None);
            };
            if self.budget.flips == 0 {
                return (step, entering);
            }
            if let Some(column) = index.checked_sub(COLUMN).and_then(|k| self.columns.get_mut(k)) {
                violation -= column.rate.abs();
                if violation <= 0.0 {
                    return (step, entering);
                }
                let share = if column.is_one { -1.0 } else { 1.0 };
                subtract(&mut self.residual, share, &column.rows);
                column.is_one = !column.is_one;
                column.breakpoint = NEVER;
            } else {
                let set = self.set_of(index);
                let Some(unit) = self.units.get_mut(index) else {
                    return (step, None);
                };
                if unit.place == Place::Edge {
                    return (step, entering);
                }
                let (_, way) = unit.way(set);
                violation -= (way[0] * unit.rate[0] + way[1] * unit.rate[1]).abs();
                if violation <= 0.0 {
                    return (step, entering);
                }
                unit.subtract(way, &mut self.residual);
                unit.flip(set, step);
            }
            self.budget.flips -= 1;
        }
    }

    /// One pivot.
    #[inline(never)]
    fn pivot(&mut self, leaving: &Leaving) {
        let (slot, direction) = self.release(leaving);
        self.look_ahead(&direction);
        let (step, entering) = self.long_step(leaving.violation);
        let mut column = [0.0; 4];
        let mut freed = None;
        match entering {
            None => {
                let (step, row) = self.largest_multiplier(&direction);
                self.step = step;
                column[row & 3] = if direction[row & 3] > 0.0 { 1.0 } else { -1.0 };
                self.slots[slot & 3] = Slot::Elastic;
            }
            Some(index) if index >= COLUMN => {
                self.step = step;
                let index = index - COLUMN;
                if let Some(entering) = self.columns.get_mut(index) {
                    column = entering.rows;
                    if entering.is_one {
                        subtract(&mut self.residual, -1.0, &column);
                    }
                    entering.is_basic = true;
                    self.slots[slot & 3] = Slot::Column(index as u8);
                }
            }
            Some(index) => {
                self.step = step;
                let set = self.set_of(index);
                if let Some(unit) = self.units.get_mut(index) {
                    let way = if unit.place == Place::Edge {
                        let [e0, e1] = corner(set, unit.corner).edge;
                        freed = Some(index as u8);
                        [e1, -e0]
                    } else {
                        let (edge, way) = unit.way(set);
                        let mut along = way;
                        if !unit.is_forward {
                            // The place along an edge counts from its start.
                            along = way.map(|part| -part);
                            unit.subtract(way, &mut self.residual);
                        }
                        unit.corner = edge;
                        unit.place = Place::Edge;
                        self.slots[slot & 3] = Slot::Edge(index as u8);
                        along
                    };
                    unit.subtract(way.map(|part| -part), &mut column);
                }
            }
        }
        for (multiplier, part) in self.multipliers.iter_mut().zip(direction) {
            rolled();
            *multiplier += self.step * part;
        }
        self.exchange(slot, &column);
        if let Some(index) = freed {
            self.free(index, slot);
        }
    }

    #[cold]
    #[inline(never)]
    /// The dual step to the first multiplier that becomes largest, and its row.
    fn largest_multiplier(&self, direction: &[f32; 4]) -> (f32, usize) {
        let (mut step, mut row) = (NEVER, 0);
        for (k, (multiplier, rate)) in self.multipliers.iter().zip(direction).enumerate() {
            rolled();
            let room = if *rate > 0.0 {
                (LARGEST_MULTIPLIER - multiplier) / rate
            } else if *rate < 0.0 {
                (-LARGEST_MULTIPLIER - multiplier) / rate
            } else {
                continue;
            };
            if positive(room) < step {
                (step, row) = (positive(room), k);
            }
        }
        (step, row)
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
            subtract(other, share, &row);
        }
        self.inverse[slot & 3] = row;
    }

    /// A unit leaves its edge: place along the edge and distance from it become thrust and torque.
    #[inline(never)]
    fn free(&mut self, index: u8, slot: usize) {
        let along = self.slot_of(Slot::Edge(index)) & 3;
        let slot = slot & 3;
        let set = self.set_of(usize::from(index));
        let Some(unit) = self.units.get_mut(usize::from(index)) else {
            return;
        };
        let corner = corner(set, unit.corner);
        let [e0, e1] = corner.edge;
        let (by_along, by_across) = (self.inverse[along], self.inverse[slot]);
        self.inverse[along] = [0, 1, 2, 3].map(|k| e0 * by_along[k] + e1 * by_across[k]);
        self.inverse[slot] = [0, 1, 2, 3].map(|k| e1 * by_along[k] - e0 * by_across[k]);
        (self.slots[along], self.slots[slot]) = (Slot::Thrust(index), Slot::Torque(index));
        unit.place = Place::Free;
        unit.subtract(corner.at.map(|part| -part), &mut self.residual);
    }

    /// Writes the units' scaled efforts.
    #[inline(never)]
    pub(super) fn place_units(&mut self) {
        for unit in self.units.iter_mut() {
            rolled();
            unit.efforts = corner(self.sets[unit.rotors as usize & 3], unit.corner).at;
            unit.efforts[1] += unit.bend;
        }
        for (slot, value) in self.slots.iter().zip(self.values) {
            rolled();
            let (Slot::Edge(index) | Slot::Thrust(index) | Slot::Torque(index)) = *slot else {
                continue;
            };
            let Some(unit) = self.units.get_mut(usize::from(index)) else {
                continue;
            };
            match slot {
                Slot::Edge(_) => {
                    let edge = corner(self.sets[unit.rotors as usize & 3], unit.corner).edge;
                    unit.efforts = [0, 1].map(|k| unit.efforts[k] + value * edge[k]);
                }
                Slot::Thrust(_) => unit.efforts[0] = value,
                _ => unit.efforts[1] = value,
            }
        }
    }

    /// The value of a column.
    #[inline(never)]
    pub(super) fn value(&self, index: u8) -> f32 {
        match self.columns.get(usize::from(index)) {
            Some(column) if column.is_basic => self.values[self.slot_of(Slot::Column(index)) & 3],
            Some(column) if column.is_one => 1.0,
            _ => 0.0,
        }
    }
}
