//! What is done where the budget of pivots has ended first: the answer is drawn towards level flight, which keeps all bounds.

use super::shortage;
use super::simplex::{Budget, Holds, Simplex};
use super::variable::{Scratch, between, positive};
use crate::rotors::Rotors;
use crate::tables::Level;
use crate::{clamp, rolled};

/// Pivots and flips at most for the programme of level flight.
const BUDGET: Budget = Budget { pivots: 8, flips: 32 };

/// Rows that artificial slots may miss.
const MISSED: f32 = 1e-3;

impl Simplex<'_> {
    /// Draws the coordinates of units towards level flight at a thrust in rows, as little as puts all units into their sets and
    /// all shortages between nothing and all that was asked for.
    #[cold]
    #[inline(never)]
    pub(super) fn retreat(&mut self, level: Option<&Level<'_>>, thrust: f32, scale: [f32; 2]) {
        let mut share = 0.0;
        for (slot, value) in self.slots.iter().zip(self.values) {
            if slot.holds == Holds::Artificial && value.abs() > MISSED {
                share = 1.0;
            }
        }
        for shortage in self.shortages.iter().take(self.count) {
            rolled();
            // In level flight a shortage is 1.
            share = larger(share, beyond(shortage.at[0], 1.0));
        }
        match level {
            Some(level) => level.write(thrust, scale, self.units),
            None => self.solve_level(thrust),
        }
        for unit in self.units.iter() {
            rolled();
            if unit.rotors.is_single() {
                share = larger(share, beyond(unit.at[0], unit.level[0]));
            }
            if unit.rotors == Rotors::Both {
                for corner in self.polygon.corners {
                    rolled();
                    let out = corner.beyond(unit.at);
                    if out > 0.0 {
                        let room = positive(-corner.beyond(unit.level));
                        share = larger(share, out / (out + room));
                    }
                }
            }
        }
        for unit in self.units.iter_mut() {
            rolled();
            unit.at = between(unit.at, unit.level, share);
        }
    }

    /// Gives units their level coordinates by the programme for thrust alone, in rows. Where not even that is solved, as with too
    /// few rotors, they are what its budget leads to.
    fn solve_level(&mut self, thrust: f32) {
        for unit in self.units.iter_mut() {
            rolled();
            unit.level = unit.at;
        }
        self.start(&[0.0, 0.0, 0.0, thrust], &[0.0; 4], shortage::LEVEL, BUDGET);
        self.solve();
        self.place();
        for unit in self.units.iter_mut() {
            rolled();
            (unit.at, unit.level) = (unit.level, unit.at);
        }
    }
}

/// The share of the way from `x` to `level`, which is in [0, 1], at which x is as well.
fn beyond(x: f32, level: f32) -> f32 {
    if x < 0.0 {
        -x / (level - x)
    } else if x > 1.0 {
        (x - 1.0) / (x - level)
    } else {
        0.0
    }
}

impl Level<'_> {
    /// Gives units their scaled level efforts at a thrust in rows, as far as it is between the least and the middle. With tilted
    /// axes they are level at the reference voltage; at others k_f and k_Q hardly differ.
    fn write(&self, thrust: f32, scale: [f32; 2], units: &mut [Scratch]) {
        let [least, middle] = self.thrust;
        let share = clamp((thrust - least) / (middle - least), 0.0, 1.0);
        for (unit, [least, middle]) in units.iter_mut().zip(self.efforts) {
            rolled();
            unit.level = [0, 1].map(|k| (least[k] + share * (middle[k] - least[k])) / scale[k]);
        }
    }
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
